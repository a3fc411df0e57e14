"""On which processors threads run, as far as the operating system says and allows: on Linux."""

from __future__ import annotations

import os
from pathlib import Path
from typing import NamedTuple

TASKS = Path("/proc/self/task")
LATEST = 36  # field of a thread's processor in its `stat`, after the name; see proc(5)
KNOWN = hasattr(os, "sched_setaffinity") and TASKS.exists()
ALL = os.sched_getaffinity(0) if KNOWN else set[int]()
"""The processors that this process may use."""


class Times(NamedTuple):
    """How long a thread has run, and how long it has waited for a processor, [s]."""

    run: float
    waited: float


def times(thread: int) -> Times:
    """The times of a thread of this process, by its native id.

    Raises:
        OSError: there is no such thread, or the system does not say.
    """
    run, waited, _ = (TASKS / str(thread) / "schedstat").read_text().split()
    return Times(1e-9 * int(run), 1e-9 * int(waited))


def processor(thread: int) -> int:
    """The processor on which a thread of this process has run last.

    Raises:
        OSError: there is no such thread.
    """
    return int((TASKS / str(thread) / "stat").read_text().rpartition(")")[2].split()[LATEST])


def run_anywhere() -> None:
    """Let this thread, and the threads and processes that it starts, run on all processors."""
    if KNOWN:
        os.sched_setaffinity(0, ALL)
