"""World poses of all moving parts of all robots, as arrays."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from math import prod, sqrt

import numpy as np

from onpath.app.lab.snapshots.snapshot import Counts, RobotView
from onpath.app.scene.stage import Stage

UNSEEN = 1e-5
PLACED = ("bars", "parts", "tips")
"""Fields that are world positions; the others are directions, lengths and forces."""


@dataclass(frozen=True, slots=True)
class Poses:
    """Poses of everything that moves, for all robots, in the world; float32, as sent to browsers.

    Attributes:
        whole: all following fields in one flat array.
        bars: origins of the link meshes, shape (n, 3), [m].
        quaternions: their orientations, scalar first, shape (n, 4).
        lengths: of the bars, shape (n,), [m].
        parts: for each robot its bearings, pen, two marker discs and extra points, (m, 3), [m].
        turns: rotations of these parts about the vertical, scalar first, shape (m, 4).
        tips: end-points, shape (k, 3), [m].
        forces: on the end-points, shape (k, 3), [N].
    """

    whole: np.ndarray
    bars: np.ndarray
    quaternions: np.ndarray
    lengths: np.ndarray
    parts: np.ndarray
    turns: np.ndarray
    tips: np.ndarray
    forces: np.ndarray

    def is_news(self, drawn: Poses) -> bool:
        """Whether it is finite and differs visibly from the last pose: by 10 µm or 10 µN."""
        return UNSEEN < difference(self.whole, drawn.whole) < np.inf  # false for NaN


def difference(a: np.ndarray, b: np.ndarray) -> float:
    """Euclidean norm of a - b over all entries."""
    d = (a - b).ravel()
    return sqrt(d.dot(d))


def poses_of(stage: Stage, robots: list[RobotView]) -> Poses:
    """World poses of robots of the same kind at one instant."""
    layout = _layout(stage, robots[0].counts)
    flat = np.concatenate([robot.poses for robot in robots])
    with np.errstate(over="ignore"):  # non-finite values are then not drawn
        whole = (flat.take(layout.order) + layout.offsets).astype(np.float32)
    return Poses(whole, *[whole[place].reshape(shape) for place, shape in layout.fields])


@dataclass(frozen=True, slots=True)
class _Layout:
    """Mapping from the poses of each robot in its own frame to `Poses.whole`.

    Attributes:
        order: source index of each entry of `Poses.whole`.
        offsets: added to each entry; the origins of the robots' frames.
        fields: position and shape of each field of `Poses` within `whole`.
    """

    order: np.ndarray
    offsets: np.ndarray
    fields: list[tuple[slice, tuple[int, ...]]]


@lru_cache(maxsize=64)
def _layout(stage: Stage, counts: Counts) -> _Layout:
    own = counts.pose_shapes
    sizes = [prod(shape) for shape in own]
    starts = np.cumsum([0, *sizes]).tolist()
    bases = stage.origins.tolist()
    total, k = starts[-1], len(bases)
    order, offsets = list[int](), list[float]()
    for start, size, name in zip(starts[:-1], sizes, own._fields, strict=True):
        for i, base in enumerate(bases):
            order.extend(range(i * total + start, i * total + start + size))
            offsets.extend(base * (size // 3) if name in PLACED else [0.0] * size)
    ends = np.cumsum([0, *(k * size for size in sizes)]).tolist()
    fields = [
        (slice(*e), (k * n, *rest)) for e, (n, *rest) in zip(pairwise(ends), own, strict=True)
    ]
    return _Layout(np.array(order), np.array(offsets), fields)


def trace_segments(trace: np.ndarray, count: int) -> np.ndarray:
    """A trace as exactly `count` segments, shape (count, 2, 3), padded with zero-length segments.

    With a constant count the colours need no update. A trace is thinned evenly and always keeps
    its newest point.
    """
    return trace[_kept(len(trace), count)] if len(trace) else np.zeros((count, 2, 3))


@lru_cache(maxsize=512)
def _kept(length: int, count: int) -> np.ndarray:
    """Indices of the first and last point of each segment, shape (count, 2)."""
    step = max(1, -(-(length - 1) // count))
    line = np.arange(length)[::-1][::step][: count + 1][::-1]
    line = np.concatenate([np.repeat(line[:1], count + 1 - len(line)), line])
    return np.stack([line[:-1], line[1:]], axis=1)
