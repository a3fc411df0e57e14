"""Gives the memory of clients that have left back to the system."""

from __future__ import annotations

import ctypes
import gc
import sys

from onpath.app.common.periodic import Periodic

INTERVAL = 15.0  # [s]; a collection stops all threads, for 30 ms with forty labs


class MemoryRelease:
    """Collects garbage some time after a client has left.

    What viser keeps of a client refers to itself, thousands of objects, which only a complete
    collection finds. `SELDOM` in `app.simulation.simulation_thread` makes these so rare that the
    garbage of tabs that come and go would fill hundreds of megabytes.
    """

    def __init__(self) -> None:
        self._anybody_left = False
        self.rounds = Periodic("memory", INTERVAL, self.release)

    def note(self) -> None:
        """Note that a client has left."""
        self._anybody_left = True

    def release(self) -> None:
        """Collect garbage and give free memory back, if a client has left."""
        if self._anybody_left:
            self._anybody_left = False
            gc.collect()
            _trim()


def _trim() -> None:
    """Give back what the C library holds free between memory in use."""
    trim = getattr(ctypes.CDLL(None), "malloc_trim", None) if sys.platform == "linux" else None
    if trim is not None:  # glibc
        trim(0)
