"""Who may go on trying codes: a few wrong ones a minute for each tab, none slows another down."""

from __future__ import annotations

import threading
import time
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress

from onpath.models.errors import CodedError

TRIES, WITHIN = 5, 60.0  # wrong codes that one tab may type in so many seconds


class Throttle:
    """Counts failures by who has them, any number at once; from any thread.

    Args:
        clock: [s].
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock, self._lock = clock, threading.Lock()
        self._failures: deque[tuple[float, str]] = deque()

    @contextmanager
    def attempt(self, who: str) -> Iterator[None]:
        """One attempt, failed if a ValueError ends it; until it ends it counts as failed.

        Raises:
            ValueError: not now, whatever the attempt is; it is not begun.
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
        with self._lock, suppress(ValueError):  # it was long ago
            self._failures.remove(begun)
