"""A copy of a student's lab that lives in another process.

It receives the lab's state several times a second, and runs slightly behind: it simulates from one
received state to the next, with the same loop and the same pushes, and never beyond the last one.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Generator
from dataclasses import replace

import numpy as np

from onpath.app.classroom.moment import Moment, typed_loops_of
from onpath.app.classroom.moment_check import read_moment
from onpath.app.classroom.moment_to_lab import take_over
from onpath.app.common.error_log import log_warning
from onpath.app.lab.advance_together import Frame, Ticks
from onpath.app.lab.lab import Lab
from onpath.app.lab.session import MOST_TICKS
from onpath.app.simulation.simulation_thread import FRAME, ScheduledLab
from onpath.models.control.benches import BENCHES
from onpath.models.systems.parameters import time_step

BEHIND = 0.4  # [s], intended delay behind the latest state
FURTHEST = 2.0  # [s]; with a larger delay, states are skipped
GAIN = 0.5  # relative increase of the rate for each multiple of BEHIND in excess
MOST = 50  # pending states


class Mirror(ScheduledLab):
    """A read-only replica of one lab: commands of a page do not reach the student's lab.

    Args:
        lab: a new one, used by nothing else.
        text: the first state, see `app.classroom.moment`.

    Raises:
        ValueError: the state is invalid.
    """

    def __init__(self, lab: Lab, text: str) -> None:
        super().__init__(lab)
        self._now, self._text = read_moment(text), text
        self._coming: deque[Moment] = deque([self._now], MOST)
        self._taken: Moment | None = None
        self._owed = 0.0  # [s]

    def tell(self, text: str) -> None:
        """Receive the lab's current state. Thread-safe; invalid states are ignored."""
        if text == self._text:
            return
        self._text = text
        try:
            self._now = read_moment(text)
        except ValueError as error:
            log_warning("a student's lab cannot be shown: %s", error)
            return
        self._coming.append(self._now)

    @property
    def is_seen(self) -> bool:
        """Whether the student's browser is drawing."""
        return self._now.is_seen

    @property
    def achieved(self) -> float:
        """See `ScheduledLab.achieved`."""
        return self._now.achieved

    def frame(self, seconds: float, length: float = FRAME) -> Frame:
        """Advance by one frame; see `ScheduledLab.frame`."""
        self._take_over_due()
        self._owed += self._step(length)
        while self._coming and self._runs():
            if not (yield from self._run_towards(self._coming[0])):
                return
            self._take_over_due()
        self._owed = 0.0

    def _runs(self) -> bool:
        return self._taken is not None and self._taken.moves

    def _take_over_due(self) -> None:
        while self._coming and self._is_due(self._coming[0]) and self._can_run(self._coming[0]):
            new = self._coming.popleft()
            take_over(self.lab, new, self._taken)
            self._taken = new

    def _can_run(self, new: Moment) -> bool:
        """Whether the loops of its typed laws are made; they are, in the background."""
        try:
            return self.session.law_changes.has_loops(typed_loops_of(new))
        except ValueError as error:
            log_warning("a student's lab cannot be shown: %s", error)
            self._coming.popleft()
            return False

    def _step(self, length: float) -> float:
        """Simulated time of this frame, [s]; the further behind, the longer."""
        if not self._coming:
            return 0.0
        rate = self.session.rate
        behind = (self._coming[-1].time - self.session.time) / (BEHIND * rate)
        return length * rate * float(np.clip(1 + GAIN * (behind - 1), 0.5, 2.0))

    def _is_due(self, new: Moment) -> bool:
        old = self._taken
        return (
            old is None
            or not old.moves
            or (new.robot, new.run) != (old.robot, old.run)
            or new.time < old.time
            or new.time < self.session.time + time_step(self.session.parameters) / 2
            or self._coming[-1].time - self.session.time > FURTHEST * new.rate
        )

    def _run_towards(self, new: Moment) -> Generator[Ticks, None, bool]:
        """Simulate towards a state as far as this frame allows; returns whether it was reached."""
        session, dt = self.session, time_step(self.session.parameters)
        there = max(1, round((new.time - session.time) / dt))
        ticks = min(int(self._owed / dt + 1e-9), there, MOST_TICKS)
        if ticks < 1:
            return False
        self._owed = min(self._owed - ticks * dt, FRAME * session.rate)
        self._move_hands(new, session.time + ticks * dt)
        yield from session.frame_of(ticks)
        self.lab.show_faults()
        if ticks == there:
            session.time = new.time
        return ticks == there

    def _move_hands(self, new: Moment, time: float) -> None:
        """Interpolate the hands between states, because they move more often than states arrive."""
        old = self._taken
        assert old is not None
        pushes = self.session.grips.pushes
        passed = (time - old.time) / (new.time - old.time)
        for bench, this, that in zip(BENCHES, old.robots, new.robots, strict=True):
            if this.hand and that.hand and this.hand != that.hand:
                at = (1 - passed) * np.array(this.hand) + passed * np.array(that.hand)
                pushes[bench] = replace(pushes[bench], hand=at)
