"""The parts of a history: segments of ticks with the same inputs, and a copy of all of them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from operator import is_

import numpy as np
from msgspec import Struct
from msgspec.structs import replace

from onpath.app.lab.loop_states import Slot
from onpath.models.arrays import Array
from onpath.models.closed_loop.loop_kind import Kind
from onpath.models.paths.curves import Curve
from onpath.models.systems.parameters import Parameters

FEW = 8  # maximum number of settings whose values are stored separately
NONE_VARYING = np.zeros(0, np.uint16)


class Input(Struct, frozen=True, eq=False, gc=False):
    """The input of one robot, except for the values of some settings.

    While an end-point is pulled, the same few settings change in every frame. Their values are
    stored separately, so that this object stays the same. The garbage collector does not track it:
    nothing in it refers back to it.

    Attributes:
        side: the robot's side.
        kind: of the loop.
        base: settings, except for those at `varying`.
        frozen: whether the robot has diverged and stands still.
        size: length of the part of the loop's state that it changes, which is recorded.
        rest: length of the rest, which a loop of another kind changes; restored as 0.
        parameters: with which the robot was made, None if that does not matter.
        varying: indices of at most `FEW` settings whose values are stored separately.
    """

    side: str
    kind: Kind
    base: np.ndarray
    frozen: bool
    size: int
    rest: int = 0
    parameters: Parameters | None = None
    varying: np.ndarray = NONE_VARYING

    def settings(self, values: Array) -> Array:
        """Settings of the loop.

        Args:
            values: of the settings at `varying`, shape (varying,).
        """
        if not len(self.varying):
            return self.base
        settings = self.base.copy()
        settings[self.varying] = values
        return settings

    def like(self, earlier: Input) -> Input:
        """This input expressed with the base of an earlier one; the earlier one if both are equal.

        Nothing in this input is `varying` yet. If more than `FEW` of its settings differ from that
        base, it stays as it is.
        """
        if earlier.base.shape != self.base.shape:
            return self
        differs = (earlier.base.view(np.int64) != self.base.view(np.int64)).nonzero()[0].tolist()
        varying, known = earlier.varying, earlier.varying.tolist()
        if not set(differs).issubset(known):
            varying = np.array(sorted({*differs, *known}), np.uint16)
        elif self._is_like(earlier):
            return earlier
        return self if len(varying) > FEW else replace(self, base=earlier.base, varying=varying)

    def _is_like(self, other: Input) -> bool:
        """Whether they are equal except for their settings."""
        return (
            self.parameters is other.parameters
            and (self.side, self.frozen, self.size) == (other.side, other.frozen, other.size)
            and (self.kind, self.rest) == (other.kind, other.rest)
        )


class Inputs(Struct, frozen=True, eq=False, gc=False):
    """All inputs of a segment, except for the values of some settings; see `Input`.

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
        max_distance: largest distance from the path since reset, [m].
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
    """One simulated frame. A msgspec struct is created ten times as fast as a dataclass.

    Attributes:
        time: at the beginning, [s].
        ticks: number of ticks.
        inputs: the same object until something other than `values` changes.
        slots: of each robot's closed loop, at the beginning.
        values: the settings of all robots that `inputs` leaves out, as float64.
    """

    time: float
    ticks: int
    inputs: Inputs
    slots: Sequence[Slot]
    values: bytes = b""

    def has_inputs_of(self, other: HistoryFrame) -> bool:
        """Whether the inputs of two frames are the same."""
        return self.inputs is other.inputs and self.values == other.values


@dataclass(frozen=True, slots=True, eq=False)
class Segment:
    """Consecutive ticks with the same inputs.

    Attributes:
        time: at the beginning, [s].
        dt: length of a tick, [s].
        curve: the path during the segment.
        drives: by side.
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
        laws = tuple(d.kind.law for d in drives)
        return Instant(
            time=self.time,
            laws=laws,
            states=[d.state for d in drives],
            max_distances=[d.max_distance for d in drives],
            sample=self.sample.astype(float),
        )


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
        """The last segments with at most this many ticks in total, oldest first."""
        if not len(self):
            return []
        together = np.cumsum(self.columns["ticks"][::-1])
        begin = len(self) - int(np.searchsorted(together, ticks, "right"))
        return [segment_at(self.columns, row) for row in range(begin, len(self))]


def segment_at(columns: dict[str, np.ndarray], row: int) -> Segment:
    """Make a segment from one row of the columns."""
    inputs: Inputs = columns["inputs"][row]
    states, values, drives = columns["state"][row], columns["values"][row], dict[str, Drive]()
    for one, most in zip(inputs.of, columns["most"][row].tolist(), strict=True):
        recorded, states = states[: one.size], states[one.size :]
        separate, values = values[: len(one.varying)], values[len(one.varying) :]
        drives[one.side] = Drive(
            kind=one.kind,
            state=np.concatenate([recorded, np.zeros(one.rest)]),
            settings=one.settings(separate),
            frozen=one.frozen,
            max_distance=most,
            parameters=one.parameters,
        )
    return Segment(
        time=float(columns["time"][row]),
        ticks=int(columns["ticks"][row]),
        dt=inputs.dt,
        curve=inputs.curve,
        drives=drives,
        sample=columns["sample"][row].copy(),
    )
