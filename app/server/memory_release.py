"""Collects the garbage of connections that have ended, and gives free memory back to the system."""

from __future__ import annotations

import ctypes
import gc
import sys
from collections.abc import Callable

from onpath.app.viser_adapter.connection_limits import CountedConnection

INTERVAL = 10.0  # [s] between looks
MANY = 20  # connections
CALM = 3  # looks
LARGE = 256 * 1024  # [B]
M_MMAP_THRESHOLD, M_ARENA_MAX = -3, -8  # of glibc's malloc.h


class MemoryRelease:
    """Collects the garbage of connections that have ended.

    What is kept of a connection or a tab refers to itself, so that only a complete collection finds
    it. That stops all threads, with 60 labs for some 170 ms, so `SELDOM` in
    `app.simulation.simulation_thread` makes it rare, and it is done here only when many connections
    have ended, or when a tab has been closed and no other one for a while.

    Args:
        forget: deletes what is no longer needed; called at each look.
    """

    def __init__(self, forget: Callable[[], None]) -> None:
        self._forget = forget
        self._ended, self._tabs_ended = CountedConnection.ended, CountedConnection.tabs_ended
        self._tabs_seen, self._calm = self._tabs_ended, 0

    def look(self) -> None:
        """Collect garbage, and give free memory back, if it is time to."""
        self._forget()
        ended, tabs_ended = CountedConnection.ended, CountedConnection.tabs_ended
        self._calm = self._calm + 1 if tabs_ended == self._tabs_seen else 0
        self._tabs_seen = tabs_ended
        is_calm = tabs_ended > self._tabs_ended and self._calm >= CALM
        if is_calm or ended >= self._ended + MANY:
            self._ended, self._tabs_ended = ended, tabs_ended
            gc.collect()
            _call_glibc("malloc_trim", 0)


def limit_heap() -> None:
    """Let the C library use one heap, not one for each thread, and none for large blocks.

    Large messages would leave holes in it that cannot be given back. To be called before other
    threads begin.
    """
    _call_glibc("mallopt", M_ARENA_MAX, 1)
    _call_glibc("mallopt", M_MMAP_THRESHOLD, LARGE)


def _call_glibc(name: str, *arguments: int) -> None:
    """Call a function of glibc; do nothing with another C library."""
    function = getattr(ctypes.CDLL(None), name, None) if sys.platform == "linux" else None
    if function is not None:
        function(*arguments)
