"""The last minute of a session: checkpoints to rewind to, samples to plot, inputs to replay.

A stretch keeps the states at its beginning and all inputs of the loop, so that every millisecond
can be computed again, exactly, when somebody wants it as a file.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from models.curves import Curve
from models.loop_kind import Kind

SECONDS = 60.0
LONGEST = 17  # ticks in a stretch at most
RECENT = 12.0  # [s], at the full rate; what is older is thinned out
COARSE = 4 * LONGEST  # ticks in an older stretch at most
MOST = 7200
FIRST = 256  # stretches that there is room for at first
FULL = 0.9  # of the room, when more is needed


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

    def same(self, other: Inputs) -> bool:
        """Whether `other` has the same."""
        return (
            self.curve is other.curve
            and self.dt == other.dt
            and all(mine is other.of[name] for name, mine in self.of.items())
        )


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
class Stretch:
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


class History:
    """Stretches of the last minute, oldest first, as columns: all of one kind in one array.

    The columns' rows from `_begin` to `_end` are in use; when they reach the columns' end they
    move to the front, and older ones are joined, four frames of the lab to one.
    """

    def __init__(self) -> None:
        self.clear()

    def __len__(self) -> int:
        return self._end - self._begin

    def clear(self) -> None:
        """Forget everything."""
        self._columns: dict[str, np.ndarray] = {}
        self._list: list[Stretch] | None = None
        self._begin = self._end = 0
        self._before = 0  # rows that have been moved out at the front, ever

    def append(self, instant: Instant, ticks: int, inputs: Inputs) -> None:
        """Add what has just been simulated; drops what is older than a minute."""
        self._list = None
        last = self._columns["inputs"][self._end - 1] if len(self) else inputs
        if last.same(inputs):
            inputs = last
            if len(self) and self._columns["ticks"][self._end - 1] + ticks <= LONGEST:
                self._columns["ticks"][self._end - 1] += ticks
                return
        if not self._columns or self._end == len(self._columns["time"]):
            self._make_room(instant)
        columns, row = self._columns, self._end
        columns["time"][row], columns["ticks"][row] = instant.time, ticks
        columns["inputs"][row] = inputs
        for robot, state in enumerate(instant.states):
            columns["state"][row, robot] = state
        columns["most"][row] = instant.max_distances
        columns["sample"][row] = instant.sample
        self._end += 1
        while len(self) > MOST or self._ends(self._begin) < instant.time - SECONDS:
            self._begin += 1

    def all(self) -> list[Stretch]:
        """Everything, oldest first; the same objects until something changes."""
        if self._list is None:
            self._list = [self._stretch(row) for row in range(self._begin, self._end)]
        return list(self._list)

    def span(self) -> float:
        """How far back it reaches, [s]."""
        if not len(self):
            return 0.0
        return float(self._ends(self._end - 1) - self._columns["time"][self._begin])

    def at(self, time: float) -> Stretch | None:
        """The stretch during which it was `time`, or the nearest one; None if there is none."""
        if not len(self):
            return None
        return self._stretch(max(self._find(time, "right") - 1, self._begin))

    def forget_after(self, stretch: Stretch) -> None:
        """Drop `stretch` and everything later."""
        self._list = None
        self._end = self._find(stretch.time, "left")

    def samples(self, begin: float, end: float, most: int) -> tuple[np.ndarray, np.ndarray]:
        """Times (n,) and samples (n, robots, fields) with begin <= time <= end, n <= most."""
        low, high = self._find(begin, "left"), self._find(end, "right")
        if low >= high:
            return np.zeros(0), np.zeros((0, 0, 0))
        step = max(1, -(-(high - low) // most))
        first = low + (-low - self._before) % step  # the same ones from call to call
        chosen = slice(first, high, step)
        return self._columns["time"][chosen].copy(), self._columns["sample"][chosen].copy()

    def _find(self, time: float, side: Any) -> int:
        """Where `time` would have to be put in."""
        if not len(self):
            return self._end
        times = self._columns["time"][self._begin : self._end]
        return self._begin + int(times.searchsorted(time, side))

    def _stretch(self, row: int) -> Stretch:
        columns = self._columns
        inputs: Inputs = columns["inputs"][row]
        states, most = columns["state"][row].copy(), columns["most"][row]
        drives = {
            name: Drive(one.kind, state, one.settings, one.frozen, float(distance))
            for (name, one), state, distance in zip(inputs.of.items(), states, most, strict=True)
        }
        time, ticks = float(columns["time"][row]), int(columns["ticks"][row])
        return Stretch(time, ticks, inputs.dt, inputs.curve, drives, columns["sample"][row].copy())

    def _make_room(self, instant: Instant) -> None:
        """Columns with free rows at their end: thinned out, and larger if that is not enough."""
        kept, old, size = self._kept(), self._columns, len(self._columns.get("time", ()))
        if len(kept):
            old["ticks"][kept] = np.add.reduceat(old["ticks"][: self._end], kept)
        if len(kept) >= FULL * size:
            rows, robots = max(2 * size, FIRST), len(instant.sample)
            self._columns = {
                "time": np.empty(rows),
                "ticks": np.empty(rows, dtype=int),
                "inputs": np.empty(rows, dtype=object),
                "state": np.empty((rows, robots, len(instant.states[0]))),
                "most": np.empty((rows, robots)),
                "sample": np.empty((rows, *instant.sample.shape), dtype=np.float32),
            }
        for name, column in old.items():
            self._columns[name][: len(kept)] = column[kept]
        self._columns["inputs"][len(kept) :] = None  # let go of what nobody needs
        self._before += self._end - len(kept)
        self._begin, self._end = 0, len(kept)

    def _kept(self) -> np.ndarray:
        """Rows that stay: all recent ones, and older ones unless they join the one before."""
        if not len(self):
            return np.zeros(0, dtype=int)
        inside, inputs = slice(self._begin, self._end), self._columns["inputs"]
        times, ticks = (self._columns[name][inside].tolist() for name in ("time", "ticks"))
        kept, joined = list[int](), 0
        for row, (time, more) in enumerate(zip(times, ticks, strict=True), self._begin):
            joins = kept and time < times[-1] - RECENT and inputs[row] is inputs[kept[-1]]
            if not joins or joined + more > COARSE or self._jumps(row):
                kept.append(row)
                joined = 0
            joined += more
        return np.array(kept)

    def _jumps(self, row: int) -> bool:
        """Whether a row does not begin where the one before ends."""
        return abs(self._columns["time"][row] - self._ends(row - 1)) > 1e-6

    def _ends(self, row: int) -> float:
        """When a row ends, [s]."""
        columns = self._columns
        return columns["time"][row] + columns["ticks"][row] * columns["inputs"][row].dt
