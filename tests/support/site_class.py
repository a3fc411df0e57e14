"""A class on a site of two processes: a teacher and two students, and what is kept of them."""

from __future__ import annotations

import time
from collections.abc import Callable
from contextlib import ExitStack, suppress
from typing import Any

from websockets.exceptions import ConnectionClosed

from onpath.app.classroom.admission import class_code_of, class_id_of
from onpath.app.common.access_codes import shown
from onpath.app.storage.records import Records
from onpath.app.storage.schema import classes
from tests.support.lab_process import LabProcess
from tests.support.site import Site
from tests.support.student import Student
from tests.support.waiting import wait_for

RECONNECTION = 0.5  # [s] between the tries of a page that has lost its server, about
KEYS = "k7mf2xqa9tzr", "k7mf2xqa9tzs"
CODES = [class_code_of(key) for key in KEYS]


class Running:
    """A site, and what it keeps."""

    def __init__(self, found: Site, database: str) -> None:
        self.site, self.records = found, Records(database)

    def has_kept(self, code: str, *words: str) -> bool:
        state = str(self.records.load(code))
        return all(word in state for word in words)

    def kept_class(self) -> dict[str, Any]:
        return self.records.load(class_id_of(KEYS[0]), classes) or {}


def quiet(running: Running) -> None:
    """Wait until nobody is connected."""
    wait_for(lambda: not any(p.connections() for p in running.site.processes), 60.0)


def return_to(process: LabProcess, running: Running, prefix: str) -> None:
    """Wait until the process of a prefix serves it again."""

    def is_back() -> bool:
        served = False
        with suppress(ConnectionClosed), running.site.student(prefix) as student:
            student.open()  # a page that is sent on to the other process asks again
            student.read(lambda: student.code)
            served = running.site.serving() is process
        quiet(running)
        if not served:
            time.sleep(RECONNECTION)
        return served

    wait_for(is_back, 60.0)


class Class:
    """A teacher and two students of one class.

    Args:
        key: its teacher's.
    """

    def __init__(self, running: Running, stack: ExitStack, key: str = KEYS[0]) -> None:
        self.running, self._key = running, key
        self.prefix = f"c/{class_code_of(key)}"
        self.all = [stack.enter_context(running.site.student(self.prefix)) for _ in range(3)]
        self.teacher, self.ada, self.bob = self.all
        self.names = {self.ada: "Ada", self.bob: "Bob"}
        self.open: list[Student] = []

    def until(self, condition: Callable[[], Any]) -> None:
        """Wait for something while all read what they are sent, and connect again when cut off."""

        def read() -> Any:
            for each in self.open:
                try:
                    each.read_what_has_come()
                except ConnectionClosed:  # as viser's page does
                    each.reopen()
            return condition()

        wait_for(read, 120.0)

    def come_in(self) -> None:
        for each in [*self.names, self.teacher]:
            each.open()
            self.open.append(each)
            self.until(lambda each=each: each.may_join)
        for student, name in self.names.items():
            student.join(name)
            self.until(lambda student=student: student.is_member)
            self.names[student] = student.seat["name"]  # another one where a class has it already
        self.teacher.teach(shown(self._key))
        self.until(self.teacher_sees_both)

    def teacher_sees_both(self) -> bool:
        """Whether the teacher's page has both students, and they are there."""
        rows = self.teacher.values.get("class.table", "").split("</tr>")
        own = [row for row in rows for name in self.names.values() if f"<bdi>{name}</bdi>" in row]
        return len(own) == len(self.names) and not any("away" in row for row in own)

    def come_back(self) -> None:
        """Everybody, as their pages do by themselves."""
        for each in self.all:
            each.wait_until_closed()
        for each in self.all:
            each.reopen()
        self.until(self.is_back)

    def is_back(self) -> bool:
        """Whether everybody is in the class, at one process."""
        students = [s.is_member and s.seat["name"] == name for s, name in self.names.items()]
        served = [p for p in self.running.site.processes if p.connections()]
        return self.teacher_sees_both() and all(students) and len(served) == 1
