"""Keys that wait to be compiled; those requested recently come first.

A lab asks in every frame for a loop that it lacks. A key that no lab has asked for lately is
overtaken by those that are needed now, and dropped once too many wait. So a lab that keeps changing
its settings does not hold up the others.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import Generic, TypeVar

K = TypeVar("K")
MOST = 32  # keys that wait; beyond that, the one asked for longest ago is dropped
LATELY = 0.5  # [s]


class CompileQueue(Generic[K]):
    """First come, first served among the keys asked for recently. Thread-safe.

    Args:
        clock: monotonic time, [s].
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._asked: dict[K, float] = {}  # time of the last request, [s]; in order of arrival
        self._lock = threading.Lock()

    def __contains__(self, key: K) -> bool:
        return key in self._asked

    def __len__(self) -> int:
        return len(self._asked)

    def ask(self, key: K) -> bool:
        """Ask for a key; return whether it is new."""
        with self._lock:
            new = key not in self._asked
            self._asked[key] = self._clock()
            if len(self._asked) > MOST:
                del self._asked[min(self._asked, key=self._asked.__getitem__)]
            return new

    def next(self) -> K | None:
        """Take the next key; None if none waits."""
        with self._lock:
            if not self._asked:
                return None
            latest = max(self._asked.values())
            chosen = next(key for key, at in self._asked.items() if at >= latest - LATELY)
            del self._asked[chosen]
            return chosen
