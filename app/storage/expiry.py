"""Deletes stored labs that have not been used for long, and the least recent if there are too many.

Classes are deleted some days after their last change.
"""

from __future__ import annotations

import logging
import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass

import msgspec
import sqlalchemy as sa

from onpath.app.common.periodic import Periodic
from onpath.app.storage.records import NotKept, Records
from onpath.app.storage.schema import classes, labs, leases

log = logging.getLogger(__name__)

DAY = 24 * 3600.0  # [s] in a day
KEEP_DAYS, MOST_LABS = 365, 100_000
CLASS_DAYS = 7
TOUCH_INTERVAL = 300.0  # [s] between marks on the labs that are in use
IN_USE = 3 * TOUCH_INTERVAL  # [s] after its last mark for which a lab counts as in use


@dataclass(frozen=True, slots=True)
class Retention:
    """How long labs are kept, and how many.

    A lab is in use while it is open, and used whenever it is opened or changed. A lab used within
    the last `IN_USE` seconds, in any process that shares the database, is not deleted.

    Attributes:
        days: a lab that has not been used for this number of days is deleted.
        most: if a database holds more labs, the least recently used are deleted.
        class_days: a class that has not been changed for this number of days is deleted, or sooner
            if its teacher wants.

    Raises:
        ValueError: a number is not positive.
    """

    days: int = KEEP_DAYS
    most: int = MOST_LABS
    class_days: int = CLASS_DAYS

    def __post_init__(self) -> None:
        if self.days < 1:
            raise ValueError(f"--keep-days {self.days}: expected 1 or more")
        if self.most < 1:
            raise ValueError(f"--most-labs {self.most}: expected 1 or more")
        if self.class_days < 1:
            raise ValueError(f"--keep-class-days {self.class_days}: expected 1 or more")


def kept_days(state: str, most: int) -> int:
    """For how many days a stored class is kept: as its teacher wants, but at most `most`."""
    try:
        days = msgspec.json.decode(state, type=_Kept).days
    except msgspec.DecodeError:
        return most
    return min(days, most) if days > 0 else most


class _Kept(msgspec.Struct):
    days: int = 0


class Expiry:
    """Applies a retention to a database at the start, and then daily.

    Args:
        in_use: returns the codes of the labs that are open in this process.
        clock: seconds since 1970.
    """

    def __init__(
        self,
        records: Records,
        retention: Retention,
        in_use: Callable[[], Iterable[str]] = tuple,
        clock: Callable[[], float] = time.time,
    ) -> None:
        self._records, self._retention, self._clock = records, retention, clock
        self._in_use = in_use
        self._rounds = Periodic("expiry", DAY, self._run)
        self._touches = Periodic("use of labs", TOUCH_INTERVAL, self._touch)

    def start(self) -> None:
        """Delete now, and daily from now on."""
        self._run()
        self._rounds.start()
        self._touches.start()

    def stop(self) -> None:
        """Stop the daily deletion."""
        self._rounds.stop()
        self._touches.stop()

    def delete(self) -> int:
        """Delete labs by age and by number, and old classes. Returns how many labs were deleted.

        Raises:
            NotKept: the database cannot be used.
        """
        self._records.touch(self._in_use())
        now, newest = self._clock(), labs.c.updated.desc()
        surplus = sa.select(labs.c.code).order_by(newest, labs.c.code).offset(self._retention.most)
        old = labs.c.updated < now - self._retention.days * DAY
        wanted = (old | labs.c.code.in_(surplus)) & (labs.c.updated < now - IN_USE)
        with self._records.transaction() as connection:
            ended = self._ended(connection, now)
            connection.execute(sa.delete(leases).where(leases.c.until < now - DAY))
            count = connection.execute(sa.delete(labs).where(wanted)).rowcount
        self._records.end_classes(ended)
        return count

    def _ended(self, connection: sa.Connection, now: float) -> dict[str, float]:
        """The classes whose time is over; that of a broken one is the longest."""
        columns = classes.c.code, classes.c.updated, classes.c.state
        rows = connection.execute(sa.select(*columns).where(classes.c.updated < now - DAY)).all()
        most = self._retention.class_days
        return {
            code: updated
            for code, updated, state in rows
            if updated < now - kept_days(state, most) * DAY
        }

    def _run(self) -> None:
        try:
            if count := self.delete():
                log.info("%d labs deleted: not used for long, or too many", count)
        except NotKept as error:
            log.warning("old labs are not deleted: %s", error)

    def _touch(self) -> None:
        try:
            self._records.touch(self._in_use())
        except NotKept as error:
            log.debug("labs in use are not marked: %s", error)
