"""Deletes stored labs that have not been used for long, and the oldest if there are too many."""

from __future__ import annotations

import logging
import time
from collections.abc import Callable
from dataclasses import dataclass

import sqlalchemy as sa

from onpath.app.common.periodic import Periodic
from onpath.app.storage.leases import NONSENSE
from onpath.app.storage.records import NotKept, Records
from onpath.app.storage.schema import labs, leases

log = logging.getLogger(__name__)

DAY = 24 * 3600.0  # [s]
KEEP_DAYS, MOST_LABS = 365, 100_000


@dataclass(frozen=True, slots=True)
class Retention:
    """How long labs are kept, and how many.

    A lab is used when it is opened and whenever it changes. One that is in use, in any process that
    shares the database, is never deleted.

    Attributes:
        days: a lab that has not been used for this number of days is deleted.
        most: if a database holds more labs, the least recently used are deleted.

    Raises:
        ValueError: a number is not positive.
    """

    days: int = KEEP_DAYS
    most: int = MOST_LABS

    def __post_init__(self) -> None:
        if self.days < 1:
            raise ValueError(f"--keep-days {self.days}: expected 1 or more")
        if self.most < 1:
            raise ValueError(f"--most-labs {self.most}: expected 1 or more")


class Expiry:
    """Applies a retention to a database: at the start, and daily.

    Args:
        clock: seconds since 1970.
    """

    def __init__(
        self, records: Records, retention: Retention, clock: Callable[[], float] = time.time
    ) -> None:
        self._records, self._retention, self._clock = records, retention, clock
        self._rounds = Periodic("expiry", DAY, self._run)

    def start(self) -> None:
        """Delete now, and daily from now on."""
        self._run()
        self._rounds.start()

    def stop(self) -> None:
        """Stop the daily deletion."""
        self._rounds.stop()

    def delete(self) -> int:
        """Delete labs by age and by number. Returns how many were deleted.

        Raises:
            NotKept: the database cannot be used.
        """
        now, newest = self._clock(), labs.c.updated.desc()
        surplus = sa.select(labs.c.code).order_by(newest, labs.c.code).offset(self._retention.most)
        used = sa.select(leases.c.code).where(leases.c.expires > now - NONSENSE)
        old = labs.c.updated < now - self._retention.days * DAY
        wanted = (old | labs.c.code.in_(surplus)) & labs.c.code.not_in(used)
        with self._records.transaction() as connection:
            return connection.execute(sa.delete(labs).where(wanted)).rowcount

    def _run(self) -> None:
        try:
            if count := self.delete():
                log.info("%d labs deleted: not used for long, or too many", count)
        except NotKept as error:
            log.warning("old labs are not deleted: %s", error)
