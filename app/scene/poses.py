"""World poses of all moving parts of all robots, as arrays."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from math import prod, sqrt

import numpy as np
from msgspec import Struct

from onpath.app.lab.snapshots.snapshot import Counts, Motion
from onpath.app.scene.stage import Stage

UNSEEN = 1e-5
"""Differences up to this are not drawn [m, N]."""
PLACED = ("bars", "parts", "tips", "bodies")
"""Fields that are world positions; the others are directions, lengths and forces."""
OF_BARS = ("bars", "quaternions", "lengths")
"""Fields with one row for each bar: first the links of all robots, then the pieces of strips, then
the straight strips."""
OF_BODIES = ("bodies", "attitudes")
"""Fields with one row for each moving body: first the first one of all robots, then the second."""


class Poses(Struct, frozen=True, eq=False):
    """Poses of all moving parts of all robots, in the world.

    Attributes:
        whole: the fields of `PoseShapes`, one after the other, each of all robots; float32, as sent
            to browsers.
        fields: span and shape of each field within `whole`.
    """

    whole: np.ndarray
    fields: dict[str, tuple[slice, tuple[int, ...]]]

    def __getitem__(self, field: str) -> np.ndarray:
        """One field, a row for each bar, part or robot."""
        span, shape = self.fields[field]
        return self.whole[span].reshape(shape)

    def span(self, field: str, rows: slice = slice(None)) -> slice:
        """Where some rows of a field are in `whole`."""
        span, shape = self.fields[field]
        begin, end, _ = rows.indices(shape[0])
        width = prod(shape[1:])
        return slice(span.start + begin * width, span.start + end * width)

    @property
    def seldom_changing(self) -> np.ndarray:
        """Lengths, rotations and forces, which rarely change; flat."""
        return self.whole[self.fields["lengths"][0].start :]

    def is_news(self, drawn: Poses) -> bool:
        """Whether the poses are finite and differ visibly from the drawn ones (10 µm, 10 µN)."""
        return UNSEEN < difference(self.whole, drawn.whole) < np.inf  # false for NaN


def difference(a: np.ndarray, b: np.ndarray) -> float:
    """Euclidean norm of a - b over all entries."""
    d = (a - b).ravel()
    return sqrt(d.dot(d))


def poses_of(stage: Stage, motion: Motion) -> Poses:
    """World poses of robots of the same kind at one instant."""
    layout = _layout(stage, motion.counts)
    whole = layout.offsets + motion.drawn.take(layout.order)
    with np.errstate(over="ignore"):  # non-finite values are then not drawn
        return Poses(whole.astype(np.float32), layout.fields)


@dataclass(frozen=True, slots=True)
class _Layout:
    """Mapping from `Motion.drawn`, in each robot's own frame, to `Poses`.

    Attributes:
        order: index in `Motion.drawn` of each entry of `Poses.whole`.
        offsets: added to each entry; the origins of the robots' frames.
        fields: see `Poses`.
    """

    order: np.ndarray
    offsets: np.ndarray
    fields: dict[str, tuple[slice, tuple[int, ...]]]


@lru_cache(maxsize=64)
def _layout(stage: Stage, counts: Counts) -> _Layout:
    start, bases = 3 * counts.points, stage.origins.tolist()
    order, offsets = list[int](), list[float]()
    fields = dict[str, tuple[slice, tuple[int, ...]]]()
    for name, (rows, *rest) in counts.pose_shapes._asdict().items():
        width, before = prod(rest), len(order)
        places = [(i, row) for i in range(len(bases)) for row in range(rows)]
        if name in OF_BARS:
            places.sort(key=lambda place: (place[1] >= counts.links) + (place[1] >= counts.bars))
        if name in OF_BODIES:
            places.sort(key=lambda place: place[1])
        for i, row in places:
            at = i * counts.size + start + row * width
            order.extend(range(at, at + width))
            offsets.extend(bases[i] if name in PLACED else [0.0] * width)
        fields[name] = (slice(before, len(order)), (len(places), *rest))
        start += rows * width
    return _Layout(np.array(order), np.array(offsets), fields)


def trace_segments(trace: np.ndarray, count: int) -> np.ndarray:
    """A trace as exactly `count` segments, shape (count, 2, 3), padded with zero-length segments.

    With a constant count the colours need no update. A trace is thinned evenly and always keeps
    its newest point.
    """
    return trace[_kept(len(trace), count)] if len(trace) else np.zeros((count, 2, 3))


@lru_cache(maxsize=16)
def _kept(length: int, count: int) -> np.ndarray:
    """Indices of the first and last point of each segment, shape (count, 2)."""
    step = max(1, -(-(length - 1) // count))
    line = np.arange(length)[::-1][::step][: count + 1][::-1]
    line = np.concatenate([np.repeat(line[:1], count + 1 - len(line)), line])
    return np.stack([line[:-1], line[1:]], axis=1)
