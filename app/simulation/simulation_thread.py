"""The simulation thread: it owns all labs and advances them at 60 Hz, frame by frame.

When it is busy, it simulates each lab only in the frames in which the lab is drawn. When it is two
frames late, it simulates the next two as one. When that is not enough, simulated time slows down
visibly; late frames never accumulate.
"""

from __future__ import annotations

import gc
import logging
import sys
import threading
import time
from collections import deque
from collections.abc import Callable
from concurrent.futures import Future, wait
from typing import Any, TypeVar

from onpath.app.common.error_log import log_error
from onpath.app.common.on_time import note_lateness
from onpath.app.lab.advance_together import advance_together
from onpath.app.simulation.display_rate import DisplayRate
from onpath.app.simulation.frame_length import FRAME, frame_length
from onpath.app.simulation.frame_times import FrameTimes
from onpath.app.simulation.scheduled_lab import ScheduledLab
from onpath.app.simulation.slow_updates import SHARE, SlowUpdates

log = logging.getLogger(__name__)

FADING = 1 / 60  # low-pass gain of computing times, per frame
BEHIND = 2 * FRAME  # [s] of lateness from which two frames are simulated as one
LATEST = 0.1  # [s] of lateness beyond which the schedule restarts
TOLERATED = FRAME / 2  # [s] of lateness from which long work in other threads waits
PAUSE = 1e-3  # [s], minimum between frames, so that the network thread is not starved
HANDOVER = 1e-4  # [s] after which another thread must hand the interpreter back
ALL_COMMANDS, FEWEST = 4e-3, 2e-3  # [s] of a frame for the commands of all labs: most, and least
MOST = 0.6  # share of a frame up to which slow updates are made; the network takes up to 0.25
ANSWER = 1.0  # [s] between checks whether the thread that must answer still runs

T = TypeVar("T")


class SimulationThread:
    """Runs labs until stopped.

    Args:
        clock, sleep: passed in for tests.

    Attributes:
        thread: the thread that runs them.
        frames: the latest frames.
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
        self.thread = threading.Thread(target=self.run, name="simulation", daemon=True)
        self.frames = FrameTimes()
        self._calls: deque[tuple[Callable[[], Any], Future[Any]]] = deque()
        self._slow_updates, self._drawing = SlowUpdates(clock), 0.0
        self._turns = CommandTurns()
        self._advancing = 0.0  # [s] of a frame, without commands, low-pass filtered as `_drawing`

    def start(self) -> None:
        """Start the thread."""
        gc.enable()
        gc.freeze()  # excludes loaded modules from collections, which would take 0.1 s longer
        sys.setswitchinterval(HANDOVER)
        self.thread.start()

    def stop(self) -> None:
        """Stop after the current frame."""
        self._stop.set()
        if self.thread.is_alive():
            self.thread.join(timeout=2.0)

    def add(self, lab: ScheduledLab) -> None:
        """Add a lab. Thread-safe."""
        with self._lock:
            self._labs = [*self._labs, lab]

    def remove(self, lab: ScheduledLab) -> None:
        """Remove a lab. Thread-safe."""
        with self._lock:
            self._labs = [other for other in self._labs if other is not lab]

    def call(self, function: Callable[[], T]) -> T:
        """Call a function between two frames, when no lab changes, and return its result.

        All other threads that read a lab use this; the caller waits for the next frame, however
        busy the machine is.

        Raises:
            RuntimeError: the thread does not run.
            Exception: whatever the function raises.
        """
        if threading.current_thread() is self.thread:
            return function()
        answer: Future[T] = Future()
        self._calls.append((function, answer))
        while not answer.done():
            if not self.thread.is_alive():
                raise RuntimeError("the simulation has stopped")
            wait([answer], ANSWER)
        return answer.result()

    @property
    def labs(self) -> list[ScheduledLab]:
        """The labs that run now."""
        return self._labs

    @property
    def lateness(self) -> list[float]:
        """Lateness of the latest frames, [s]."""
        return self.frames.latest()[:, 1].tolist()

    def run(self) -> None:
        """Run frames, each at its deadline, until stopped."""
        last, pace = self._clock(), DisplayRate()
        count, due, deadline = 0, 0, last + FRAME
        while not self._stop.is_set():
            now = self._clock()
            self._sleep(max(deadline - now, PAUSE))
            now = self._clock()
            late = now - deadline
            self.frames.append(now, late)
            note_lateness(late > TOLERATED)
            together = 2 if BEHIND < late <= LATEST else 1
            deadline = now + FRAME if late > LATEST else deadline + together * FRAME
            length, stride = frame_length(due, together), pace.stride_when(late)
            busy, drawing = self._frame(now - last, late, count, stride, length)
            pace.note(busy, drawing, now - last)
            last, count, due = now, count + 1, due + together
        note_lateness(False)

    def _frame(
        self, seconds: float, late: float, count: int, stride: float, length: float
    ) -> tuple[float, float]:
        """Run one frame: each step for all labs, which is faster than lab by lab.

        Args:
            seconds: since the last frame.
            late: how late this one is, [s].
            count: its number.
            stride: frames per frame of display.
            length: simulated time at the usual rate, see `frame_length`, [s].

        Returns:
            Time spent on all but slow updates, and of that on drawing, [s].
        """
        labs, begun = self._labs, self._clock()
        if self._calls:
            function, answer = self._calls.popleft()
            _answer(function, answer)
        spare = FRAME - late - self._advancing - self._drawing
        self._turns.apply(labs, min(max(spare, FEWEST), ALL_COMMANDS))
        applied = self._clock()
        frames = [lab.frame(seconds, length, count, stride) for lab in labs]
        advance_together(frames, log_error)
        ended = self._clock()
        self._advancing += FADING * (ended - applied - self._advancing)
        left = min(SHARE * FRAME, MOST * FRAME - late - (ended - begun) - self._drawing)
        seen = [lab for lab in labs if lab.is_seen]
        self._slow_updates.run(seen, count, left, stride)
        drawing = self._clock()
        _do(lambda lab: lab.show(count, stride), seen)
        _do(ScheduledLab.send, seen)
        drawing = self._clock() - drawing
        self._drawing += FADING * (drawing - self._drawing)
        return ended - begun + drawing, drawing


class CommandTurns:
    """Divides the processor time for commands among labs, by what their commands have taken.

    Labs with short commands come first, and in each group those that have taken least lately. So no
    lab waits for one that keeps asking for long work.
    """

    def __init__(self) -> None:
        self._owed = {True: 0.0, False: 0.0}  # [s] taken too long by light labs, and by others

    def apply(self, labs: list[ScheduledLab], most: float) -> None:
        """Apply the commands of a frame within `most` [s].

        It may be exceeded by one command, or part of one, of each group; later frames make up for
        it.
        """

        def drain(lab: ScheduledLab) -> None:
            nonlocal left
            left -= lab.drain(left)

        spent = 0.0
        for is_light in (True, False):
            left = before = most - spent - self._owed[is_light]
            group = [lab for lab in labs if lab.is_light is is_light]
            _do(drain, sorted(group, key=lambda lab: lab.used))
            spent = before - left
            self._owed[is_light] = max(-left, 0.0)


def _answer(function: Callable[[], T], answer: Future[T]) -> None:
    try:
        answer.set_result(function())
    except Exception as error:  # raised in the caller
        answer.set_exception(error)


def _do(step: Callable[[ScheduledLab], None], labs: list[ScheduledLab]) -> None:
    for lab in labs:
        try:
            step(lab)
        except Exception as error:  # one lab must not stop the others
            log_error(error)
