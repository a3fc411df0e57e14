"""Keeps the threads that take turns with the interpreter on one processor.

The threads of the simulation, of the network and of the database hand its lock over a thousand
times a second. On two processors each of them begins with waking the other one, and with data that
are in the other one's caches: with a hundred labs that is a sixth of all processor time.
"""

from __future__ import annotations

import os
import threading
import time
from collections.abc import Sequence
from contextlib import suppress

from onpath.app.common.processors import ALL, processor, times

INTERVAL = 1.0  # [s] between looks
CROWDED = 0.2  # share of the time that the first thread waits for other programs
REST = 30  # looks before another try


class SharedProcessor:
    """Keeps some threads on one processor, unless other programs need that.

    It is the one on which the first thread runs at that time, so the system chooses. When others
    crowd it, the threads run anywhere for a while.

    Args:
        threads: running ones. What they start begins on the same processor; for long work without
            the interpreter, or another process, it calls `run_anywhere`.
    """

    def __init__(self, threads: Sequence[threading.Thread]) -> None:
        self._threads = [thread.native_id or 0 for thread in threads]
        self._at: int | None = None
        self._seen = (0.0, 0.0, 0.0)
        self._rest = 0

    def look(self) -> None:
        """Look once. Does nothing where the system does not say how long threads wait."""
        first = self._threads[0]
        try:
            crowding, now = self._crowding(first), processor(first)
            if self._at is not None and crowding > CROWDED:
                self.release()
                self._rest = REST
            elif self._rest:
                self._rest -= 1
            elif self._at is None:
                self._at = now
                for thread in self._threads:
                    os.sched_setaffinity(thread, {now})
        except OSError:
            return

    def release(self) -> None:
        """Let the threads, and those that they have started, run on all processors."""
        shared, self._at = self._at, None
        for thread in threading.enumerate() if shared is not None else ():
            with suppress(OSError):  # it has ended
                if os.sched_getaffinity(thread.native_id or 0) == {shared}:
                    os.sched_setaffinity(thread.native_id or 0, ALL)

    def _crowding(self, thread: int) -> float:
        """Share of the time since the last look in which a thread has waited for other programs."""
        (run, waited), before = times(thread), self._seen
        self._seen = now = time.monotonic(), waited, time.process_time() - run
        passed, waited, others = (new - old for new, old in zip(now, before, strict=True))
        return (waited - others) / passed
