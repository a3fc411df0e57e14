"""Only a teacher's page orders anything: each message is checked for the teacher's right."""

from __future__ import annotations

import random
from collections.abc import Iterator
from typing import Any, get_args

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.app.channel.class_messages import Order
from onpath.app.classroom.classroom import Classroom
from onpath.app.classroom.teaching.teacher_form import PREFIX
from onpath.app.server.lab_server import LabServer
from onpath.app.viser_adapter.addresses import class_address
from tests.support.student import Student

NAMES = ("follow", "name", "setup", "shown", "revealed", "lesson", "step", "picked", "large")
VALUES = (True, False, 1.0, 2.0, "01-path-or-timetable", "", "<b>")


def page(server: LabServer, room: Classroom, shown: str = "") -> Student:
    """A page at the address of the class, without a picture.

    Args:
        shown: a teacher's pass.
    """
    address = f"ws://127.0.0.1:{server.server.get_port()}{class_address(room.code)}"
    found = Student(address, scene=False)
    found.kept["onpath_teacher"] = shown
    found.open()
    found.read(lambda: found.values)
    return found


@pytest.fixture(scope="module")
def student(server: LabServer, room: Classroom) -> Iterator[Student]:
    with page(server, room) as found:
        yield found


def order(draw: random.Random) -> dict[str, Any]:
    """Any order of a teacher's page."""
    if draw.random() < 0.5:
        return {"is": "lead", "do": draw.choice(get_args(Order)), "member": draw.randrange(3)}
    name, value = PREFIX + draw.choice(NAMES), draw.choice(VALUES)
    return {"is": "set", "name": name, "value": value, "number": draw.randrange(9)}


@given(st.randoms(use_true_random=False))
@settings(max_examples=30, deadline=None)
def test_no_order_of_a_students_page_is_carried_out(
    student: Student, room: Classroom, draw: random.Random
) -> None:
    room.join("a" * 12, room.code, "Ada")
    before = room.state.orders, room.state.display, room.state.passes
    student.told.pop("refused", None)
    student.tell(order(draw))
    student.read(lambda: "refused" in student.told)
    assert "teacher" in student.told["refused"]["why"]
    assert before == (room.state.orders, room.state.display, room.state.passes)
    assert "a" * 12 in room.members() and "class.told" not in student.values


def test_a_teacher_leads_until_the_pass_is_revoked(server: LabServer, room: Classroom) -> None:
    shown = room.admit(room.key, "lab")
    with page(server, room, shown) as teacher:
        assert teacher.value("class.shown") is False
        teacher.settle("class.shown", True)
        assert room.display.shown
        teacher.tell({"is": "lead", "do": "freeze"})
        teacher.read(lambda: room.orders.frozen)
        room.revoke(shown)
        teacher.tell({"is": "lead", "do": "thaw"})
        teacher.read(lambda: "refused" in teacher.told)
        assert room.orders.frozen
    room.freeze(False)


def test_who_stops_teaching_has_a_students_page(server: LabServer, room: Classroom) -> None:
    with page(server, room, room.admit(room.key, "lab")) as teacher:
        teacher.value("class.shown")
        teacher.tell({"is": "lead", "do": "stop"})
        teacher.read(lambda: teacher.told["form class"]["groups"] == [])
        teacher.read(lambda: teacher.kept["onpath_teacher"] == "")
        teacher.told.pop("refused", None)
        teacher.tell({"is": "lead", "do": "freeze"})
        teacher.read(lambda: "refused" in teacher.told)
        assert not room.orders.frozen
