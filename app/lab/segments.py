"""What a history consists of: stretches of ticks with the same inputs, and a copy of them all."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from operator import is_

import numpy as np

from onpath.models.closed_loop.loop_kind import Kind
from onpath.models.paths.curves import Curve


@dataclass(frozen=True, slots=True, eq=False)
class Input:
    """What drives one robot; the same object while nothing changes.

    Attributes:
        kind: which loop.
        settings: of the loop.
        frozen: whether the robot has diverged and stands still.
    """

    kind: Kind
    settings: np.ndarray
    frozen: bool


@dataclass(frozen=True, slots=True, eq=False)
class Inputs:
    """All inputs of some stretches.

    Attributes:
        curve: the path.
        dt: length of a tick, [s].
        of: each robot's, by controller.
    """

    curve: Curve
    dt: float
    of: dict[str, Input]

    def are(self, curve: Curve, dt: float, of: Iterable[Input]) -> bool:
        """Whether they are these."""
        same = self.curve is curve and self.dt == dt
        return same and all(map(is_, self.of.values(), of))


@dataclass(frozen=True, slots=True, eq=False)
class Drive:
    """One robot's part of a stretch.

    Attributes:
        kind: which loop drives it.
        state: at the beginning.
        settings: of the loop during the stretch.
        frozen: whether it has diverged and stands still.
        max_distance: from the path since reset, [m].
    """

    kind: Kind
    state: np.ndarray
    settings: np.ndarray
    frozen: bool
    max_distance: float


@dataclass(frozen=True, slots=True, eq=False)
class Instant:
    """Both robots at one time.

    Attributes:
        time: [s].
        states: one for each robot.
        max_distances: since reset, shape (robots,), [m].
        sample: what the plots show, shape (robots, fields).
    """

    time: float
    states: Sequence[np.ndarray]
    max_distances: Sequence[float]
    sample: np.ndarray


@dataclass(frozen=True, slots=True, eq=False)
class HistoryFrame:
    """What has just been simulated.

    Attributes:
        time: at the beginning, [s].
        ticks: how many.
        inputs: the same object while nothing changes.
        states: of each robot, at the beginning; nobody changes them any more.
        max_distances: of each, at the beginning, [m].
        rows: of the log, of each, at the beginning.
        distances: of each, at the beginning, [m].
    """

    time: float
    ticks: int
    inputs: Inputs
    states: Sequence[np.ndarray]
    max_distances: Sequence[float]
    rows: Sequence[np.ndarray]
    distances: Sequence[float]


@dataclass(frozen=True, slots=True, eq=False)
class Segment:
    """Some ticks with the same inputs.

    Attributes:
        time: at the beginning, [s].
        dt: length of a tick, [s].
        curve: the path during the stretch.
        drives: by controller.
        sample: what the plots show, at the beginning, shape (robots, fields).
    """

    time: float
    ticks: int
    dt: float
    curve: Curve
    drives: dict[str, Drive]
    sample: np.ndarray

    def instant(self) -> Instant:
        """Its beginning."""
        drives = self.drives.values()
        states, most = [d.state for d in drives], [d.max_distance for d in drives]
        return Instant(self.time, states, most, self.sample.astype(float))


@dataclass(frozen=True, slots=True, eq=False)
class HistoryCopy:
    """The history as it was: arrays of one row per stretch, soon copied and soon pickled.

    Attributes:
        columns: see `History`.
    """

    columns: dict[str, np.ndarray]

    def __len__(self) -> int:
        return len(self.columns["time"]) if self.columns else 0

    def segments(self) -> list[Segment]:
        """The stretches, oldest first."""
        return [segment_at(self.columns, row) for row in range(len(self))]


def segment_at(columns: dict[str, np.ndarray], row: int) -> Segment:
    """One row of the columns."""
    inputs: Inputs = columns["inputs"][row]
    states, most = columns["state"][row].copy(), columns["most"][row]
    drives = {
        name: Drive(one.kind, state, one.settings, one.frozen, float(distance))
        for (name, one), state, distance in zip(inputs.of.items(), states, most, strict=True)
    }
    time, ticks = float(columns["time"][row]), int(columns["ticks"][row])
    return Segment(time, ticks, inputs.dt, inputs.curve, drives, columns["sample"][row].copy())
