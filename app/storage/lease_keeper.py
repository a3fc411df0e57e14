"""Renews the leases of a process, and knows which classes other processes have open."""

from __future__ import annotations

import logging
import time
from collections.abc import Callable, Iterable
from math import inf

from onpath.app.common.periodic import Periodic
from onpath.app.storage.leases import RENEWAL
from onpath.app.storage.records import NotKept, Records

log = logging.getLogger(__name__)


class LeaseKeeper:
    """Holds the leases of the labs and classes that are open in this process.

    Args:
        held: returns the codes of the labs and classes that are open here.
        watched: codes of those that may be open in another process.
        lost: called with the code of a lab or class that another process has claimed.
        clock: monotonic time, [s].

    Attributes:
        rounds: the periodic renewal.
    """

    def __init__(
        self,
        records: Records,
        held: Callable[[], Iterable[str]],
        watched: Iterable[str],
        lost: Callable[[str], object],
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._records, self._held, self._lost = records, held, lost
        self._watched, self._clock = list(watched), clock
        self._elsewhere: dict[str, float] = {}
        self.rounds = Periodic("leases", RENEWAL, self.check)

    def is_elsewhere(self, code: str) -> bool:
        """Whether another process had this open at the last renewal, and its lease still lasts."""
        return self._clock() < self._elsewhere.get(code, -inf)

    def check(self) -> None:
        """Renew all leases of what is open; if the database is unavailable, try again next time."""
        now = self._clock()
        try:
            renewal = self._records.renew(self._held(), self._watched)
        except NotKept as error:
            log.debug("leases are not renewed: %s", error)
            return
        self._elsewhere = {code: now + left for code, left in renewal.elsewhere.items()}
        for code in renewal.lost:
            self._lost(code)

    def stop(self) -> None:
        """Give up all leases, so that other processes can claim the states at once."""
        self.rounds.stop()
        try:
            self._records.give_up()
        except NotKept as error:
            log.debug("leases are not given up, they end by themselves: %s", error)
