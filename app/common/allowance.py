"""A limit on how often something may happen: a number of times at once, and a rate."""

from __future__ import annotations

import time
from collections.abc import Callable


class Allowance:
    """How often something may happen now. Use it in one thread, or under a lock.

    Args:
        burst: number of times at once.
        per_second: number of times per second, in the long run.
        clock: monotonic time, [s].
    """

    def __init__(
        self, burst: float, per_second: float, clock: Callable[[], float] = time.monotonic
    ) -> None:
        self._burst, self._per_second, self._clock = burst, per_second, clock
        self._left, self._counted_at = burst, clock()

    def covers(self, times: float = 1.0) -> bool:
        """Whether it may happen now."""
        now = self._clock()
        earned = (now - self._counted_at) * self._per_second
        self._left, self._counted_at = min(self._left + earned, self._burst), now
        return self._left >= times

    def take(self, times: float = 1.0) -> bool:
        """Whether it may happen now; if so, it is counted."""
        if not self.covers(times):
            return False
        self._left -= times
        return True
