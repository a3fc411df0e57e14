"""How often the labs are drawn: less often, for all alike, when there are too many of them.

Simulated time is what must not suffer, so the display gives way first: from 30 Hz to 20, then 15.
"""

from __future__ import annotations

STRIDES = (2, 3, 4)  # frames of simulation per frame of display
BUSY, ENOUGH = 0.9, 0.82  # shares of the time: too much, and what drawing more may come to
FADING = 1 / 30  # of the measured share, per frame
PATIENCE = 60  # frames from one change to the next


class Pace:
    """Chooses the stride from how busy the simulation thread is."""

    def __init__(self) -> None:
        self._at = 0
        self._share = 0.0
        self._since = 0

    @property
    def stride(self) -> int:
        """Frames of simulation per frame of display."""
        return STRIDES[self._at]

    def note(self, busy: float, frame: float) -> None:
        """A frame has passed.

        Args:
            busy, frame: what was spent on it, how long it was, [s].
        """
        self._share += FADING * (busy / max(frame, 1e-6) - self._share)
        self._since += 1
        if self._since < PATIENCE:
            return
        if self._share > BUSY and self._at < len(STRIDES) - 1:
            self._at, self._since = self._at + 1, 0
        elif self._at > 0 and self._share * self.stride / STRIDES[self._at - 1] < ENOUGH:
            self._at, self._since = self._at - 1, 0  # even if drawing were all that is done
