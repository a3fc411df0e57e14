"""Collects garbage when there may be much, and gives free memory back to the system."""

from __future__ import annotations

import ctypes
import gc
import sys

from onpath.app.common.periodic import Periodic
from onpath.app.viser_adapter.connection_limits import CountedConnection

INTERVAL = 10.0  # [s]
COMPLETE = 6  # looks after which all objects are considered
LARGE = 256 * 1024  # [B]
M_MMAP_THRESHOLD, M_ARENA_MAX = -3, -8  # of glibc's malloc.h
MANY = 20  # connections


class MemoryRelease:
    """Collects the garbage of connections that have ended.

    What is kept of a connection or a tab refers to itself, so that only a collection of all
    objects finds it. That stops all threads, with 60 labs for some 170 ms, so `SELDOM` in
    `app.simulation.simulation_thread` makes it rare. Here what has survived one collection is left
    out of the following ones, which are short, until some time has passed.
    """

    def __init__(self) -> None:
        self._seen, self._looks_left = CountedConnection.ended, COMPLETE
        self._looks = Periodic("memory", INTERVAL, self.look)
        self.start, self.stop = self._looks.start, self._looks.stop

    def look(self) -> None:
        """Collect garbage and give free memory back if many connections have ended since."""
        self._looks_left -= 1
        ended = CountedConnection.ended
        if ended - self._seen < MANY:
            return
        self._seen = ended
        if self._looks_left <= 0:
            self._looks_left = COMPLETE
            gc.unfreeze()
        gc.collect()
        gc.freeze()
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
