"""When the latest frames of the simulation began, and how late they were."""

from __future__ import annotations

import numpy as np

from onpath.models.arrays import Array

SPARE = 60  # frames that may be added during a read


class FrameTimes:
    """The latest frames, written by one thread and read by any.

    They are rows of one array. Objects that are replaced one by one, each after a minute, would
    fragment the memory, so that little of it could be returned to the system.

    Args:
        most: number of frames that are kept.

    Attributes:
        count: number of frames so far.
    """

    def __init__(self, most: int = 3600) -> None:
        self._most, self._rows, self.count = most, np.zeros((most + SPARE, 2)), 0

    def append(self, began: float, late: float) -> None:
        """Add a frame: when it began, by the thread's clock, and how late that was, [s]."""
        self._rows[self.count % len(self._rows)] = began, late
        self.count += 1

    def latest(self) -> Array:
        """Beginning and lateness of the frames that are kept, oldest first, shape (n, 2), [s]."""
        count = self.count
        return self._rows[np.arange(max(count - self._most, 0), count) % len(self._rows)]
