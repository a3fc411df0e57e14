"""Operations on a class in the database. Each runs inside a transaction of the caller.

Every change increments the class's change counter, and the changed rows carry its new value; a
reader asks for the counter, and then for rows newer than those it knows. Incrementing locks the
class's row, so that only one process at a time changes the class.

Which students are connected follows from the leases of their labs (app/storage/leases.py), even
when a process was killed.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

import sqlalchemy as sa

from onpath.app.classroom.admission import new_class_code
from onpath.app.classroom.class_rows import (
    ClassRow,
    ProgressCache,
    class_row,
    read_member,
    read_push,
)
from onpath.app.classroom.classroom import Member, Orders, seated
from onpath.app.storage.leases import NONSENSE
from onpath.app.storage.schema import OF_A_CLASS, classes, leases, members, passes, watches

FORGOTTEN = 7 * 24 * 3600.0  # [s] without any change, after which a class is deleted


@dataclass(frozen=True, slots=True)
class ClassState:
    """A class as it was last read.

    Attributes:
        code: the class code.
        changes: value of the change counter.
        orders: what the teacher has sent.
        members: students by session code.
        elsewhere: session codes of the labs that another process had last.
    """

    code: str = ""
    changes: int = -1
    orders: Orders = field(default_factory=Orders)
    members: dict[str, Member] = field(default_factory=dict)
    elsewhere: frozenset[str] = frozenset()


@dataclass(frozen=True, slots=True)
class Now:
    """The present on two clocks.

    Attributes:
        here: the monotonic clock of this process, [s].
        wall: seconds since 1970.
    """

    here: float
    wall: float


class ClassLedger:
    """The rows of one class.

    Args:
        class_id: of the class.
        owner: of the leases of this process; see `app.storage.leases`.
    """

    def __init__(self, class_id: str, owner: str) -> None:
        self._id, self._owner, self._ways = class_id, owner, ProgressCache()
        self._own, self._all = classes.c.id == class_id, members.c.class_id == class_id

    def look(self, connection: sa.Connection, seen: ClassState, now: Now) -> ClassState:
        """The current state, given the one last read."""
        row = self._row(connection, now)
        if row.code != seen.code or row.changes < seen.changes:
            seen = ClassState(row.code)  # a new class, or one whose counter was lost
        orders, there = seen.orders, seen.members
        if row.changes != seen.changes:
            orders = Orders(bool(row.frozen), row.pushes, read_push(row.push))
            there = self._newer(connection, seen, now)
        present, elsewhere = self._leased(connection, now.wall)
        there = {code: _connected(member, code in present) for code, member in there.items()}
        return ClassState(row.code, row.changes, orders, there, elsewhere)

    def change(self, connection: sa.Connection, now: Now, **values: object) -> ClassRow:
        """Increment the change counter, and set columns of the class. Returns the class's row.

        No other process can change the class until the transaction ends.
        """
        new = {"changes": classes.c.changes + 1, "touched": now.wall, **values}
        if not connection.execute(sa.update(classes).where(self._own).values(new)).rowcount:
            self._begin(connection, now)
            connection.execute(sa.update(classes).where(self._own).values(new))
        return self._row(connection, now)

    def enter(
        self, connection: sa.Connection, session: str, name: str, seen: ClassState, now: Now
    ) -> Member:
        """Add a student, or change a student's name.

        Raises:
            ValueError: see `seated`.
        """
        row = self.change(connection, now)
        seen = self.look(connection, seen, now)
        number = row.joined + 1
        new = Member(number, "", active=now.here)
        member = seated(seen.members, session, name, new)
        values = {"changed": row.changes, "name": member.name}
        if session in seen.members:
            connection.execute(sa.update(members).where(self._one(session)).values(values))
            return member
        connection.execute(sa.update(classes).where(self._own).values(joined=number))
        values |= {"class_id": self._id, "session": session, "number": number, "active": now.wall}
        values |= {"taken": member.taken, "progress": self._ways.text(session, member.progress)}
        connection.execute(sa.delete(members).where(self._one(session)))  # an unreadable row
        connection.execute(sa.insert(members).values(values))
        return member

    def write(self, connection: sa.Connection, session: str, changed: int, **values: Any) -> None:
        """Update columns of a student."""
        if "progress" in values:
            values["progress"] = self._ways.text(session, values["progress"])
        new = {"changed": changed, **values}
        connection.execute(sa.update(members).where(self._one(session)).values(new))

    def leave(self, connection: sa.Connection, session: str, now: Now) -> None:
        """Remove a student."""
        self.change(connection, now)
        connection.execute(sa.delete(members).where(self._one(session)))

    def end(self, connection: sa.Connection, now: Now) -> int:
        """Remove all students and create a new class code. Returns the number of students."""
        self.change(connection, now, code=new_class_code(), frozen=0, push="")
        connection.execute(sa.delete(watches).where(watches.c.class_id == self._id))
        return connection.execute(sa.delete(members).where(self._all)).rowcount

    def forget(self, connection: sa.Connection) -> None:
        """Delete all data of the class."""
        _forget(connection, self._own)

    def forget_old(self, connection: sa.Connection, now: Now) -> None:
        """Delete all data of classes without a recent change."""
        _forget(connection, classes.c.touched < now.wall - FORGOTTEN)

    # Passes

    def add_pass(self, connection: sa.Connection, hashed: str) -> None:
        """Allow a browser to teach."""
        connection.execute(sa.insert(passes).values(class_id=self._id, hash=hashed))

    def has_pass(self, connection: sa.Connection, hashed: str) -> bool:
        """Whether a browser may teach."""
        return connection.execute(sa.select(passes).where(self._pass(hashed))).first() is not None

    def remove_pass(self, connection: sa.Connection, hashed: str) -> None:
        """Stop a browser from teaching."""
        connection.execute(sa.delete(passes).where(self._pass(hashed)))

    # Rows

    def _row(self, connection: sa.Connection, now: Now) -> ClassRow:
        wanted = sa.select(classes).where(self._own)
        row = connection.execute(wanted).first()
        found = None if row is None else class_row(row)
        if found is None:
            self._begin(connection, now)
            found = class_row(connection.execute(wanted).one())
            assert found is not None
        return found

    def _begin(self, connection: sa.Connection, now: Now) -> None:
        _forget(connection, self._own)
        new = {"id": self._id, "code": new_class_code(), "touched": now.wall, "push": ""}
        new |= dict.fromkeys(("changes", "joined", "frozen", "pushes"), 0)
        connection.execute(sa.insert(classes).values(new))

    def _newer(self, connection: sa.Connection, seen: ClassState, now: Now) -> dict[str, Member]:
        """All students in order of joining; only changed rows are read."""
        there = set(connection.execute(sa.select(members.c.session).where(self._all)).scalars())
        found = {code: member for code, member in seen.members.items() if code in there}
        newer = sa.select(members).where(self._all & (members.c.changed > seen.changes))
        for row in connection.execute(newer):
            if (read := read_member(row, self._ways, now.wall - now.here)) is not None:
                code, member = read
                least = found[code].active if code in found else member.active
                active = min(max(member.active, least), now.here)  # a clock may have jumped
                found[code] = replace(member, active=active)
        self._ways.keep(there)
        return dict(sorted(found.items(), key=lambda item: item[1].number))

    def _leased(self, connection: sa.Connection, wall: float) -> tuple[set[str], frozenset[str]]:
        """Session codes of the labs that are in use, and of those that another process had last."""
        wanted = sa.select(leases).join(members, leases.c.code == members.c.session)
        rows = connection.execute(wanted.where(self._all)).all()
        present = {row.code for row in rows if wall < row.expires < wall + NONSENSE}
        return present, frozenset(row.code for row in rows if row.owner != self._owner)

    def _one(self, session: str) -> sa.ColumnElement[bool]:
        return self._all & (members.c.session == session)

    def _pass(self, hashed: str) -> sa.ColumnElement[bool]:
        return (passes.c.class_id == self._id) & (passes.c.hash == hashed)


def _connected(member: Member, connected: bool) -> Member:
    return member if member.connected == connected else replace(member, connected=connected)


def _forget(connection: sa.Connection, which: sa.ColumnElement[bool]) -> None:
    ids = sa.select(classes.c.id).where(which)
    for table in OF_A_CLASS:
        connection.execute(sa.delete(table).where(table.c.class_id.in_(ids)))
    connection.execute(sa.delete(classes).where(which))
