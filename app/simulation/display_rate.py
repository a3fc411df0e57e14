"""Chooses how often the labs are drawn: less often, for all alike, when there are too many.

Simulated time has priority, so the display slows down first: from 30 Hz to 24 and 22 Hz while the
thread is too busy, and at once to 15 Hz, or less, while its frames are late.
"""

from __future__ import annotations

from math import inf

STRIDES = (2.0, 2.5, 2.75)  # frames of simulation per frame of display
AT_EASE = STRIDES[0]  # stride of a thread that is not busy; labs are then simulated in every frame
ENOUGH = (0.35, 0.65)  # load below which the first, second stride is chosen again
BUSY = (0.5, 0.8)  # load above which the first, second stride is left
FADING = 1 / 60  # low-pass gain of the measured load, per frame
LATE = {1 / 20: 8.0, 1 / 30: 4.0}  # lateness, [s] -> minimum stride above it
WORTH = 0.1  # share of time spent on drawing above which drawing less helps
PATIENCE, CAUTION = 60, 300  # minimum frames between changes, to slower and to faster


class DisplayRate:
    """Chooses the stride from the load of the simulation thread."""

    def __init__(self) -> None:
        self._at = 0
        self._share = self._drawing = 0.0
        self._since = 0

    @property
    def stride(self) -> float:
        """Frames of simulation per frame of display, while frames are on time."""
        return STRIDES[self._at]

    def stride_when(self, late: float) -> float:
        """Stride for a frame that is `late` seconds late."""
        if self._drawing < WORTH:
            return self.stride
        return max([self.stride, *(least for behind, least in LATE.items() if late > behind)])

    def note(self, busy: float, drawing: float, frame: float) -> None:
        """Record the time spent on a frame.

        Args:
            busy: time spent on everything but slow updates, [s].
            drawing: part of that time spent on drawing, [s].
            frame: length of the frame, [s].
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
    """Whether a frame of simulation is drawn."""
    return frame // stride != (frame - 1) // stride
