"""A class stays in the process that has it open, whoever asks another one, until that is gone.

Two processes that share a database, without a proxy: an attacker may ask either of them.
"""

from __future__ import annotations

import signal
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from websockets.exceptions import InvalidStatus

from onpath.app.classroom.admission import class_id_of
from onpath.app.classroom.class_opening import KEY
from onpath.app.storage.database_url import DATABASE
from onpath.app.storage.leases import LEASE
from onpath.app.storage.records import Records
from onpath.app.storage.schema import classes
from tests.support.lab_process import LabProcess, free_ports
from tests.support.site_class import CODES, KEYS
from tests.support.student import PATIENCE, Student
from tests.support.waiting import wait_for

pytestmark = pytest.mark.thorough

CODE = CODES[0]
PATHS = f"/c/{CODE.upper()}", f"/c/{CODE[:-1]}{CODE[-1].upper()}/", f"/c/{CODE}?x=1", f"/c/{CODE}"


@pytest.fixture
def url(tmp_path: Path) -> str:
    return f"sqlite:///{tmp_path / 'labs.db'}"


@pytest.fixture
def two(url: str) -> Iterator[list[LabProcess]]:
    told = ["--classroom", "--log-level", "warning"]
    given = {DATABASE: url, KEY: " ".join(KEYS)}
    made = [LabProcess(port, told, given) for port in free_ports(2)]
    for process in made:
        process.wait_until_well()
    yield made
    for process in made:
        process.kill()


def at(process: LabProcess, path: str) -> Student:
    return Student(f"ws://127.0.0.1:{process.port}{path}")


def move(students: list[Student], there: LabProcess) -> None:
    """Their connections are closed, and they connect to another process, as through a proxy."""
    codes = [student.code for student in students]
    for student in students:
        student.wait_until_closed()
        student.address = f"ws://127.0.0.1:{there.port}/c/{CODE}"
    for student in students:
        student.reopen()
    for student, code in zip(students, codes, strict=True):
        student.read(lambda student=student: student.is_member)
        assert student.code == code


def join(process: LabProcess, name: str) -> Student:
    student = at(process, f"/c/{CODE}")
    student.reopen()
    student.join(name)
    student.read(lambda: student.is_member)
    return student


def wait_until_stored(url: str, student: Student) -> None:
    """Wait until a member and the member's lab would outlive the process."""
    records = Records(url)
    room = class_id_of(KEYS[0])
    wait_for(
        lambda: (
            student.code in str(records.load(room, classes))
            and records.load(student.code) is not None
        ),
        PATIENCE,
    )
    records.close()


def test_a_class_is_taken_from_nobody_who_is_alive_and_goes_on_after_a_stall_and_a_kill(
    two: list[LabProcess], url: str
) -> None:
    home, other = two
    students = [join(home, f"Ada {number}") for number in range(2)]
    end, attempts = time.monotonic() + 4 * LEASE, 0
    while time.monotonic() < end or attempts < len(PATHS):
        for path in PATHS:
            with pytest.raises(InvalidStatus):
                at(other, path).open()
            attempts += 1
            for student in students:
                student.read_what_has_come()  # raises if it has been thrown out
    home.process.send_signal(signal.SIGSTOP)
    late = join(other, "Cid")  # after the lease has ended
    home.process.send_signal(signal.SIGCONT)
    move(students, other)
    wait_until_stored(url, late)
    other.kill()
    move([*students, late], home)
