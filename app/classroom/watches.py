"""Rows in the database that request the states of labs in other processes, and carry them."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Mapping

import sqlalchemy as sa
from sqlalchemy import exc

from onpath.app.storage.records import Records
from onpath.app.storage.schema import watches

LASTS = 4.0  # [s], duration of a request; clocks of the processes must differ by less
NONSENSE = 3 * LASTS  # [s]; a request that lasts longer was written with a wrong clock
GONE = 60.0  # [s] after which expired rows are deleted


class Watches:
    """The requests of one class. Thread-safe; all methods wait for the database, and raise NotKept.

    Args:
        records: the database.
        class_id: the class.
        clock: seconds since 1970, roughly the same for all processes.
    """

    def __init__(
        self, records: Records, class_id: str, clock: Callable[[], float] = time.time
    ) -> None:
        self._records, self._id, self._clock = records, class_id, clock
        self._own = watches.c.class_id == class_id

    def ask(self, sessions: Iterable[str]) -> None:
        """Request the states of labs for `LASTS` seconds."""
        now = self._clock()
        for session in sessions:
            try:
                with self._records.transaction() as connection:
                    old = self._own & ~watches.c.until.between(now - GONE, now + NONSENSE)
                    connection.execute(sa.delete(watches).where(old))
                    again = sa.update(watches).where(self._one(session)).values(until=now + LASTS)
                    if not connection.execute(again).rowcount:
                        new = {"class_id": self._id, "session": session, "moment": ""}
                        connection.execute(sa.insert(watches).values(until=now + LASTS, **new))
            except exc.IntegrityError:
                continue  # another process has asked at the same time

    def asked(self) -> set[str]:
        """Session codes of the labs whose states are requested."""
        now = self._clock()
        there = self._own & watches.c.until.between(now, now + NONSENSE)
        with self._records.transaction() as connection:
            return set(connection.execute(sa.select(watches.c.session).where(there)).scalars())

    def tell(self, moments: Mapping[str, str]) -> None:
        """Publish states of labs, by session code."""
        with self._records.transaction() as connection:
            for session, moment in moments.items():
                new = sa.update(watches).where(self._one(session)).values(moment=moment)
                connection.execute(new)

    def published(self, sessions: Iterable[str]) -> dict[str, str]:
        """Published states of labs, by session code; labs without one are omitted."""
        wanted = sa.select(watches.c.session, watches.c.moment).where(self._own)
        wanted = wanted.where(watches.c.session.in_(list(sessions)) & (watches.c.moment != ""))
        with self._records.transaction() as connection:
            return {row.session: row.moment for row in connection.execute(wanted)}

    def _one(self, session: str) -> sa.ColumnElement[bool]:
        return self._own & (watches.c.session == session)
