"""A lab in the simulation thread: when it is simulated, its measured speed, and its viewer."""

from __future__ import annotations

from math import inf
from typing import Protocol

from msgspec import Struct
from typing_extensions import override

from onpath.app.common.error_log import log_error
from onpath.app.lab.advance_together import Frame
from onpath.app.lab.lab import Lab
from onpath.app.simulation.display_rate import AT_EASE
from onpath.app.simulation.frame_length import FRAME
from onpath.app.simulation.slow_updates import Updated

FORGETTING = 1 / 600  # low-pass gain of the processor time of a lab's commands, per frame
FORGIVING = 1 / 120  # share per frame by which a lab's longest commands count less
SHORT = 2e-3  # [s] of processor time up to which a command counts as short
FADING = 1 / 60  # low-pass gain of a lab's measured speed, per frame
LONGEST = 4  # maximum number of frames that are simulated together
NEVER = -1_000_000  # number of a frame in the distant past


class Elapsed(Struct, frozen=True):
    """Frames that have not been simulated yet.

    Attributes:
        seconds: elapsed time, [s].
        length: simulated time of the frames at the usual rate, [s].
        frames: number of frames.
    """

    seconds: float
    length: float
    frames: int

    def and_frame(self, seconds: float, length: float) -> Elapsed:
        """These frames and one more."""
        return Elapsed(self.seconds + seconds, self.length + length, self.frames + 1)


NOTHING = Elapsed(0.0, 0.0, 0)


class LabDisplay(Protocol):
    """Shows a lab; called by the simulation thread only."""

    @property
    def is_outdated(self) -> bool:
        """Whether it needs a `refresh` now."""
        ...

    def is_turn(self, lab: Lab, frame: int, stride: float) -> bool:
        """Whether what moves is shown in this frame."""
        ...

    def show(self, lab: Lab, frame: int, stride: float) -> None:
        """Show what moves, in every `stride`-th frame; `frame` is the number of the frame."""
        ...

    def refresh(self, lab: Lab, achieved: float) -> None:
        """Show everything, also what changes slowly; see `SlowUpdates`."""
        ...

    def send(self) -> None:
        """Send what has been shown, after all labs have been simulated."""
        ...


class ScheduledLab(Updated):
    """A lab, its measured speed and its viewer.

    Attributes:
        lab: the lab.
        simulation: its simulated part.
        display: what shows it, or None.
        used: processor time of its commands in about the last ten seconds, [s].
        refreshed: see `Updated`.
    """

    def __init__(self, lab: Lab) -> None:
        self.lab, self.simulation = lab, lab.simulation
        self.display: LabDisplay | None = None
        self.refreshed = NEVER
        self.used = self._longest = 0.0
        self._simulated = self._passed = 1e-6  # recent, low-pass filtered over about a second
        self._elapsed = NOTHING

    @property
    def is_seen(self) -> bool:
        """Whether a browser draws it; otherwise simulated time is paused."""
        return self.display is not None

    @property
    def achieved(self) -> float:
        """Recent simulated seconds per second."""
        return self._simulated / self._passed

    @property
    def is_light(self) -> bool:
        """Whether its commands have lately been short, so that they need not wait for long ones."""
        return self._longest < SHORT

    def drain(self, most: float = inf) -> float:
        """Apply commands, and do whatever else a lab does before a frame.

        Args:
            most: processor time after which the remaining commands wait, [s].

        Returns:
            Processor time of the commands, [s].
        """
        taken = self.lab.drain(most)
        self.used += taken - FORGETTING * self.used
        if not self.lab.has_commands:  # it need not wait to be forgiven
            self._longest -= FORGIVING * self._longest
        self._longest = max(taken, self._longest)
        return taken

    def frame(
        self, seconds: float, length: float = FRAME, count: int = 0, stride: float = AT_EASE
    ) -> Frame:
        """Simulate a frame with those postponed before it, or postpone it; see `advance_together`.

        Simulated time is paused while nobody looks.

        Args:
            seconds: time since the last frame, for the measured speed, [s].
            length: simulated time at the usual rate, see `frame_length`, [s].
            count: number of the frame.
            stride: frames of simulation per frame of display.
        """
        if self.display is None:
            self._elapsed = NOTHING
            return
        self._elapsed = elapsed = self._elapsed.and_frame(seconds, length)
        if not self._is_due(count, stride):
            return
        self._elapsed = NOTHING
        simulation = self.simulation
        before = simulation.time
        yield from self.lab.frame(simulation.settings.rate * elapsed.length)
        if simulation.running and not self.lab.frozen:
            kept = (1 - FADING) ** elapsed.frames
            self._simulated = kept * self._simulated + simulation.time - before
            self._passed = kept * self._passed + elapsed.seconds

    def _is_due(self, count: int, stride: float) -> bool:
        """Whether the lab is simulated in a frame.

        A busy thread simulates a lab only when it is drawn: several frames together take little
        longer than one. While a script is played, the lab is simulated in every frame, so that
        commands are applied at their times.
        """
        always = stride == AT_EASE or self.lab.script is not None
        return always or self._elapsed.frames >= LONGEST or self.is_turn(count, stride)

    @property
    @override
    def is_outdated(self) -> bool:
        display = self.display  # another thread may remove it
        return display is not None and display.is_outdated

    @override
    def is_turn(self, frame: int, stride: float) -> bool:
        display = self.display
        return display is not None and display.is_turn(self.lab, frame, stride)

    @override
    def refresh(self, frame: int) -> None:
        self.refreshed, display = frame, self.display
        if display is not None:
            try:
                display.refresh(self.lab, self.achieved)
            except Exception as error:  # one lab must not stop the others
                log_error(error)

    def show(self, count: int, stride: float) -> None:
        """Show its viewer what moves."""
        display = self.display
        if display is not None:
            display.show(self.lab, count, stride)

    def send(self) -> None:
        """Send what has been shown."""
        display = self.display
        if display is not None:
            display.send()
