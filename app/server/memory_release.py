"""Collects garbage while labs are served, and gives free memory back to the system."""

from __future__ import annotations

import ctypes
import gc
import sys
from collections.abc import Callable

from onpath.app.viser_adapter.connection_limits import CountedConnection

INTERVAL = 10.0  # [s] between looks
MANY = 20  # connections
MUCH = 100_000  # blocks of memory that Python has allocated; a page takes some 15,000
CALM = 3  # looks
TABS = 100  # a closed tab leaves up to 0.1 MB of garbage
GROWTH = 0.125  # of the number of blocks, since the last complete collection
LARGE = 320_000  # [B]; more than the 256 KiB that asyncio allocates whenever it reads
SPARE = 4_000_000  # [B]
M_TRIM_THRESHOLD, M_MMAP_THRESHOLD, M_ARENA_MAX = -1, -3, -8  # of glibc's malloc.h


class MemoryRelease:
    """Collects the garbage of connections that have ended, and of pages that were built anew.

    What `release_page` leaves of a tab refers to itself, so that only a collection finds it. That
    stops all threads, with 40 labs for 0.3 s if it examines everything. Therefore whatever is left
    by one collection is not examined by the next ones ("frozen"), until a complete one is made.
    That is when a tab has been closed or a lab dropped and no other tab closed for a while, when
    many tabs have been closed, or when an eighth more is allocated than after the last complete
    one.

    Args:
        forget: drops what is no longer needed, and returns whether that leaves garbage; called at
            each look.
    """

    def __init__(self, forget: Callable[[], bool]) -> None:
        self._forget, self._has_dropped = forget, False
        self._tabs_seen, self._calm = CountedConnection.tabs_ended, 0
        self._remember()
        self._tabs_ended, self._after_complete = self._tabs_seen, self._blocks

    def look(self) -> None:
        """Collect garbage if it is time to, and give free memory back, which takes 1 ms."""
        self._has_dropped |= self._forget()
        ended, tabs_ended = CountedConnection.ended, CountedConnection.tabs_ended
        self._calm = self._calm + 1 if tabs_ended == self._tabs_seen else 0
        self._tabs_seen = tabs_ended
        left = tabs_ended - self._tabs_ended
        is_due = left >= TABS or ((left > 0 or self._has_dropped) and self._calm >= CALM)
        blocks = sys.getallocatedblocks()
        if is_due or blocks > (1 + GROWTH) * self._after_complete:
            gc.unfreeze()
            self._collect()
            self._tabs_ended, self._after_complete = tabs_ended, self._blocks
            self._has_dropped = False
        elif blocks > self._blocks + MUCH or ended >= self._ended + MANY:
            self._collect()
        _call_glibc("malloc_trim", 0)

    def _collect(self) -> None:
        gc.collect()
        gc.freeze()
        self._remember()

    def _remember(self) -> None:
        self._ended, self._blocks = CountedConnection.ended, sys.getallocatedblocks()


def limit_heap() -> None:
    """Let the C library use one heap, not one for each thread, and none for large blocks.

    Large messages would leave holes in it that cannot be given back. What is free at its end is
    given back from `SPARE` on; otherwise the heap would grow and shrink with each message that is
    received, which takes 10 µs. To be called before other threads begin.
    """
    _call_glibc("mallopt", M_ARENA_MAX, 1)
    _call_glibc("mallopt", M_MMAP_THRESHOLD, LARGE)
    _call_glibc("mallopt", M_TRIM_THRESHOLD, SPARE)


def _call_glibc(name: str, *arguments: int) -> None:
    """Call a function of glibc; do nothing with another C library."""
    function = getattr(ctypes.CDLL(None), name, None) if sys.platform == "linux" else None
    if function is not None:
        function(*arguments)
