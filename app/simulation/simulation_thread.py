"""THE simulation thread: it owns all labs and advances them at 60 Hz against a deadline.

A frame that takes longer than its budget slows simulated time, visibly, and never piles up.
"""

from __future__ import annotations

import gc
import logging
import threading
import time
from collections import deque
from collections.abc import Callable
from typing import Protocol

from onpath.app.common.error_log import log_error
from onpath.app.lab.lab import Lab
from onpath.app.simulation.display_rate import DisplayRate

log = logging.getLogger(__name__)

FRAME = 1 / 60  # [s]
FADING = 1 / 60  # of a lab's measured speed, per frame
LATEST = 0.1  # [s]; further behind, the schedule starts anew
PAUSE = 1e-3  # [s] at least between frames: when this thread is late, the network is later still
SELDOM = (1_000, 4, 1_000)  # allocations before a collection: it stops all threads, for 10 ms or so
COMMANDS = 4e-3  # [s] of a frame for one lab's commands; longer ones are paid for by waiting


class Display(Protocol):
    """Whatever shows a lab; called by the simulation thread only."""

    def show(self, lab: Lab, achieved: float, frame: int, stride: float) -> None:
        """Show it, in every `stride`-th frame at least; `frame` counts them all."""
        ...

    def send(self) -> None:
        """Let out what has been shown, once all labs have been simulated."""
        ...


class ScheduledLab:
    """A lab, how fast it really runs, and who looks at it.

    Attributes:
        lab: the lab.
        session: its simulated part.
        view: who looks, or None.
    """

    def __init__(self, lab: Lab) -> None:
        self.lab, self.session = lab, lab.session
        self.view: Display | None = None
        self._credit = 0.0  # [s] of computing for commands
        self._simulated = self._passed = 1e-6  # lately, each fading over about a second

    @property
    def is_seen(self) -> bool:
        """Whether somebody's browser draws it; otherwise simulated time waits."""
        return self.view is not None

    @property
    def achieved(self) -> float:
        """Simulated seconds per second, lately."""
        return self._simulated / self._passed

    def drain(self) -> None:
        """Apply commands; most of a frame's worth at a time."""
        self._credit = min(self._credit, 0.0) + COMMANDS
        self._credit -= self.lab.drain(self._credit)

    def advance(self, seconds: float) -> None:
        """Simulate a frame, which has taken so long. While nobody looks, simulated time waits."""
        session = self.session
        if self.view is None:
            return
        before = session.time
        self.lab.advance(session.rate * FRAME)
        if session.running and not self.lab.frozen:
            self._simulated += session.time - before - self._simulated * FADING
            self._passed += seconds - self._passed * FADING

    def show(self, count: int, stride: float) -> None:
        """Show it to who looks."""
        view = self.view  # may go at any time
        if view is not None:
            view.show(self.lab, self.achieved, count, stride)

    def send(self) -> None:
        """Let out what has been shown."""
        view = self.view
        if view is not None:
            view.send()


class SimulationThread:
    """Runs labs until stopped.

    Args:
        clock, sleep: passed in for tests.

    Attributes:
        frames: the latest: when each began, and how late, [s].
    """

    def __init__(
        self,
        clock: Callable[[], float] = time.perf_counter,
        sleep: Callable[[float], None] = time.sleep,
    ) -> None:
        self._clock, self._sleep = clock, sleep
        self._labs: list[ScheduledLab] = []
        self._lock = threading.Lock()
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self.run, name="simulation", daemon=True)
        self.frames: deque[tuple[float, float]] = deque(maxlen=3600)

    def start(self) -> None:
        """Begin."""
        gc.freeze()  # what is loaded by now stays: a full collection would take 0.2 s of it
        gc.set_threshold(*SELDOM)
        self._thread.start()

    def stop(self) -> None:
        """End after the current frame."""
        self._stop.set()
        if self._thread.is_alive():
            self._thread.join(timeout=2.0)

    def add(self, lab: ScheduledLab) -> None:
        """Run one lab more; from any thread."""
        with self._lock:
            self._labs = [*self._labs, lab]

    def remove(self, lab: ScheduledLab) -> None:
        """Run it no more; from any thread."""
        with self._lock:
            self._labs = [other for other in self._labs if other is not lab]

    @property
    def labs(self) -> list[ScheduledLab]:
        """Those that run now."""
        return self._labs

    @property
    def lateness(self) -> list[float]:
        """Of the latest frames, [s]."""
        return [late for _, late in self.frames.copy()]

    def run(self) -> None:
        """Frame after frame, each at its deadline."""
        last, pace = self._clock(), DisplayRate()
        count, deadline = 0, last + FRAME
        while not self._stop.is_set():
            now = self._clock()
            self._sleep(max(deadline - now, PAUSE))
            now = self._clock()
            late = now - deadline
            self.frames.append((now, late))
            deadline = now + FRAME if late > LATEST else deadline + FRAME
            drawing = self._frame(now - last, count, pace.stride_when(late))
            pace.note(self._clock() - now, drawing, now - last)
            last, count = now, count + 1

    def _frame(self, seconds: float, count: int, stride: float) -> float:
        """Step by step for all labs, and not lab by lab: what a step needs stays in the cache.

        Returns:
            What was spent on the display, [s].
        """
        labs = self._labs
        _do(ScheduledLab.drain, labs)
        _do(lambda lab: lab.advance(seconds), labs)
        begun = self._clock()
        _do(lambda lab: lab.show(count, stride), labs)
        _do(ScheduledLab.send, labs)
        return self._clock() - begun


def _do(step: Callable[[ScheduledLab], None], labs: list[ScheduledLab]) -> None:
    for lab in labs:
        try:
            step(lab)
        except Exception as error:  # one lab must not stop the others
            log_error(error)
