"""`onpath --workers 2 --classroom` as it is started, students on both workers, one teacher."""

from __future__ import annotations

import signal
from collections.abc import Callable
from pathlib import Path

import pytest

from onpath.lessons.words import ENGLISH
from tests.support.student import Student
from tests.support.supervisor import Supervisor
from tests.support.waiting import wait_for

pytestmark = pytest.mark.thorough

SOON = 240  # frames within which the teacher's word is everywhere; 30 with nothing else to do
HOSTILE = "<img src=x onerror=1>"


def press(tab: Student, label: str) -> None:
    tab.set(label, True)


def come(tab: Student) -> None:
    """Open the page; a button that is pressed before it stands does nothing."""
    tab.open()
    before = tab.moving
    tab.read(lambda: tab.moving > before + 5)


def join(tab: Student, code: str, name: str) -> None:
    come(tab)
    tab.set("Class code", code)
    tab.set("Nickname", name)
    press(tab, "Join the class")
    tab.read(lambda: tab.sees("You are in the class as"))


def read_all(tabs: list[Student], until: Callable[[Student], bool]) -> int:
    """Read in turn until something holds for all; how many frames a tab has been shown by then."""
    before = [tab.moving for tab in tabs]
    for tab in tabs:
        tab.read(lambda tab=tab: until(tab))
    return max(tab.moving - moving for tab, moving in zip(tabs, before, strict=True))


def test_students_of_all_workers_are_one_class(tmp_path: Path) -> None:
    supervisor = Supervisor(
        tmp_path, "--workers", "2", "--classroom", "--successive-ports", "--port", "0"
    )
    try:
        _run_class(supervisor)
    finally:
        supervisor.end()
    assert not any(b"Ada" in part.read_bytes() for part in tmp_path.iterdir())


def _run_class(supervisor: Supervisor) -> None:
    supervisor.wait_for(r"^\[worker [12]\] INFO .*OnPath is ready", times=2)
    ((first, second),) = supervisor.wait_for(r"workers at the ports \[(\d+), (\d+)\]")
    (code,) = supervisor.wait_for(r"^class code: +(\w+) ")
    (key,) = supervisor.wait_for(r"^teacher's key: +([\w-]+) ")
    for process in (supervisor.process.pid, *supervisor.workers()):
        line = Path(f"/proc/{process}/cmdline").read_bytes()
        assert key.encode() not in line and key.replace("-", "").encode() not in line
    with (
        Student(f"ws://127.0.0.1:{first}") as ada,
        Student(f"ws://127.0.0.1:{second}") as eve,
        Student(f"ws://127.0.0.1:{first}") as teacher,
    ):
        join(ada, code, "Ada")
        join(eve, code, HOSTILE)
        come(teacher)
        teacher.set("Teacher's key", key)
        press(teacher, "Open the teacher's page")
        teacher.read(lambda: teacher.sees("Ada") and teacher.sees("&lt;img src=x onerror=1&gt;"))
        assert not teacher.sees("<img src=x")
        _freeze(teacher, [ada, eve])
        _follow(teacher, eve)
        _is_kept(supervisor, ada)
        teacher.close()
        teacher.address = f"ws://127.0.0.1:{second}"  # a proxy chose otherwise
        teacher.open()
        teacher.read(lambda: teacher.sees("2 in the class"))
    supervisor.process.send_signal(signal.SIGINT)
    assert supervisor.process.wait(15) == 0
    assert "Traceback" not in supervisor.said


def _is_kept(supervisor: Supervisor, student: Student) -> None:
    """A lab in which nothing has been done: its student is to be found again all the same."""
    wait_for(lambda: supervisor.records.load(student.code), 60.0)


def _freeze(teacher: Student, students: list[Student]) -> None:
    frozen = ENGLISH("class.frozen")
    press(teacher, "Freeze all labs")
    assert read_all(students, lambda tab: tab.sees(frozen)) < SOON
    press(teacher, "Let all labs go on")
    read_all(students, lambda tab: not tab.sees(frozen))  # a frozen lab has no frames to count by


def _follow(teacher: Student, student: Student) -> None:
    """A student whose lab lives in the other worker."""
    student.set("K2", 44.0)
    teacher.set("Follow", f"2. {HOSTILE}")
    teacher.read(lambda: teacher.sees("This is the lab of"))
    before, shown = teacher.moving, student.moving
    press(student, "Hold both back")
    student.read(lambda: student.moving > shown + 30)
    teacher.read(lambda: teacher.moving > before + 10)
    assert not teacher.has_widget("Hold both back")
