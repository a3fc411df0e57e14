"""What a page asks for that may block or show another page: each runs in a thread, few per tab."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable

from onpath.app.common.allowance import Allowance
from onpath.app.common.error_log import log_error

MOST, APART = 5, 0.25
"""Presses that a tab may make in quick succession, and the time that each one uses up, [s]."""


class Presses:
    """Limits the presses of one tab: one at a time, and few per second.

    Call `begin` and `run` in one thread.

    Args:
        clock: monotonic time, [s].
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._under_way = threading.Lock()
        self._allowance = Allowance(MOST, 1 / APART, clock)

    def begin(self) -> bool:
        """Begin a press, if one is allowed now; it lasts until `end`. Returns whether it is."""
        if not self._allowance.covers() or not self._under_way.acquire(blocking=False):
            return False
        return self._allowance.take()

    def end(self) -> None:
        """End the press. Any thread may call this."""
        self._under_way.release()

    def run(self, act: Callable[[], None]) -> bool:
        """Call `act()` in a thread of its own as one press. Returns whether that is allowed now."""
        if not self.begin():
            return False
        threading.Thread(target=self._act, args=[act], name="press", daemon=True).start()
        return True

    def _act(self, act: Callable[[], None]) -> None:
        try:
            act()
        except Exception as error:
            log_error(error)
        finally:
            self.end()
