"""The states of several closed loops of one kind at one instant, as rows of an array."""

from __future__ import annotations

import numpy as np
from msgspec import Struct

from onpath.models.arrays import Array


class LoopStates(Struct, frozen=True, eq=False):
    """Closed loops of one kind at one instant; not modified once a run refers to them.

    Attributes:
        records: a row for each loop: its state, its last log row, the distance of the actual
            end-point from the path, and the largest distance since reset, both [m].
        size: of the state.
    """

    records: Array
    size: int

    @property
    def states(self) -> Array:
        """Shape (loops, layouts.state.size)."""
        return self.records[:, : self.size]

    @property
    def rows(self) -> Array:
        """Log rows, shape (loops, layouts.log.size)."""
        return self.records[:, self.size : -2]

    @property
    def distances(self) -> Array:
        """Shape (loops,), [m]."""
        return self.records[:, -2]

    @property
    def largest(self) -> Array:
        """Largest distances since reset, shape (loops,), [m]."""
        return self.records[:, -1]


Slot = tuple[LoopStates, int]
"""One closed loop: the states, and its row in them."""


def joined(states: Array, rows: Array, distances: Array, largest: Array) -> LoopStates:
    """Closed loops from their parts, which are copied; see `LoopStates`."""
    columns = [states, rows, distances[:, None], largest[:, None]]
    return LoopStates(np.concatenate(columns, axis=1), states.shape[1])


def single(state: Array, row: Array, distance: float, largest: float) -> Slot:
    """A single closed loop."""
    return joined(state[None], row[None], np.array([distance]), np.array([largest])), 0
