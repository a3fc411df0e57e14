"""Connects the server to the class: decides which page each client gets."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import viser

from onpath.app.classroom.class_sync import ClassSync
from onpath.app.classroom.classroom import Classroom
from onpath.app.classroom.relay import Relay
from onpath.app.classroom.shared_classroom import SharedClassroom
from onpath.app.classroom.watches import Watches
from onpath.app.lab.commands import CloseLesson, ReportState, TakeSetup
from onpath.app.lab.lab import Lab
from onpath.app.lab.setups.capture import capture
from onpath.app.page.page_context import ClassSeat
from onpath.app.page.teacher_context import TeacherChoices, TeacherContext
from onpath.app.server.followed_lab import FollowedLab
from onpath.app.server.lab_registry import LabRegistry
from onpath.app.simulation.simulation_thread import ScheduledLab
from onpath.app.storage.lab_state import keep
from onpath.app.storage.records import Records
from onpath.app.storage.write_behind import WriteBehind

TEACHER_KEY = "onpath_teacher"  # in the browser's storage


class ClassService:
    """The class of one server process.

    Args:
        records, keeper: delete a student's data when the teacher asks for it.
    """

    def __init__(
        self,
        classroom: Classroom,
        sessions: LabRegistry,
        records: Records | None = None,
        keeper: WriteBehind | None = None,
    ) -> None:
        self._class, self._sessions = classroom, sessions
        self._records, self._keeper = records, keeper
        self._teachers: dict[int, tuple[str, TeacherChoices]] = {}
        self._attendance = ClassSync(classroom, self._student)
        self._attendance.rounds.start()
        self._relay: Relay | None = None
        if isinstance(classroom, SharedClassroom) and records is not None:
            watches = Watches(records, classroom.id)
            simulation = sessions.simulation
            self._relay = Relay(watches, self._here, self._wanted, sessions.make, simulation)
            self._relay.rounds.start()

    def stop(self) -> None:
        """Stop, with the server."""
        self._attendance.rounds.stop()
        if self._relay is not None:
            self._relay.rounds.stop()

    def greet(self, client: viser.ClientHandle, shown: str | None) -> None:
        """Make a browser that was a teacher's a teacher's again.

        Args:
            shown: the value that it keeps under `TEACHER_KEY`.
        """
        try:
            if shown is not None and self._class.is_pass(shown):
                self._teachers[client.client_id] = (shown, TeacherChoices())
        except OSError:
            return  # a student's page is open to everybody

    def gone(self, client: int) -> None:
        """Forget a client that has disconnected."""
        self._teachers.pop(client, None)

    def nickname(self, code: str) -> str:
        """Nickname of the student of a lab; empty until the student joins."""
        member = self._class.member(code)
        return member.name if member else ""

    def seat(self, client: viser.ClientHandle, code: str, reopen: Callable[[], None]) -> ClassSeat:
        """A lab's place in the class.

        Args:
            code: session code of the lab.
            reopen: rebuilds the client's page.
        """

        def teach(key: str) -> None:
            shown = self._class.admit(key, code)
            self._class.leave(code)
            self._teachers[client.client_id] = (shown, TeacherChoices())
            client.local_storage.set_item(TEACHER_KEY, shown)
            reopen()

        def join(typed: str, nickname: str) -> None:
            self._class.join(code, typed, nickname)
            entry, keeper = self._sessions.find(code), self._keeper
            if entry is not None and keeper is not None:  # so that other processes find it
                submit = partial(keeper.submit, code)
                entry.scheduled.lab.post(ReportState(lambda lab: keep(lab, submit)))

        return ClassSeat(
            join=join,
            leave=lambda: self._class.leave(code),
            teach=teach,
        )

    def teaches(self, client: int) -> bool:
        """Whether a client is a teacher."""
        return client in self._teachers

    def followed(self, client: int) -> FollowedLab | None:
        """The lab that a teacher follows instead of their own; None for other clients."""
        teacher = self._teachers.get(client)
        if teacher is None:
            return None
        return FollowedLab(self._class, teacher[1], partial(self._lab, client))

    def teaching(
        self, client: viser.ClientHandle, lab: Lab, reopen: Callable[[], None]
    ) -> TeacherContext | None:
        """The teacher's page; None for other clients.

        Args:
            lab: the teacher's own; an open lesson is closed.
            reopen: rebuilds the client's page.
        """
        teacher, followed = self._teachers.get(client.client_id), self.followed(client.client_id)
        if teacher is None or followed is None:
            return None
        shown, chosen = teacher
        lab.post(CloseLesson())

        def send_setup() -> None:
            push = self._class.push
            lab.post(ReportState(lambda own: push(TakeSetup(capture(own.session)))))

        def stop() -> None:
            self._teachers.pop(client.client_id, None)
            client.local_storage.remove_item(TEACHER_KEY)
            reopen()
            self._class.revoke(shown)

        return TeacherContext(
            classroom=self._class,
            chosen=chosen,
            progress=lambda: lab.lessons.progress,
            why_still=followed.why_still,
            send_setup=send_setup,
            forget=self._forget,
            stop=stop,
        )

    def _student(self, code: str) -> tuple[Lab, bool] | None:
        entry = self._sessions.find(code)
        return None if entry is None else (entry.scheduled.lab, entry.client is not None)

    def _lab(self, client: int, code: str) -> ScheduledLab | None:
        """The lab with this code, for a teacher's page."""
        here = self._here(code)
        if here is None and self._relay is not None:
            return self._relay.mirror(client, code)
        return here

    def _here(self, code: str) -> ScheduledLab | None:
        """The lab with this code, if it is in this process."""
        entry = self._sessions.find(code)
        return None if entry is None or self._class.is_elsewhere(code) else entry.scheduled

    def _wanted(self) -> dict[int, str]:
        """Codes of the students' labs that teachers in this process follow, by client."""
        chosen = {client: chosen.followed for client, (_, chosen) in [*self._teachers.items()]}
        there = self._class.members()
        return {c: code for c, code in chosen.items() if code in there and not self._here(code)}

    def _forget(self) -> int:
        self._class.end()
        if self._records is None:
            return 0
        if self._keeper is None:
            return self._records.delete_all()
        return self._keeper.forget(self._records.delete_all)
