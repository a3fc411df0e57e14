"""Where every moving part of both machines goes: a snapshot as arrays of poses. Pure geometry.

The geometry is a function of CasADi, made once for a stage: numpy would take ten times as long for
as few numbers as these. Points are columns in it, and rows of the arrays around it.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from math import sqrt

import casadi as ca
import numpy as np

from onpath.app.common.per_thread import per_thread
from onpath.app.lab.snapshot import Counts, RobotView
from onpath.app.scene.stage import Stage
from onpath.models.closed_loop.buffered import Buffered

UNSEEN = 1e-5
MARKER_DEPTHS = (-0.008, -0.0095)
"""y of a marker's two discs [m]: before the path and its control points."""


def waist_angle(bars: ca.SX, away: tuple[float, float] = (0.0, 1.0)) -> ca.SX:
    """Angle of the linkage's plane, which is vertical, about the vertical, [rad].

    Args:
        bars: begins and ends of link 1, link 2 and others as columns, shape (3, 2 n), [m].
        away: to which side of it the plane's normal (-sin, cos) shall look.
    """
    a, b = bars[:, 1] - bars[:, 0], bars[:, 3] - bars[:, 2]
    x, y = b[1] * a[2] - b[2] * a[1], b[2] * a[0] - b[0] * a[2]  # normal of the plane
    stretched = ca.hypot(x, y) < 1e-9
    x, y = ca.if_else(stretched, away[0], x), ca.if_else(stretched, away[1], y)
    return ca.if_else(x * away[0] + y * away[1] >= 0, ca.atan2(-x, y), ca.atan2(x, -y))


def bar_quaternions(along: ca.SX, waist: ca.SX) -> ca.SX:
    """Turns the x axis along each bar and keeps the y axis as near as can be to the plane's normal.

    Args:
        along: vectors, shape (3, n).
        waist: angle of the linkage's plane, [rad].

    Returns:
        Unit quaternions, scalar first, shape (4, n).
    """
    c, s = ca.cos(waist), ca.sin(waist)
    outward = along[0, :] * c + along[1, :] * s
    across = along[1, :] * c - along[0, :] * s
    pitch = ca.atan2(along[2, :], outward) / 2
    bend = ca.atan2(across, ca.hypot(outward, along[2, :])) / 2
    cw, sw, cp, sp = ca.cos(waist / 2), ca.sin(waist / 2), ca.cos(pitch), ca.sin(pitch)
    cb, sb = ca.cos(bend), ca.sin(bend)
    w, x, y, z = cw * cp, sw * sp, -cw * sp, sw * cp  # about z by the waist, about -y by the pitch
    return ca.vertcat(w * cb - z * sb, x * cb + y * sb, y * cb - x * sb, z * cb + w * sb)


@dataclass(frozen=True, slots=True)
class Poses:
    """Everything that moves, for all robots, in the world; float32, as browsers take it.

    Attributes:
        whole: all that follows in one, flat.
        bars: where the link meshes begin, shape (n, 3), [m].
        quaternions: how they are turned, scalar first, shape (n, 4).
        lengths: of the bars, shape (n,), [m].
        parts: for each robot its bearings, pen, two marker discs and extra points, (m, 3), [m].
        turns: how these are turned about the vertical, scalar first, shape (m, 4).
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
        """Whether it can be drawn, and somebody could see the difference: 10 µm, 10 µN."""
        return UNSEEN < difference(self.whole, drawn.whole) < np.inf  # not if it is NaN


def difference(a: np.ndarray, b: np.ndarray) -> float:
    """Euclidean norm of a - b, of all their numbers together."""
    d = (a - b).ravel()
    return sqrt(d.dot(d))


def poses_of(stage: Stage, robots: list[RobotView]) -> Poses:
    """The poses of robots that are all alike, on their stage, at one instant.

    Links 1 and 3 lie in the back layer, link 2 and the pieces of link 4 in the front one, so that
    none runs through another; bearings span both.
    """
    return _layout(stage, robots[0].counts).poses(robots)


class _Layout:
    """Turns points of robots into poses. One thread at a time."""

    def __init__(self, stage: Stage, counts: Counts) -> None:
        bases = tuple(map(tuple, stage.origins.tolist()))
        away = float(stage.away[0]), float(stage.away[1])
        self._poses = Buffered(_geometry(bases, away, stage.depths, counts))
        k = len(bases)
        bars, parts = k * counts.bars, k * _parts(counts)
        self._shapes = ((bars, 3), (bars, 4), (bars,), (parts, 3), (parts, 4), (k, 3), (k, 3))
        ends = np.cumsum([0, *(int(np.prod(shape)) for shape in self._shapes)]).tolist()
        self._places = [slice(*ends) for ends in pairwise(ends)]

    def poses(self, robots: list[RobotView]) -> Poses:
        """See `poses_of`."""
        points = np.concatenate([robot.points for robot in robots]).ravel()
        with np.errstate(over="ignore"):  # what is not finite then is not drawn
            whole = self._poses(points)[0].astype(np.float32)
        named = zip(self._places, self._shapes, strict=True)
        return Poses(whole, *[whole[place].reshape(shape) for place, shape in named])


@per_thread
def _layout(stage: Stage, counts: Counts) -> _Layout:
    return _Layout(stage, counts)


def _parts(counts: Counts) -> int:
    """Bearings, pen, two discs of a marker, further points."""
    return counts.joints + 3 + counts.marks


@lru_cache(maxsize=16)
def _geometry(
    bases: tuple[tuple[float, ...], ...],
    away: tuple[float, float],
    depths: tuple[float, float, float, float],
    counts: Counts,
) -> ca.Function:
    """Points of each robot as columns -> the fields of `Poses`, flat."""
    given = ca.SX.sym("points", 3, counts.points * len(bases))
    each = [
        _robot(points, ca.DM(base), away, depths, counts)
        for points, base in zip(ca.horzsplit(given, counts.points), bases, strict=True)
    ]
    fields = [ca.horzcat(*columns) for columns in zip(*each, strict=True)]
    flat = ca.vertcat(*[ca.vec(ca.densify(field)) for field in fields])
    return ca.Function("layout", [given], ca.cse([flat]))


def _robot(
    points: ca.SX,
    base: ca.DM,
    away: tuple[float, float],
    depths: tuple[float, float, float, float],
    counts: Counts,
) -> tuple[ca.SX, ...]:
    """One robot's share of the fields of `Poses`, as columns."""
    back, front, boss, pen = depths
    at = np.cumsum([0, 2 * counts.bars, counts.joints, counts.marks, 1, 1, 1, 1]).tolist()
    ends, joints, marks, marker, tip, _, force = (points[:, i:j] for i, j in pairwise(at))
    waist = waist_angle(ends, away)
    normal = ca.vertcat(-ca.sin(waist), ca.cos(waist), 0)
    begins, along = ends[:, ::2], ends[:, 1::2] - ends[:, ::2]
    layers = ca.DM([back, front, back] + [front] * (counts.bars - 3)).T
    turned = ca.vertcat(ca.cos(waist / 2), 0, 0, ca.sin(waist / 2))
    still = ca.DM([1, 0, 0, 0])  # these face the viewer, however the linkage is turned
    discs = [marker + ca.DM([0, depth, 0]) for depth in MARKER_DEPTHS]
    further = marks + ca.DM([0, MARKER_DEPTHS[0], 0]) @ ca.DM.ones(1, counts.marks)
    machined = ca.horzcat(joints + boss * normal, tip + pen * normal)
    return (
        base + begins + normal @ layers,
        bar_quaternions(along, waist),
        ca.sqrt(ca.sum1(along**2)),
        base + ca.horzcat(machined, *discs, further),
        ca.horzcat(*[turned] * (counts.joints + 1), *[still] * (2 + counts.marks)),
        base + tip,
        force,
    )


def trace_segments(trace: np.ndarray, count: int) -> np.ndarray:
    """A trace as exactly `count` segments, shape (count, 2, 3); the missing ones have no length.

    A constant count lets their colours stay as they are. A trace is thinned evenly, never at its
    newest end.
    """
    return trace[_kept(len(trace), count)] if len(trace) else np.zeros((count, 2, 3))


@lru_cache(maxsize=512)
def _kept(length: int, count: int) -> np.ndarray:
    """Which points of a trace the segments begin and end at, shape (count, 2)."""
    step = max(1, -(-(length - 1) // count))
    line = np.arange(length)[::-1][::step][: count + 1][::-1]
    line = np.concatenate([np.repeat(line[:1], count + 1 - len(line)), line])
    return np.stack([line[:-1], line[1:]], axis=1)
