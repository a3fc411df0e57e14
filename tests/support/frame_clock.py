"""Time by the frames of a simulation thread, for what does not happen: there is no event to await.

On a busy machine frames come later, and so does all that a lab does; seconds would not wait for it.
"""

from __future__ import annotations

from collections.abc import Callable

from onpath.app.simulation.frame_length import FRAME
from onpath.app.simulation.simulation_thread import SimulationThread


class FrameClock:
    """Of one simulation thread."""

    def __init__(self, thread: SimulationThread) -> None:
        self._thread = thread

    def alarm(self, seconds: float) -> Callable[[], bool]:
        """Tells whether the frames of so many seconds have passed."""
        wanted = self._thread.frames.count + round(seconds / FRAME)
        return lambda: self._thread.frames.count >= wanted
