"""The class of a single-process server, kept in memory only. Independent of viser; thread-safe."""

from __future__ import annotations

import hmac
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, field, replace

from onpath.app.classroom.admission import Admission, new_class_code, new_pass
from onpath.app.classroom.classroom import Member, Orders, Push, noted, seated
from onpath.app.common.access_codes import new_code
from onpath.app.lab.commands import TakeStep
from onpath.lessons.pace import Pace


@dataclass(slots=True)
class LocalClassroom:
    """See `app.classroom.classroom.Classroom`.

    Attributes:
        key: the teacher's key, as stored by `app.common.access_codes`.
    """

    clock: Callable[[], float] = time.monotonic
    code: str = ""
    key: str = field(default_factory=new_code, repr=False)
    _members: dict[str, Member] = field(default_factory=dict)
    _orders: Orders = field(default_factory=Orders)
    _joined: int = 0
    _passes: set[str] = field(default_factory=set)
    _lock: threading.RLock = field(default_factory=threading.RLock)
    _door: Admission = field(init=False)

    def __post_init__(self) -> None:
        self.code = self.code or new_class_code()
        self._door = Admission(self.clock)

    # Teachers

    def admit(self, typed: str, who: str) -> str:
        """See `Classroom.admit`."""
        self._door.check_key(typed, self.key, who)
        new = new_pass()
        with self._lock:
            self._passes.add(new)
        return new

    def is_pass(self, shown: str | None) -> bool:
        """See `Classroom.is_pass`."""
        given = (shown or "")[:100].encode(errors="replace")
        with self._lock:
            return any([hmac.compare_digest(given, own.encode()) for own in self._passes])

    def revoke(self, shown: str | None) -> None:
        """See `Classroom.revoke`."""
        with self._lock:
            self._passes.discard(shown or "")

    # Members

    def join(self, session: str, typed: str, name: str) -> Member:
        """See `Classroom.join`."""
        self._door.check_code(typed, self.code, session)
        with self._lock:
            new = Member(self._joined + 1, "", active=self.clock())
            member = self._members[session] = seated(self._members, session, name, new)
            self._joined = max(self._joined, member.number)
            return member

    def leave(self, session: str) -> None:
        """See `Classroom.leave`."""
        with self._lock:
            self._members.pop(session, None)

    def member(self, session: str) -> Member | None:
        """See `Classroom.member`."""
        return self._members.get(session)

    def members(self) -> dict[str, Member]:
        """See `Classroom.members`."""
        with self._lock:
            return dict(self._members)

    def look(self) -> None:
        """Does nothing: all state is local."""

    def is_elsewhere(self, session: str) -> bool:
        """Always False: there is only one process."""
        return False

    def note(self, session: str, **changes: object) -> None:
        """See `Classroom.note`."""
        with self._lock:
            old = self._members.get(session)
            if old is not None:
                self._members[session] = noted(old, changes)

    # Orders

    @property
    def orders(self) -> Orders:
        """See `Classroom.orders`."""
        return self._orders

    def freeze(self, on: bool) -> None:
        """See `Classroom.freeze`."""
        with self._lock:
            self._orders = replace(self._orders, frozen=on)

    def push(self, push: Push | None) -> None:
        """See `Classroom.push`."""
        with self._lock:
            count, pace = self._orders.pushes + (push is not None), self._orders.pace
            if isinstance(push, TakeStep) and pace and not pace.holds(push.lesson, push.step):
                pace = None
            self._orders = replace(self._orders, pushes=count, push=push, pace=pace)

    def keep_within(self, pace: Pace | None) -> None:
        """Let students go within a range of steps only; None lets them go anywhere.

        Whoever is outside, also when joining later, is brought to its first step. A step that is
        sent and lies outside ends it.
        """
        with self._lock:
            self._orders = replace(self._orders, pace=pace)

    def end(self) -> int:
        """See `Classroom.end`."""
        with self._lock:
            count = len(self._members)
            self._members.clear()
            self._orders = replace(self._orders, frozen=False, push=None, pace=None)
            self.code = new_class_code()
            return count
