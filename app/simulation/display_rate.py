"""How often the labs are drawn: less often, for all alike, when there are too many of them.

Simulated time is what must not suffer, so the display gives way first: from 30 Hz to 24, 20, 15
when the thread is too busy, and further, at once, for as long as its frames are late.
"""

from __future__ import annotations

from math import inf

STRIDES = (2.0, 2.5, 3.0, 4.0)  # frames of simulation per frame of display
ENOUGH = (0.5, 0.8, 0.85)  # shares of the time up to which the first, second, third is chosen
BUSY = (0.8, 0.9, 0.95)  # shares that are too much for the first, second, third; frames are late
FADING = 1 / 60  # of the measured shares, per frame
BEHIND, HURRIED = 1 / 60, 8.0  # [s] late, from which on frames are drawn at this stride
WORTH = 0.1  # share of the time that drawing takes, from which on less of it makes up for something
PATIENCE, CAUTION = 60, 300  # frames from one change to the next, slower and faster


class DisplayRate:
    """Chooses the stride from how busy the simulation thread is."""

    def __init__(self) -> None:
        self._at = 0
        self._share = self._drawing = 0.0
        self._since = 0

    @property
    def stride(self) -> float:
        """Frames of simulation per frame of display, while these are in time."""
        return STRIDES[self._at]

    def stride_when(self, late: float) -> float:
        """The same for a frame that is so late, [s]."""
        return HURRIED if late > BEHIND and self._drawing > WORTH else self.stride

    def note(self, busy: float, drawing: float, frame: float) -> None:
        """A frame has passed.

        Args:
            busy, drawing, frame: what was spent on it, on its display alone, how long it was, [s].
        """
        frame = max(frame, 1e-6)
        self._share += FADING * (busy / frame - self._share)
        self._drawing += FADING * (drawing / frame - self._drawing)
        self._since += 1
        if self._since >= PATIENCE and self._share > (*BUSY, inf)[self._at]:
            self._at, self._since = self._at + 1, 0
        elif self._since >= CAUTION and self._at > 0 and self._has_time_for(self._at - 1):
            self._at, self._since = self._at - 1, 0

    def _has_time_for(self, at: int) -> bool:
        share = self._share + self._drawing * (self.stride / STRIDES[at] - 1)
        return share < ENOUGH[at]


def is_turn(frame: int, stride: float) -> bool:
    """Whether this frame of simulation is one of the display's."""
    return frame // stride != (frame - 1) // stride
