"""Limits wrong codes to a few per minute and tab; tabs do not affect each other."""

from __future__ import annotations

import threading
import time
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress

from onpath.models.errors import CodedError

TRIES, WITHIN = 5, 60.0  # maximum number of wrong codes per tab, within this time, [s]


class Throttle:
    """Counts the failures of each tab. Thread-safe, and attempts may overlap.

    Args:
        clock: monotonic time, [s].
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock, self._lock = clock, threading.Lock()
        self._failures: deque[tuple[float, str]] = deque()

    @contextmanager
    def attempt(self, who: str) -> Iterator[None]:
        """Make an attempt, which fails by raising ValueError and counts as failed until it ends.

        Raises:
            ValueError: too many failures; the attempt is not made.
        """
        begun = self._begin(who)
        try:
            yield
        except ValueError:
            raise
        except BaseException:
            self._withdraw(begun)
            raise
        self._withdraw(begun)

    def _begin(self, who: str) -> tuple[float, str]:
        with self._lock:
            now = self._clock()
            while self._failures and self._failures[0][0] <= now - WITHIN:
                self._failures.popleft()
            if sum(failed == who for _, failed in self._failures) >= TRIES:
                raise CodedError("error.too_many_codes")
            begun = now, who
            self._failures.append(begun)
            return begun

    def _withdraw(self, begun: tuple[float, str]) -> None:
        with self._lock, suppress(ValueError):  # it has expired
            self._failures.remove(begun)
