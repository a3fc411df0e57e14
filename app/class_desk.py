"""Between the server and the class: who gets which page."""

from __future__ import annotations

from collections.abc import Callable

import viser

from app.attendance import Attendance
from app.database import Records
from app.desk import Seat
from app.keeper import Keeper
from app.loop import Lab
from app.room import Room
from app.session import Session
from app.sessions import Sessions
from app.teaching import Chosen, Teaching

STORAGE_KEY = "onpath_teacher"
STORAGE_WAIT = 3.0  # [s]


class ClassDesk:
    """The class of one server process.

    Args:
        records, keeper: what forgets when the teacher says so.
    """

    def __init__(
        self,
        classroom: Room,
        sessions: Sessions,
        records: Records | None = None,
        keeper: Keeper | None = None,
    ) -> None:
        self._class, self._sessions = classroom, sessions
        self._records, self._keeper = records, keeper
        self._teachers: dict[int, tuple[str, Chosen]] = {}
        self._attendance = Attendance(classroom, self._student)
        self._attendance.start()

    def stop(self) -> None:
        """The server ends."""
        self._attendance.stop()

    def greet(self, client: viser.ClientHandle) -> None:
        """A browser that was a teacher's is one again."""
        try:
            shown = client.local_storage.get_item(STORAGE_KEY, timeout=STORAGE_WAIT)
        except (RuntimeError, TimeoutError):
            return
        if shown is not None and self._class.is_pass(shown):
            self._teachers[client.client_id] = (shown, Chosen())

    def gone(self, client: int) -> None:
        """A browser has left."""
        self._teachers.pop(client, None)

    def seat(self, client: viser.ClientHandle, code: str, reopen: Callable[[], None]) -> Seat:
        """A lab's place in the class.

        Args:
            code: of its session.
            reopen: build the client's page anew.
        """

        def name() -> str:
            member = self._class.member(code)
            return member.name if member else ""

        def teach(key: str) -> None:
            shown = self._class.admit(key, code)
            self._class.leave(code)
            self._teachers[client.client_id] = (shown, Chosen())
            client.local_storage.set_item(STORAGE_KEY, shown)
            reopen()

        return Seat(
            name=name,
            join=lambda typed, nickname: self._class.join(code, typed, nickname),
            leave=lambda: self._class.leave(code),
            teach=teach,
        )

    def teaching(self, client: viser.ClientHandle, reopen: Callable[[], None]) -> Teaching | None:
        """For a teacher's page; None for everybody else."""
        teacher = self._teachers.get(client.client_id)
        if teacher is None:
            return None
        shown, chosen = teacher

        def stop() -> None:
            self._class.revoke(shown)
            self._teachers.pop(client.client_id, None)
            client.local_storage.remove_item(STORAGE_KEY)
            reopen()

        return Teaching(self._class, chosen, self._lab, self._forget, stop)

    def _student(self, code: str) -> tuple[Session, bool] | None:
        entry = self._sessions.find(code)
        return None if entry is None else (entry.lab.session, entry.client is not None)

    def _lab(self, code: str) -> Lab | None:
        entry = self._sessions.find(code)
        return None if entry is None else entry.lab

    def _forget(self) -> int:
        self._class.end()
        if self._records is None:
            return 0
        if self._keeper is None:
            return self._records.delete_all()
        return self._keeper.forget(self._records.delete_all)
