"""Collects garbage when there may be much, and gives free memory back to the system."""

from __future__ import annotations

import ctypes
import gc
import sys

from onpath.app.common.periodic import Periodic

INTERVAL = 2.0  # [s]
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
        _trim()


def _trim() -> None:
    """Give back what the C library holds free between memory in use."""
    trim = getattr(ctypes.CDLL(None), "malloc_trim", None) if sys.platform == "linux" else None
    if trim is not None:  # glibc
        trim(0)
