"""The parts of a history: segments of ticks with the same inputs, and a copy of all of them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from operator import is_

import numpy as np
from msgspec import Struct
from msgspec.structs import replace

from onpath.app.lab.loop_states import Place
from onpath.models.arrays import Array
from onpath.models.closed_loop.loop_kind import Kind
from onpath.models.paths.curves import Curve
from onpath.models.systems.parameters import Parameters

FEW = 8  # settings that are stored one by one


class Input(Struct, frozen=True, eq=False, gc=False):
    """The input of one robot; the same object until something changes.

    While somebody pulls, a lab makes one in every frame. Therefore it stores only where its
    settings differ from earlier ones, and is not examined for garbage; nothing in it refers to it.

    Attributes:
        bench: where the robot is.
        kind: of the loop.
        base: settings of an earlier input, or its own.
        frozen: whether the robot has diverged and stands still.
        size: length of the part of the loop's state that it changes, which is recorded.
        parameters: with which the robot was made, None if that does not matter.
        rest: length of the rest, which a loop of another kind changes; restored as 0.
        places, values: where the settings differ from `base`, uint16, and how, float64.
    """

    bench: str
    kind: Kind
    base: np.ndarray
    frozen: bool
    size: int
    rest: int = 0
    parameters: Parameters | None = None
    places: bytes = b""
    values: bytes = b""

    @property
    def settings(self) -> Array:
        """Settings of the loop."""
        if not self.places:
            return self.base
        settings = self.base.copy()
        settings[np.frombuffer(self.places, np.uint16)] = np.frombuffer(self.values)
        return settings

    def based_on(self, earlier: Input) -> Input:
        """This input, with the base of an earlier one if its settings differ in few places."""
        base = earlier.base
        if base.shape != self.base.shape:
            return self
        places = np.flatnonzero(base.view(np.int64) != self.base.view(np.int64))
        if len(places) > FEW:
            return self
        where = places.astype(np.uint16).tobytes()
        if where == earlier.places:  # as in most frames of a pull: stored once
            where = earlier.places
        return replace(self, base=base, places=where, values=self.base[places].tobytes())


class Inputs(Struct, frozen=True, eq=False, gc=False):
    """All inputs of a segment. Not examined for garbage, as `Input`.

    Attributes:
        curve: the path.
        dt: length of a tick, [s].
        of: inputs of the robots.
    """

    curve: Curve
    dt: float
    of: tuple[Input, ...]

    def are(self, curve: Curve, dt: float, of: Iterable[Input]) -> bool:
        """Whether the inputs are the given ones."""
        same = self.curve is curve and self.dt == dt
        return same and all(map(is_, self.of, of))


@dataclass(frozen=True, slots=True, eq=False)
class Drive:
    """One robot's part of a segment.

    Attributes:
        kind: of the loop that drives it.
        state: at the beginning.
        settings: of the loop during the segment.
        frozen: whether it has diverged and stands still.
        max_distance: largest distance to the path since reset, [m].
        parameters: with which the robot was made, or None.
    """

    kind: Kind
    state: np.ndarray
    settings: np.ndarray
    frozen: bool
    max_distance: float
    parameters: Parameters | None = None


@dataclass(frozen=True, slots=True, eq=False)
class Instant:
    """Both robots at one time.

    Attributes:
        time: [s].
        laws: control law of each robot.
        states: one per robot; their lengths depend on the laws.
        max_distances: since reset, shape (robots,), [m].
        sample: plotted values, shape (robots, fields).
    """

    time: float
    laws: tuple[str, ...]
    states: Sequence[np.ndarray]
    max_distances: Sequence[float]
    sample: np.ndarray


class HistoryFrame(Struct, frozen=True, eq=False):
    """One simulated frame. A msgspec struct, since those are made in a tenth of the time.

    Attributes:
        time: at the beginning, [s].
        ticks: number of ticks.
        inputs: the same object until something changes.
        places: of each robot's closed loop, at the beginning.
    """

    time: float
    ticks: int
    inputs: Inputs
    places: Sequence[Place]


@dataclass(frozen=True, slots=True, eq=False)
class Segment:
    """Consecutive ticks with the same inputs.

    Attributes:
        time: at the beginning, [s].
        dt: length of a tick, [s].
        curve: the path during the segment.
        drives: by bench.
        sample: plotted values, at the beginning, shape (robots, fields).
    """

    time: float
    ticks: int
    dt: float
    curve: Curve
    drives: dict[str, Drive]
    sample: np.ndarray

    def instant(self) -> Instant:
        """The instant at its beginning."""
        drives = self.drives.values()
        laws = tuple(d.kind.controller for d in drives)
        states, most = [d.state for d in drives], [d.max_distance for d in drives]
        return Instant(self.time, laws, states, most, self.sample.astype(float))


@dataclass(frozen=True, slots=True, eq=False)
class HistoryCopy:
    """A copy of a history: arrays with one row per segment, cheap to copy and to pickle.

    Attributes:
        columns: see `History`.
    """

    columns: dict[str, np.ndarray]

    def __len__(self) -> int:
        return len(self.columns["time"]) if self.columns else 0

    def segments(self) -> list[Segment]:
        """The segments, oldest first."""
        return [segment_at(self.columns, row) for row in range(len(self))]

    def latest(self, ticks: int) -> list[Segment]:
        """The last segments, as many as have at most so many ticks together, oldest first."""
        if not len(self):
            return []
        together = np.cumsum(self.columns["ticks"][::-1])
        begin = len(self) - int(np.searchsorted(together, ticks, "right"))
        return [segment_at(self.columns, row) for row in range(begin, len(self))]


def segment_at(columns: dict[str, np.ndarray], row: int) -> Segment:
    """Make a segment from one row of the columns."""
    inputs: Inputs = columns["inputs"][row]
    states, end, drives = columns["state"][row], 0, dict[str, Drive]()
    for one, most in zip(inputs.of, columns["most"][row].tolist(), strict=True):
        begin, end = end, end + one.size
        state = np.concatenate([states[begin:end], np.zeros(one.rest)])
        drives[one.bench] = Drive(one.kind, state, one.settings, one.frozen, most, one.parameters)
    time, ticks = float(columns["time"][row]), int(columns["ticks"][row])
    return Segment(time, ticks, inputs.dt, inputs.curve, drives, columns["sample"][row].copy())
