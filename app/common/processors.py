"""On which processors threads run; known and settable on Linux only."""

from __future__ import annotations

import os
from contextlib import suppress
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
    run, waited, *_ = map(int, (TASKS / str(thread) / "schedstat").read_text("ascii").split())
    if not run:
        raise OSError("this kernel does not measure how long threads wait")
    return Times(1e-9 * run, 1e-9 * waited)


def processor(thread: int) -> int:
    """The processor on which a thread of this process has run last.

    Raises:
        OSError: there is no such thread.
    """
    return int((TASKS / str(thread) / "stat").read_text("ascii").rpartition(")")[2].split()[LATEST])


def run_anywhere(thread: int = 0) -> None:
    """Let a thread, by default this one, and what it starts run on all processors."""
    with suppress(OSError):  # it has ended, or the processors have been taken from this process
        if KNOWN:
            os.sched_setaffinity(thread, ALL)
