"""A teacher deletes a student, or the class, with all that is stored of them, and nobody else."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from websockets.exceptions import ConnectionClosed

from onpath.app.classroom.class_opening import open_classes
from onpath.app.common.access_codes import shown
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.server.lab_server import LabServer
from onpath.app.server.server_options import ServerOptions
from onpath.app.storage.records import Records, file_url
from tests.support.student import Student
from tests.support.waiting import wait_for

KEYS = ["k7mf2xqa9tzr", "bn4ws8cd3vyp"]
PRIVACY = "https://school.example/privacy?a=1&b=2"
MARK = 43.0  # a gain by which a lab is recognised in the file


@pytest.fixture
def file(tmp_path: Path) -> Path:
    return tmp_path / "labs.db"


@pytest.fixture
def server(file: Path) -> Iterator[LabServer]:
    rooms = open_classes(KEYS)
    options = ServerOptions(records=Records(file_url(file)), classrooms=rooms, privacy_url=PRIVACY)
    made = LabServer("127.0.0.1", 0, LoopCache(), options)
    yield made
    made.stop()


def come(server: LabServer, index: int, name: str) -> Student:
    """A student of a class, with a lab that is stored."""
    code = open_classes(KEYS)[index].code
    student = Student(f"ws://127.0.0.1:{server.server.get_port()}/c/{code}")
    student.open()
    student.join(name)
    student.read(lambda: student.is_member)
    student.set("K2", MARK)
    return student


def teach(server: LabServer) -> Student:
    code = open_classes(KEYS)[0].code
    teacher = Student(f"ws://127.0.0.1:{server.server.get_port()}/c/{code}")
    teacher.open()
    teacher.teach(shown(KEYS[0]))
    return teacher


def stored(file: Path) -> str:
    """Everything that a reader of the database finds."""
    records = Records(file_url(file))
    with records.transaction() as connection:
        tables = connection.exec_driver_sql("SELECT name FROM sqlite_master WHERE type = 'table'")
        rows = [connection.exec_driver_sql(f"SELECT * FROM {name}") for (name,) in tables]
        found = str([tuple(row) for each in rows for row in each])  # a `Row` shortens its text
    records.close()
    return found


def gone(student: Student) -> bool:
    """Whether the server has closed the connection."""
    try:
        student.read_what_has_come()
    except ConnectionClosed:
        return True
    return False


@pytest.mark.thorough
def test_a_teacher_deletes_one_student_and_then_the_own_class_and_nobody_else(
    server: LabServer, file: Path
) -> None:
    ada, bob, eve = come(server, 0, "Ada"), come(server, 0, "Bobby"), come(server, 1, "Eve")
    teacher, everybody = teach(server), [ada, bob, eve]

    def until(condition: object) -> None:
        def read() -> bool:
            for each in (bob, eve, teacher):
                each.read_what_has_come()
            return condition()  # type: ignore[operator]

        wait_for(read, 60.0)

    until(lambda: all(stored(file).count(each.code) > 1 for each in everybody))
    until(lambda: "Ada" in stored(file) and "Bobby" in stored(file))
    teacher.set("class.follow", 1)
    until(lambda: "Ada" in teacher.values["class.who"])
    assert "Delete Ada from the class" in teacher.fields["class.delete"]["asks"]
    teacher.lead("delete")
    until(lambda: teacher.values["class.told"] == "Deleted.")
    until(lambda: not teacher.values["class.who"])
    until(lambda: gone(ada))
    left = stored(file)
    assert "Ada" not in left and ada.code not in left
    assert "Bobby" in left and bob.code in left and eve.code in left
    before = ada.code
    ada.reopen()
    ada.read(lambda: ada.may_join and ada.code != before)
    ada.close()
    question = teacher.fields["class.forget"]["asks"]
    assert "Delete the labs of all students of this class" in question
    teacher.lead("forget")

    def bob_is_gone() -> bool:
        teacher.read_what_has_come()
        eve.read_what_has_come()
        return gone(bob) and "1 lab was deleted" in teacher.values["class.told"]

    wait_for(bob_is_gone, 60.0)
    left = stored(file)
    assert "Bobby" not in left and bob.code not in left
    assert "Eve" in left and eve.code in left  # the other teacher's
    for each in (eve, teacher):
        each.close()


def test_who_is_asked_for_a_nickname_is_told_what_is_stored(server: LabServer) -> None:
    student = Student(f"ws://127.0.0.1:{server.server.get_port()}/c/{open_classes(KEYS)[0].code}")
    student.open()
    student.read(lambda: student.may_join)
    assert "predictions and drawn curves" in student.seat["stored"]
    assert "after 365 days without use" in student.seat["stored"]
    assert student.seat["privacy"] == PRIVACY
    student.close()
