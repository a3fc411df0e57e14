"""How many blocks of memory something leaves behind."""

from __future__ import annotations

import gc
import tracemalloc
from collections.abc import Callable


def blocks_kept(action: Callable[[], object], *files: str) -> int:
    """Blocks allocated by lines of these files during an action, and still in use after it.

    What other threads do meanwhile in other files, such as those of earlier tests, does not count.

    Args:
        action: what is done.
        files: the files, as patterns for their paths.
    """
    gc.collect()
    tracemalloc.start()
    try:
        action()
        gc.collect()  # and free lists of the interpreter are emptied
        snapshot = tracemalloc.take_snapshot()
    finally:
        tracemalloc.stop()
    ours = snapshot.filter_traces([tracemalloc.Filter(True, file) for file in files])
    return len(ours.traces)
