"""A class of several processes that share a database. Thread-safe; knows nothing of viser.

Reads are cached. Writes that concern the whole class are queued until the next `look`, several
times a second, so that neither the simulation nor the network waits for the database. Joining,
leaving and ending block until they are written.
"""

from __future__ import annotations

import hashlib
import threading
import time
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any, TypeVar

import sqlalchemy as sa
from sqlalchemy import exc

from onpath.app.classroom.admission import Admission, new_pass
from onpath.app.classroom.class_ledger import ClassLedger, ClassState, Now
from onpath.app.classroom.class_rows import push_text
from onpath.app.classroom.classroom import Member, Orders, Push, noted
from onpath.app.common.error_log import log_warning
from onpath.app.storage.records import NotKept, Records
from onpath.app.storage.schema import classes

LIVELY = 5.0  # [s], largest delay until other processes learn of a student's activity
Result = TypeVar("Result")


class SharedClassroom:
    """A class in the database; see `app.classroom.classroom.Classroom`.

    All processes with the same database and teacher's key have the same class.

    Args:
        records: the database.
        key: the teacher's, in its stored form; see `app.common.access_codes`.
        clock: monotonic, [s].
        wall: seconds since 1970, roughly the same for all processes.

    Attributes:
        id: of the class in the database; a hash, which does not reveal the key.

    Raises:
        NotKept: the database cannot be used.
    """

    def __init__(
        self,
        records: Records,
        key: str,
        clock: Callable[[], float] = time.monotonic,
        wall: Callable[[], float] = time.time,
    ) -> None:
        self.clock, self.key, self._wall = clock, key, wall
        self.id = hashlib.scrypt(key.encode(), salt=b"onpath", n=2**14, r=8, p=1, dklen=20).hex()
        self._records, self._door = records, Admission(clock)
        self._ledger = ClassLedger(self.id, records.owner)
        self._database = threading.RLock()  # held during transactions
        self._lock = threading.Lock()
        self._seen = ClassState()
        self._notes: dict[str, dict[str, Any]] = {}
        self._wanted: list[dict[str, Any]] = []
        self._told: dict[str, float] = {}
        self._transact(lambda connection: self._ledger.forget_old(connection, self._now()))

    # Reads, from the cache

    @property
    def code(self) -> str:
        """See `Classroom.code`."""
        return self._seen.code

    @property
    def orders(self) -> Orders:
        """See `Classroom.orders`."""
        return self._seen.orders

    def member(self, session: str) -> Member | None:
        """See `Classroom.member`."""
        return self._seen.members.get(session)

    def members(self) -> dict[str, Member]:
        """See `Classroom.members`."""
        return dict(self._seen.members)

    def is_elsewhere(self, session: str) -> bool:
        """See `Classroom.is_elsewhere`."""
        return session in self._seen.elsewhere

    # Queued writes

    def note(self, session: str, **changes: object) -> None:
        """See `Classroom.note`. "connected" is ignored; it follows from the leases."""
        changes.pop("connected", None)
        with self._lock:
            old = self._seen.members.get(session)
            if old is None or not changes:
                return
            new = noted(old, changes)
            self._seen = replace(self._seen, members={**self._seen.members, session: new})
            if {*changes} == {"active"} and new.active - self._told.get(session, -LIVELY) < LIVELY:
                return
            self._told[session] = new.active
            self._notes.setdefault(session, {}).update(changes)

    def freeze(self, on: bool) -> None:
        """See `Classroom.freeze`."""
        with self._lock:
            self._wanted.append({"frozen": int(on)})
            self._seen = replace(self._seen, orders=replace(self._seen.orders, frozen=on))

    def push(self, push: Push | None) -> None:
        """See `Classroom.push`."""
        sent = {} if push is None else {"pushes": classes.c.pushes + 1}
        with self._lock:
            self._wanted.append({**sent, "push": push_text(push)})

    def look(self) -> None:
        """See `Classroom.look`. If the database cannot be used, nothing changes."""
        try:
            self._transact(lambda _: None)
        except NotKept as error:
            log_warning("the class cannot be looked at: %s", error)

    # Blocking calls

    def admit(self, typed: str, who: str) -> str:
        """See `Classroom.admit`."""
        self._door.check_key(typed, self.key, who)
        new = new_pass()
        self._transact(lambda connection: self._ledger.add_pass(connection, _hash(new)))
        return new

    def is_pass(self, shown: str | None) -> bool:
        """See `Classroom.is_pass`."""
        with self._records.transaction() as connection:
            return self._ledger.has_pass(connection, _hash(shown or ""))

    def revoke(self, shown: str | None) -> None:
        """See `Classroom.revoke`."""
        self._transact(lambda connection: self._ledger.remove_pass(connection, _hash(shown or "")))

    def join(self, session: str, typed: str, name: str) -> Member:
        """See `Classroom.join`."""
        self._door.check_code(typed, self.code, session)
        return self._transact(
            lambda connection: self._ledger.enter(
                connection, session, name, self._seen, self._now()
            )
        )

    def leave(self, session: str) -> None:
        """See `Classroom.leave`."""
        if session in self._seen.members:
            self._transact(lambda connection: self._ledger.leave(connection, session, self._now()))

    def end(self) -> int:
        """See `Classroom.end`."""
        return self._transact(lambda connection: self._ledger.end(connection, self._now()))

    def dissolve(self) -> None:
        """Delete the class. A process that continues to use it creates a new one."""
        with self._records.transaction() as connection:
            self._ledger.forget(connection)

    # The database

    def _now(self) -> Now:
        return Now(self.clock(), self._wall())

    def _transact(self, act: Callable[[sa.Connection], Result]) -> Result:
        """Write what is queued, act, and read the class, in one transaction."""
        with self._database:
            with self._lock:
                notes, self._notes = self._notes, {}
                wanted, self._wanted = self._wanted, []
            try:
                result, seen = self._written(notes, wanted, act)
            except BaseException:
                with self._lock:
                    for session, changes in notes.items():
                        self._notes[session] = changes | self._notes.get(session, {})
                    self._wanted = [*wanted, *self._wanted]
                raise
            with self._lock:
                self._seen = self._with_waiting(seen)
            return result

    def _written(
        self,
        notes: Mapping[str, dict[str, Any]],
        wanted: list[dict[str, Any]],
        act: Callable[[sa.Connection], Result],
    ) -> tuple[Result, ClassState]:
        for last in (False, True):
            try:
                with self._records.transaction() as connection:
                    self._write(connection, notes, wanted)
                    result = act(connection)
                    return result, self._ledger.look(connection, self._seen, self._now())
            except exc.IntegrityError:  # another process created the class at the same time
                if last:
                    raise NotKept("error.class_not_begun") from None
        raise AssertionError

    def _write(
        self,
        connection: sa.Connection,
        notes: Mapping[str, dict[str, Any]],
        wanted: list[dict[str, Any]],
    ) -> None:
        now = self._now()
        for values in wanted:
            self._ledger.change(connection, now, **values)
        if not notes:
            return
        changed = self._ledger.change(connection, now).changes
        for session, changes in notes.items():
            values = dict(changes)
            if "active" in values:
                values["active"] += now.wall - now.here
            self._ledger.write(connection, session, changed, **values)

    def _with_waiting(self, seen: ClassState) -> ClassState:
        """The class with all queued writes applied."""
        orders, there = seen.orders, dict(seen.members)
        for values in self._wanted:
            if "frozen" in values:
                orders = replace(orders, frozen=bool(values["frozen"]))
        for session, changes in self._notes.items():
            if session in there:
                there[session] = noted(there[session], changes)
        return replace(seen, orders=orders, members=there)


def _hash(shown: str) -> str:
    return hashlib.sha256(shown[:100].encode(errors="replace")).hexdigest()
