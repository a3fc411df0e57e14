"""Who has a lab: of the processes that share a database, one at a time, by session code.

A lease that is not renewed expires: its owner is gone. A lease that was let go keeps its owner's
name, so that the owner knows whether somebody else has had the lab meanwhile.
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
from onpath.app.storage.schema import leases

log = logging.getLogger(__name__)

TERM = 4.0  # [s] without renewal until others may take a lab; clocks may differ by less than this
RENEWAL = 1.0  # [s] between renewals
NONSENSE = 3 * TERM  # [s]; a clock was wrong when a lease says that it lasts longer
LOOK = 0.1  # [s] between looks at somebody else's lease
FORGOTTEN = 3600.0  # [s] after which it does not matter who had a lab


class Leases:
    """The labs of one process, the owner. From any thread.

    Args:
        clock: seconds since 1970, roughly the same for all owners.
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

    def save(self, code: str, state: dict[str, Any]) -> None:
        """See `Records.save`; raises HeldElsewhere for a lab that another owner has."""
        self._records.save(code, state, self._owner)

    def available(self, codes: list[str]) -> list[str]:
        """Those of some codes that no other living owner has.

        Waits, for about TERM, while it is not clear whether an owner is alive. All of them if the
        database cannot say.
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
        """Have a lab.

        Returns:
            None if another owner has it; otherwise whether nobody else has had it meanwhile.

        Raises:
            NotKept: the database cannot say.
        """
        try:
            with self._records.transaction() as connection:
                return self._claim(connection, code)
        except exc.IntegrityError:  # another process was quicker
            return None

    def release(self, *codes: str) -> None:
        """Let labs go, for others or until they are claimed again; all if none is named."""
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
        """Go on having labs. Returns those that another owner has taken.

        Raises:
            NotKept: the database is away; others cannot take anything either.
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
        """Renew in a thread of its own until `close`.

        Args:
            held: the labs that are in use.
            lost: called for each that another owner has taken.
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
        """Let everything go."""
        if self._rounds is not None:
            self._rounds.stop(patience=0.0)
        self.release()

    def _claim(self, connection: sa.Connection, code: str) -> bool | None:
        wanted = sa.select(leases.c.owner, leases.c.expires).where(leases.c.code == code)
        row = connection.execute(wanted.with_for_update()).first()
        now, mine = self._clock(), self._mine()
        if row is None:
            connection.execute(sa.insert(leases).values(code=code, **mine))
            return True
        if row.owner != self._owner and now < row.expires < now + NONSENSE:
            return None
        connection.execute(sa.update(leases).where(leases.c.code == code).values(mine))
        return row.owner == self._owner

    def _mine(self) -> dict[str, Any]:
        """What a lease of ours says from now on."""
        return {"owner": self._owner, "expires": self._clock() + TERM}

    def _others(self, codes: list[str]) -> dict[str, tuple[str, float]]:
        """Leases of other owners that have not expired, by code."""
        theirs = leases.c.code.in_(codes) & (leases.c.owner != self._owner)
        now = self._clock()
        wanted = sa.select(leases).where(theirs & leases.c.expires.between(now, now + NONSENSE))
        with self._records.transaction() as connection:
            return {row.code: (row.owner, row.expires) for row in connection.execute(wanted)}
