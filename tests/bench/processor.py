"""How fast this machine's processor is while something is measured.

The processor of a virtual machine may be half as fast at some times as at others, although its host
reports no time as given to others. So a fixed loop of Python is timed again and again.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from math import nan
from pathlib import Path
from statistics import median
from threading import Event, Thread

from msgspec import Struct

STEPS = 20_000  # of the fixed loop: about a millisecond
INTERVAL = 1.0  # [s] between loops, which thus take 0.1 % of a core
TIMES = Path("/proc/stat")  # Linux only


class Processor(Struct, frozen=True):
    """The processor during an interval.

    Attributes:
        stolen: share of its time that the host gave to others; nan if unknown.
        step_ns: processor time of a step of the fixed loop, median, [ns].
    """

    stolen: float
    step_ns: float


@contextmanager
def watched_processor() -> Iterator[Callable[[], Processor]]:
    """A function that tells how the processor was since its last call."""
    ended, timed, before = Event(), [step_ns()], _times()

    def work() -> None:
        while not ended.wait(INTERVAL):
            timed.append(step_ns())

    def since_last() -> Processor:
        nonlocal before
        now, step = _times(), median(timed)
        stolen, total = now[0] - before[0], now[1] - before[1]
        before = now
        del timed[:-1]
        return Processor(stolen / max(total, 1.0), step)

    thread = Thread(target=work, name="fixed loop", daemon=True)
    thread.start()
    try:
        yield since_last
    finally:
        ended.set()
        thread.join()


def step_ns() -> float:
    """Processor time of one step of the fixed loop, [ns]."""
    begun, total = time.thread_time_ns(), 0
    for number in range(STEPS):
        total += number * number
    return (time.thread_time_ns() - begun) / STEPS


def _times() -> tuple[float, float]:
    """Time that the host gave to others, and total time, of all cores since boot, [ticks]."""
    try:
        spent = [float(word) for word in TIMES.read_text("ascii").split()[1:9]]
    except OSError:
        return nan, nan
    return spent[7], sum(spent)
