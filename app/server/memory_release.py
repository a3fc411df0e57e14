"""Collects garbage when there may be much, and gives free memory back to the system."""

from __future__ import annotations

import ctypes
import gc
import sys

from onpath.app.common.periodic import Periodic

INTERVAL = 2.0  # [s]
LARGE = 256 * 1024  # [B]
M_MMAP_THRESHOLD, M_ARENA_MAX = -3, -8  # of glibc's malloc.h
MUCH = 10  # collections of the middle generation, each after some 5,000 new objects


def memory_release() -> Periodic:
    """A thread that calls `release` from time to time."""
    return Periodic("memory", INTERVAL, release)


def release() -> None:
    """Collect garbage and give free memory back, if many objects have come since the last time.

    What is kept of a tab or a connection refers to itself, thousands of objects, which only a
    complete collection finds. `SELDOM` in `app.simulation.simulation_thread` makes these rare,
    since each stops all threads for some 30 ms; without this, the garbage of those that come and
    go would fill hundreds of megabytes.
    """
    if gc.get_count()[2] >= MUCH:
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
