"""What the threads of this process get of the processor, as Linux counts it."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from contextlib import suppress
from pathlib import Path

THREADS = Path("/proc/self/task")
LITTLE = 0.02  # share of the time; a thread that computes less counts as waiting
Times = tuple[int, int]  # [ns] that a thread computed, and that it waited for a processor


class ProcessorTime:
    """How much of the time between two checks counts for a thread that shows no sign of life.

    A thread that computes may be in an endless loop: its own processor time counts. A thread that
    waits may wait for ever, or for another thread of this process, which may get little of the
    processor: the time counts times the share that this process gets of the processor it asks for.
    So the time that a busy machine takes away does not count.

    Where the system does not tell (it is not Linux), this process's processor time counts.

    Args:
        threads, clock: passed in for tests.
    """

    def __init__(
        self,
        threads: Callable[[], Mapping[int, Times]] | None = None,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._read, self._clock = threads or times_of_threads, clock
        self._threads = self._read()
        self._time, self._process = clock(), time.process_time()
        self._computed = dict[int, float]()
        self._elapsed = self._share = self._used = 0.0

    def check(self) -> None:
        """Read what has been used since the last check."""
        before, self._threads = self._threads, self._read()
        since, self._time = self._time, self._clock()
        used, self._process = self._process, time.process_time()
        self._elapsed, self._used = self._time - since, self._process - used
        self._computed, got, wanted = {}, 0, 0
        for thread, (computed, waited) in self._threads.items():
            computed_before, waited_before = before.get(thread, (0, 0))
            self._computed[thread] = 1e-9 * (computed - computed_before)
            got += computed - computed_before
            wanted += computed - computed_before + waited - waited_before
        self._share = got / wanted if wanted else 1.0

    def counted(self, thread: int, most: float) -> float:
        """Time between the last two checks that counts for a thread, [s].

        Args:
            thread: its native id.
            most: time that counts for one that waits, [s]: this process may have been suspended.
        """
        if not self._threads:
            return self._used
        computed = self._computed.get(thread, 0.0)
        if computed > LITTLE * self._elapsed:
            return computed
        return self._share * min(self._elapsed, most)


def times_of_threads() -> dict[int, Times]:
    """The times of all threads, by native id; none if the system does not tell."""
    times = dict[int, Times]()
    with suppress(OSError, ValueError):
        for thread in THREADS.iterdir():
            with suppress(FileNotFoundError, ProcessLookupError):  # it has just ended
                computed, waited, _ = (thread / "schedstat").read_text().split()
                times[int(thread.name)] = int(computed), int(waited)
    return times
