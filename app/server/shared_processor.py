"""Keeps the threads that take turns at holding the interpreter's lock on one processor.

Those of the simulation, the network and the database hand over the lock more than a thousand times
a second. On two processors, each time one has to be woken and to fetch data from the other's cache:
with a hundred labs that is a seventh of all processor time.
"""

from __future__ import annotations

import os
import threading
import time
from collections.abc import Sequence

from onpath.app.common.periodic import Periodic
from onpath.app.common.processors import KNOWN, TASKS, processor, run_anywhere, times

INTERVAL = 1.0  # [s] between looks
CROWDED = 0.2  # share of the time that the first thread waits for other programs
REST = 30  # looks without sharing after that
TERM = 60  # looks after which the system may choose another processor


class SharedProcessor:
    """Keeps some threads on one processor, unless other programs need that.

    It is the one on which the first thread runs at that time, so the system chooses; once in `TERM`
    looks it chooses anew. When others crowd the processor, the threads run anywhere for a while.

    Args:
        threads: running ones. A thread that they start begins there; if it works long without the
            lock, or starts a process, it must call `run_anywhere`.
    """

    def __init__(self, threads: Sequence[threading.Thread]) -> None:
        self._threads = [thread.native_id or 0 for thread in threads]
        self._used = set[int]()  # processors that they have shared
        self._shares = False
        self._looks = 0  # until that changes
        self._seen = (0.0, 0.0, 0.0)
        self._periodic = Periodic("processor", INTERVAL, self.look)

    def start(self) -> None:
        """Look from now on."""
        self._periodic.start()

    def stop(self) -> None:
        """Look no more, and let all threads run anywhere."""
        self._periodic.stop()
        self.release()

    def look(self) -> None:
        """Look once. Does nothing where the system does not say how long threads wait."""
        first, self._looks = self._threads[0], self._looks - 1
        try:
            crowding, at = self._crowding(first), processor(first)
            if self._shares and (crowding > CROWDED or self._looks <= 0):
                self.release()
                self._looks = REST if crowding > CROWDED else 0
            elif not self._shares and self._looks <= 0:
                self._shares, self._looks = True, TERM
                self._used.add(at)
                for thread in self._threads:
                    os.sched_setaffinity(thread, {at})
        except OSError:
            return

    def release(self) -> None:
        """Let the threads, and those that they have started, run on all processors."""
        self._shares = False
        for thread in self._threads if KNOWN else ():
            run_anywhere(thread)
        for entry in list(TASKS.iterdir()) if self._used else ():
            thread = int(entry.name)
            if _allowed(thread) in [{one} for one in self._used]:
                run_anywhere(thread)

    def _crowding(self, thread: int) -> float:
        """Share of the time since the last look in which a thread has waited for other programs."""
        (run, waited), before = times(thread), self._seen
        self._seen = now = time.monotonic(), waited, time.process_time() - run
        passed, waited, others = (new - old for new, old in zip(now, before, strict=True))
        return (waited - others) / passed


def _allowed(thread: int) -> set[int]:
    """The processors on which a thread may run; none if it has ended."""
    try:
        return os.sched_getaffinity(thread)
    except OSError:
        return set()
