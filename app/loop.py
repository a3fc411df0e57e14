"""THE simulation thread: it owns all sessions and advances them at 60 Hz against a deadline.

A frame that takes longer than its budget slows simulated time, visibly, and never piles up.
"""

from __future__ import annotations

import gc
import logging
import sys
import threading
import time
from collections import deque
from collections.abc import Callable
from typing import Protocol

from app.error_log import log_error
from app.pace import Pace
from app.session import Session

log = logging.getLogger(__name__)

FRAME = 1 / 60  # [s]
FADING = 1 / 60  # of a lab's measured speed, per frame
LATEST = 0.1  # [s]; further behind, the schedule starts anew
PAUSE = 1e-3  # [s] at least between frames: when this thread is late, the network is later still
SELDOM = (5_000, 20, 50)  # allocations before a collection: these stop all threads
COMMANDS = 4e-3  # [s] of a frame for one lab's commands; longer ones are paid for by waiting
SWITCH_INTERVAL = 5e-4  # [s], so that the network thread does not keep this one waiting


class View(Protocol):
    """Whatever shows a session; called by the simulation thread only."""

    def show(self, session: Session, achieved: float, frame: int, stride: int) -> None:
        """Show it, in every `stride`-th frame at least; `frame` counts them all."""
        ...

    def send(self) -> None:
        """Let out what has been shown, once all labs have been simulated."""
        ...


class Lab:
    """A session, how fast it really runs, and who looks at it.

    Attributes:
        session: the state.
        view: who looks, or None.
    """

    def __init__(self, session: Session) -> None:
        self.session = session
        self.view: View | None = None
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

    def frame(self, seconds: float, count: int, stride: int) -> None:
        """One frame: apply commands, simulate, show."""
        session = self.session
        self._credit = min(self._credit, 0.0) + COMMANDS
        self._credit -= session.drain(self._credit)
        view = self.view  # may go at any time
        if view is None:
            return  # nobody looks: simulated time waits
        before = session.time
        session.advance(session.rate * FRAME)
        if session.running and not session.frozen:
            self._simulated += session.time - before - self._simulated * FADING
            self._passed += seconds - self._passed * FADING
        view.show(session, self.achieved, count, stride)


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
        self._labs: list[Lab] = []
        self._lock = threading.Lock()
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self.run, name="simulation", daemon=True)
        self.frames: deque[tuple[float, float]] = deque(maxlen=3600)

    def start(self) -> None:
        """Begin."""
        sys.setswitchinterval(SWITCH_INTERVAL)
        gc.freeze()  # what is loaded by now stays: a full collection would take 0.2 s of it
        gc.set_threshold(*SELDOM)
        self._thread.start()

    def stop(self) -> None:
        """End after the current frame."""
        self._stop.set()
        if self._thread.is_alive():
            self._thread.join(timeout=2.0)

    def add(self, lab: Lab) -> None:
        """Run one lab more; from any thread."""
        with self._lock:
            self._labs = [*self._labs, lab]

    def remove(self, lab: Lab) -> None:
        """Run it no more; from any thread."""
        with self._lock:
            self._labs = [other for other in self._labs if other is not lab]

    @property
    def labs(self) -> list[Lab]:
        """Those that run now."""
        return self._labs

    @property
    def lateness(self) -> list[float]:
        """Of the latest frames, [s]."""
        return [late for _, late in self.frames.copy()]

    def run(self) -> None:
        """Frame after frame, each at its deadline."""
        last, pace = self._clock(), Pace()
        count, deadline = 0, last + FRAME
        while not self._stop.is_set():
            now = self._clock()
            self._sleep(max(deadline - now, PAUSE))
            now = self._clock()
            late = now - deadline
            self.frames.append((now, late))
            deadline = now + FRAME if late > LATEST else deadline + FRAME
            for lab in self._labs:
                try:
                    lab.frame(now - last, count, pace.stride)
                except Exception as error:  # one lab must not stop the others
                    log_error(error)
            for view in [lab.view for lab in self._labs]:
                if view is not None:
                    view.send()
            pace.note(self._clock() - now, now - last)
            last, count = now, count + 1
