"""Collects the garbage of connections that have ended, and gives free memory back to the system."""

from __future__ import annotations

import ctypes
import gc
import sys

from onpath.app.viser_adapter.connection_limits import CountedConnection

INTERVAL = 10.0  # [s] between looks
MANY = 20  # connections
LARGE = 256 * 1024  # [B]
M_MMAP_THRESHOLD, M_ARENA_MAX = -3, -8  # of glibc's malloc.h


class MemoryRelease:
    """Collects the garbage of connections that have ended.

    What is kept of a connection or a tab refers to itself, so that only a complete collection finds
    it. That stops all threads, with 60 labs for some 170 ms, so `SELDOM` in
    `app.simulation.simulation_thread` makes it rare, and it is done here only when many connections
    have ended.
    """

    def __init__(self) -> None:
        self._seen = CountedConnection.ended

    def look(self) -> None:
        """Collect garbage and give free memory back if many connections have ended since."""
        ended = CountedConnection.ended
        if ended - self._seen >= MANY:
            self._seen = ended
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
