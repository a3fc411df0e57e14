"""Connects the server to a class: decides which page each client gets."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import viser

from onpath.app.classroom.class_keeper import ClassKeeper
from onpath.app.classroom.class_sync import ClassSync
from onpath.app.classroom.classroom import Classroom
from onpath.app.lab.commands import CloseLesson, ReportState, TakeSetup
from onpath.app.lab.lab import Lab
from onpath.app.lab.setups.capture import capture
from onpath.app.page.page_context import ClassSeat
from onpath.app.page.teacher_context import TeacherChoices, TeacherContext
from onpath.app.server.followed_lab import FollowedLab
from onpath.app.server.lab_registry import LabRegistry
from onpath.app.server.site_address import is_local
from onpath.app.simulation.scheduled_lab import ScheduledLab
from onpath.app.storage.lab_state import keep
from onpath.app.storage.records import HeldElsewhere, Records
from onpath.app.storage.write_behind import WriteBehind
from onpath.app.viser_adapter.addresses import class_address, storage_key
from onpath.lessons.course import Course
from onpath.models.errors import CodedError

TEACHER_KEY = "onpath_teacher"  # in the browser's storage


class ClassService:
    """A class of one server process.

    Args:
        prefix: of its page's address, see `app.viser_adapter.addresses`.
        course: the lessons, which may have changed since the class was stored.
        records: store the class, and students' data, which a teacher may delete.
        keeper: stores a student's lab on joining.
        lost: called with the clients of the class when another process has taken it over.
    """

    def __init__(
        self,
        classroom: Classroom,
        registry: LabRegistry,
        prefix: str,
        course: Course,
        records: Records | None = None,
        keeper: WriteBehind | None = None,
        lost: Callable[[set[int]], None] = lambda _: None,
    ) -> None:
        self._class, self._registry, self._course = classroom, registry, course
        self._records, self._keeper, self._lost = records, keeper, lost
        self._clients = set[int]()
        self._teachers: dict[int, tuple[str, TeacherChoices]] = {}
        self._teacher_key = storage_key(TEACHER_KEY, prefix)
        self._attendance = ClassSync(classroom, self._student)
        self._attendance.rounds.start()
        self._class_keeper: ClassKeeper | None = None
        if records is not None:
            self._class_keeper = ClassKeeper(classroom, records, self._give_up)
            self._class_keeper.rounds.start()

    def stop(self) -> None:
        """Stop, with the server."""
        self._attendance.rounds.stop()
        if self._class_keeper is not None:
            self._class_keeper.stop()

    @property
    def stored_as(self) -> str:
        """The name of the class in the database; empty if it is not stored."""
        return self._class_keeper.id if self._class_keeper is not None else ""

    @property
    def in_use(self) -> bool:
        """Whether the class has clients here, so that it must not move to another process."""
        return bool(self._clients)

    def greet(self, client: viser.ClientHandle, shown: str | None) -> bool:
        """Receive a client; a teacher's browser becomes a teacher's again.

        Args:
            shown: the value that the browser has stored under `TEACHER_KEY`.

        Returns:
            Whether this process has the class; if not, another one has it open.
        """
        if self._class_keeper is not None and not self._class_keeper.open():
            return False
        pace = self._class.orders.pace
        if pace is not None and not self._course.has_steps(pace.lesson, pace.first, pace.last):
            self._class.keep_within(None)
        self._clients.add(client.client_id)
        if shown is not None and self._class.is_pass(shown):
            self._teachers[client.client_id] = (shown, TeacherChoices())
        return True

    def gone(self, client: int) -> None:
        """Forget a client that has disconnected."""
        self._clients.discard(client)
        self._teachers.pop(client, None)

    def nickname(self, code: str) -> str:
        """Nickname of the student of a lab; empty until the student joins."""
        member = self._class.member(code)
        return member.name if member else ""

    def seat(self, client: viser.ClientHandle, code: str, reopen: Callable[[], None]) -> ClassSeat:
        """A lab's place in the class.

        Args:
            code: code of the lab.
            reopen: rebuilds the client's page.
        """

        def teach(key: str) -> str:
            shown = self._class.admit(key, code)
            self._class.leave(code)
            self._teachers[client.client_id] = (shown, TeacherChoices())
            client.local_storage.set_item(self._teacher_key, shown)
            reopen()
            return ""

        def join(typed: str, nickname: str) -> str:
            self._class.join(code, typed, nickname)
            entry, keeper = self._registry.find(code), self._keeper
            if entry is not None and keeper is not None:  # the class needs the lab in the database
                submit = partial(keeper.submit, code)
                entry.scheduled.lab.post(ReportState(lambda lab: keep(lab, submit)))
            return ""

        return ClassSeat(
            join=join,
            leave=lambda: self._class.leave(code),
            teach=teach,
            code=self._class.code,
        )

    def teaches(self, client: int) -> bool:
        """Whether a client is a teacher."""
        return client in self._teachers

    def followed(self, client: int) -> FollowedLab | None:
        """The lab that a teacher follows instead of their own; None for other clients."""
        teacher = self._teachers.get(client)
        if teacher is None:
            return None
        return FollowedLab(self._class, teacher[1], self._lab)

    def teaching(
        self, client: viser.ClientHandle, lab: Lab, reopen: Callable[[], None], site: str
    ) -> TeacherContext | None:
        """The teacher's page; None for other clients.

        Args:
            lab: the teacher's own lab, whose open lesson is closed.
            reopen: rebuilds the client's page.
            site: address of the site for students.
        """
        teacher, followed = self._teachers.get(client.client_id), self.followed(client.client_id)
        if teacher is None or followed is None:
            return None
        shown, chosen = teacher
        lab.post(CloseLesson())

        def send_setup() -> None:
            push = self._class.push
            lab.post(ReportState(lambda state: push(TakeSetup(capture(state.simulation)))))

        def stop() -> None:
            self._teachers.pop(client.client_id, None)
            client.local_storage.remove_item(self._teacher_key)
            reopen()
            self._class.revoke(shown)

        return TeacherContext(
            classroom=self._class,
            chosen=chosen,
            address=f"{site}{class_address(self._class.code)}",
            is_local=is_local(site),
            progress=lambda: lab.lessons.progress,
            presents=lambda: lab.simulation.settings.presenting,
            why_still=followed.why_still,
            send_setup=send_setup,
            delete=self._delete,
            forget=self._forget,
            stop=stop,
        )

    def _student(self, code: str) -> tuple[Lab, bool] | None:
        entry = self._registry.find(code)
        return None if entry is None else (entry.scheduled.lab, entry.client is not None)

    def _lab(self, code: str) -> ScheduledLab | None:
        """The lab with this code, for a teacher's page."""
        entry = self._registry.find(code)
        return None if entry is None else entry.scheduled

    def _give_up(self) -> None:
        """Send all clients away when another process has the class; they reconnect to that one."""
        self._lost(set(self._clients))

    def _delete(self, code: str) -> None:
        """Delete a student's lab with all stored data, and the student's seat.

        Raises:
            NotKept: it could not be deleted; the student is still in the class.
            ValueError: the lab is open in another process.
        """
        delete = self._records.delete if self._records is not None else lambda _: 0
        entry = self._registry.find(code)
        client = None if entry is None else entry.client
        try:
            self._registry.delete(code, delete)
        except HeldElsewhere:
            raise CodedError("error.lab_is_open") from None
        finally:
            if client is not None and self._registry.find(code) is not entry:
                self._lost({client})  # the page comes back with a new lab
        self._class.leave(code)
        if self._class_keeper is not None:
            self._class_keeper.look()

    def _forget(self) -> int:
        """Delete the class and all of its students' labs. Returns their number."""
        codes = list(self._class.members())
        for code in codes:
            self._delete(code)
        self._class.end()
        return len(codes)
