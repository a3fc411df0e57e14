"""The last minute of a session: checkpoints to rewind to, samples to plot, inputs to replay.

A stretch keeps the states at its beginning and all inputs of the loop, so that every millisecond
can be computed again, exactly, when somebody wants it as a file.
"""

from __future__ import annotations

import bisect
from collections import deque
from dataclasses import dataclass, replace

import numpy as np

from models.curves import Curve
from models.kernel import Kind

SECONDS = 60.0
LONGEST = 17  # ticks in a stretch at most
MOST = 7200


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

    def continues(self, other: Stretch) -> bool:
        """Whether `other` only goes on with the same inputs."""
        return (
            self.curve is other.curve
            and self.dt == other.dt
            and self.ticks + other.ticks <= LONGEST
            and all(
                drive.settings is other.drives[name].settings
                and drive.kind == other.drives[name].kind
                and drive.frozen == other.drives[name].frozen
                for name, drive in self.drives.items()
            )
        )


class History:
    """Stretches of the last minute, oldest first."""

    def __init__(self) -> None:
        self._stretches: deque[Stretch] = deque(maxlen=MOST)

    def __len__(self) -> int:
        return len(self._stretches)

    def clear(self) -> None:
        """Forget everything."""
        self._stretches.clear()

    def append(self, stretch: Stretch) -> None:
        """Add what has just been simulated; drops what is older than a minute."""
        last = self._stretches[-1] if self._stretches else None
        if last is not None and last.continues(stretch):
            self._stretches[-1] = replace(last, ticks=last.ticks + stretch.ticks)
        else:
            self._stretches.append(stretch)
        while self._stretches[0].time < stretch.time - SECONDS:
            self._stretches.popleft()

    def all(self) -> list[Stretch]:
        """Everything, oldest first."""
        return list(self._stretches)

    def span(self) -> float:
        """How far back it reaches, [s]."""
        if not self._stretches:
            return 0.0
        last = self._stretches[-1]
        return last.time + last.ticks * last.dt - self._stretches[0].time

    def at(self, time: float) -> Stretch | None:
        """The stretch during which it was `time`, or the nearest one; None if there is none."""
        if not self._stretches:
            return None
        index = bisect.bisect_right(self._stretches, time, key=lambda s: s.time) - 1
        return self._stretches[max(index, 0)]

    def forget_after(self, stretch: Stretch) -> None:
        """Drop `stretch` and everything later."""
        while self._stretches and self._stretches[-1].time >= stretch.time:
            self._stretches.pop()

    def samples(self, begin: float, end: float, most: int) -> tuple[np.ndarray, np.ndarray]:
        """Times (n,) and samples (n, robots, fields) with begin <= time <= end, n <= most."""
        low = bisect.bisect_left(self._stretches, begin, key=lambda s: s.time)
        high = bisect.bisect_right(self._stretches, end, key=lambda s: s.time)
        count = high - low
        if count <= 0:
            return np.zeros(0), np.zeros((0, 0, 0))
        step = max(1, -(-count // most))
        first = low + (-low) % step  # the same ones from call to call
        chosen = [self._stretches[i] for i in range(first, high, step)]
        if not chosen:
            return np.zeros(0), np.zeros((0, 0, 0))
        return np.array([s.time for s in chosen]), np.stack([s.sample for s in chosen])
