"""The options of the C library's heap that suit a server with many connections."""

from __future__ import annotations

import ctypes
import sys

LARGE = 320_000  # [B]; more than the 256 KiB that asyncio allocates whenever it reads
SPARE = 4_000_000  # [B] that stay allocated at the end of the heap
M_TRIM_THRESHOLD, M_MMAP_THRESHOLD, M_ARENA_MAX = -1, -3, -8  # of glibc's malloc.h


def limit_heap() -> None:
    """Let glibc use one heap for all threads, and keep the memory that each read takes.

    Otherwise the system maps 256 KiB anew for almost every message that a browser sends. To be
    called before other threads begin; with another C library it does nothing.
    """
    mallopt = getattr(ctypes.CDLL(None), "mallopt", None) if sys.platform == "linux" else None
    if mallopt is not None:
        mallopt(M_ARENA_MAX, 1)
        mallopt(M_MMAP_THRESHOLD, LARGE)
        mallopt(M_TRIM_THRESHOLD, SPARE)
