"""Leases: which of the processes that share a database has a lab, by session code.

A lease expires unless it is renewed, so that the labs of a process that died can be taken over. A
released lease keeps the name of its owner, so that the owner can tell later whether another process
has had the lab in between.
"""

from __future__ import annotations

import logging
import time
from collections.abc import Callable, Iterable
from typing import Any

import sqlalchemy as sa
from sqlalchemy import exc

from onpath.app.common.periodic import Periodic
from onpath.app.storage.records import NotKept, Records
from onpath.app.storage.schema import labs, leases

log = logging.getLogger(__name__)

TERM = 4.0  # [s], duration of a lease; clocks of the processes must differ by less
RENEWAL = 1.0  # [s] between renewals
NONSENSE = 3 * TERM  # [s]; a lease that lasts longer was written with a wrong clock
LOOK = 0.1  # [s] between polls of another owner's lease
FORGOTTEN = 3600.0  # [s] after which expired leases are deleted


class Leases:
    """The leases of one process, the owner. Thread-safe.

    Args:
        records: the database.
        owner: a unique name; by default that of `records`.
        clock: seconds since 1970, roughly the same for all owners.
        sleep: waits for some seconds.
    """

    def __init__(
        self,
        records: Records,
        owner: str | None = None,
        clock: Callable[[], float] = time.time,
        sleep: Callable[[float], None] = time.sleep,
    ) -> None:
        self._records, self._clock, self._sleep = records, clock, sleep
        self._owner = owner or records.owner
        self._rounds: Periodic | None = None

    @property
    def warning(self) -> str:
        """See `Records.warning`."""
        return self._records.warning

    @property
    def generation(self) -> int:
        """See `Records.generation`."""
        return self._records.generation

    def save(self, code: str, state: dict[str, Any]) -> None:
        """See `Records.save`. Raises HeldElsewhere if another owner has the lab."""
        self._records.save(code, state, self._owner)

    def available(self, codes: list[str]) -> list[str]:
        """Those codes that no other living owner holds.

        Blocks for up to about TERM until it is clear whether an owner renews its lease. Returns all
        codes if the database cannot be used.
        """
        try:
            first = self._others(codes)
            while True:
                now = self._others(codes)
                unclear = [code for code in now if now[code] == first.get(code)]
                if not unclear:
                    return [code for code in codes if code not in now]
                self._sleep(LOOK)
        except NotKept:
            return codes

    def claim(self, code: str) -> bool | None:
        """Take a lab, which counts as its use; see `Retention`.

        Returns:
            None if another owner has it. Otherwise True if no other owner has had it since this one
            released it, and False if one has.

        Raises:
            NotKept: the database cannot be used.
        """
        try:
            with self._records.transaction() as connection:
                return self._claim(connection, code)
        except exc.IntegrityError:  # another process took it first
            return None

    def release(self, *codes: str) -> None:
        """Release some labs, or all if none is named; they can be claimed again by any process."""
        ours = leases.c.owner == self._owner
        if codes:
            ours &= leases.c.code.in_(codes)
        try:
            with self._records.transaction() as connection:
                past = self._clock() - TERM
                connection.execute(sa.update(leases).where(ours).values(expires=past))
        except NotKept as error:
            log.info("a lease expires by itself: %s", error)

    def renew(self, codes: Iterable[str]) -> list[str]:
        """Renew the leases of some labs. Returns those that another owner has taken.

        Raises:
            NotKept: the database cannot be used; then other owners cannot take anything either.
        """
        codes, mine = list(codes), self._mine()
        ours = leases.c.code.in_(codes) & (leases.c.owner == self._owner)
        known = sa.select(leases.c.code, leases.c.owner).where(leases.c.code.in_(codes))
        with self._records.transaction() as connection:
            old = leases.c.expires < self._clock() - FORGOTTEN
            connection.execute(sa.delete(leases).where(old))
            owners = {row.code: row.owner for row in connection.execute(known.with_for_update())}
            connection.execute(sa.update(leases).where(ours).values(mine))
            if new := [{"code": code, **mine} for code in codes if code not in owners]:
                connection.execute(sa.insert(leases), new)
        return [code for code in codes if owners.get(code, self._owner) != self._owner]

    def keep(self, held: Callable[[], list[str]], lost: Callable[[str], None]) -> None:
        """Renew periodically, in a thread of its own, until `close`.

        Args:
            held: returns the labs that are in use.
            lost: called for each lab that another owner has taken.
        """

        def renew() -> None:
            try:
                for code in self.renew(codes) if (codes := held()) else ():
                    lost(code)
            except NotKept as error:
                log.debug("leases are not renewed: %s", error)

        self._rounds = Periodic("leases", RENEWAL, renew)
        self._rounds.start()

    def close(self) -> None:
        """Stop renewing, and release all leases."""
        if self._rounds is not None:
            self._rounds.stop(patience=0.0)
        self.release()

    def _claim(self, connection: sa.Connection, code: str) -> bool | None:
        wanted = sa.select(leases.c.owner, leases.c.expires).where(leases.c.code == code)
        row = connection.execute(wanted.with_for_update()).first()
        now, mine = self._clock(), self._mine()
        if row is not None and row.owner != self._owner and now < row.expires < now + NONSENSE:
            return None
        connection.execute(sa.update(labs).where(labs.c.code == code).values(updated=now))
        if row is None:
            connection.execute(sa.insert(leases).values(code=code, **mine))
            return True
        connection.execute(sa.update(leases).where(leases.c.code == code).values(mine))
        return row.owner == self._owner

    def _mine(self) -> dict[str, Any]:
        """The columns of a lease of this owner, renewed now."""
        return {"owner": self._owner, "expires": self._clock() + TERM}

    def _others(self, codes: list[str]) -> dict[str, tuple[str, float]]:
        """Leases of other owners that have not expired, by code: (owner, expiry)."""
        theirs = leases.c.code.in_(codes) & (leases.c.owner != self._owner)
        now = self._clock()
        wanted = sa.select(leases).where(theirs & leases.c.expires.between(now, now + NONSENSE))
        with self._records.transaction() as connection:
            return {row.code: (row.owner, row.expires) for row in connection.execute(wanted)}
