"""A class stays in the process that has it open, whoever asks another one; killed, it moves.

Two processes that share a database, without a proxy: an attacker may ask either of them.
"""

from __future__ import annotations

import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from websockets.exceptions import InvalidStatus

from onpath.app.classroom.class_opening import KEY
from onpath.app.storage.database_url import DATABASE
from onpath.app.storage.leases import LEASE
from tests.support.lab_process import LabProcess, free_ports
from tests.support.site_class import CODES, KEYS
from tests.support.student import Student

pytestmark = pytest.mark.thorough

CODE = CODES[0]
BACK = 10.0  # [s] after a kill, as SECURITY.md promises; a quiet machine takes about 3
PATHS = f"/c/{CODE.upper()}", f"/c/{CODE[:-1]}{CODE[-1].upper()}/", f"/c/{CODE}?x=1", f"/c/{CODE}"


@pytest.fixture
def two(tmp_path: Path) -> Iterator[list[LabProcess]]:
    told = ["--classroom", "--log-level", "warning"]
    given = {DATABASE: f"sqlite:///{tmp_path / 'labs.db'}", KEY: " ".join(KEYS)}
    made = [LabProcess(port, told, given) for port in free_ports(2)]
    for process in made:
        process.wait_until_well()
    yield made
    for process in made:
        process.kill()


def at(process: LabProcess, path: str) -> Student:
    return Student(f"ws://127.0.0.1:{process.port}{path}")


def test_nobody_throws_a_class_out_and_it_goes_on_where_it_is_wanted_after_a_kill(
    two: list[LabProcess],
) -> None:
    home, other = two
    students = [at(home, f"/c/{CODE}") for _ in range(2)]
    for number, student in enumerate(students):
        student.open()
        student.set("Nickname", f"Ada {number}")
        student.set("Join the class", True)
        student.read(lambda student=student: student.sees("You are in the class as"))
    codes = [student.code for student in students]
    end, attempts = time.monotonic() + 4 * LEASE, 0
    while time.monotonic() < end:
        for path in PATHS:
            with pytest.raises(InvalidStatus):
                at(other, path).open()
            attempts += 1
            for student in students:
                student.read_what_has_come()  # raises if it has been thrown out
    assert attempts > 4
    home.kill()
    killed = time.monotonic()
    for student in students:
        student.wait_until_closed()
        student.address = student.address.replace(str(home.port), str(other.port))
    for student in students:
        student.reopen()
    for student, code in zip(students, codes, strict=True):
        student.read(lambda student=student: student.sees("You are in the class as"))
        assert student.code == code
    assert time.monotonic() - killed < BACK
