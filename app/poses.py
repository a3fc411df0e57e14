"""Where every moving part of both machines goes: a snapshot as arrays of poses. Pure geometry."""

from __future__ import annotations

from dataclasses import dataclass
from math import atan2, hypot

import numpy as np

from app.snapshot import RobotView
from app.stage import Stage

UNSEEN = 1e-5
MARKER_DEPTHS = (-0.008, -0.0095)
"""y of a marker's two discs [m]: before the path and its control points."""


def waist_angle(bars: np.ndarray, away: tuple[float, float] = (0.0, 1.0)) -> float:
    """Angle of the linkage's plane, which is vertical, about the vertical, [rad].

    Args:
        bars: link 1, link 2 and others, shape (n, 2, 3), [m].
        away: to which side of it the plane's normal (-sin, cos) shall look.
    """
    (ax, ay, az), (bx, by, bz) = (bars[:2, 1] - bars[:2, 0]).tolist()
    x, y = by * az - bz * ay, bz * ax - bx * az  # normal of the plane
    if hypot(x, y) < 1e-9:
        x, y = away
    return atan2(-x, y) if x * away[0] + y * away[1] >= 0.0 else atan2(x, -y)


def bar_quaternions(along: np.ndarray, waist: np.ndarray) -> np.ndarray:
    """Turns the x axis along each bar and keeps the y axis as near as can be to the plane's normal.

    Args:
        along: vectors, shape (n, 3).
        waist: angle of the linkage's plane at each bar, shape (n,), [rad].

    Returns:
        Unit quaternions, scalar first, shape (n, 4).
    """
    c, s = np.cos(waist), np.sin(waist)
    outward = along[:, 0] * c + along[:, 1] * s
    across = along[:, 1] * c - along[:, 0] * s
    pitch = np.arctan2(along[:, 2], outward) / 2
    bend = np.arctan2(across, np.hypot(outward, along[:, 2])) / 2
    cw, sw, cp, sp = np.cos(waist / 2), np.sin(waist / 2), np.cos(pitch), np.sin(pitch)
    cb, sb = np.cos(bend), np.sin(bend)
    w, x, y, z = cw * cp, sw * sp, -cw * sp, sw * cp  # about z by the waist, about -y by the pitch
    return np.column_stack([w * cb - z * sb, x * cb + y * sb, y * cb - x * sb, z * cb + w * sb])


@dataclass(frozen=True, slots=True)
class Poses:
    """Everything that moves, for all robots, in the world.

    Attributes:
        bars: where the link meshes begin, shape (n, 3), [m].
        quaternions: how they are turned, scalar first, shape (n, 4).
        lengths: of the bars, shape (n,), [m].
        parts: for each robot its bearings, pen, two marker discs and extra points, (m, 3), [m].
        turns: how these are turned about the vertical, scalar first, shape (m, 4).
        tips: end-points, shape (k, 3), [m].
        forces: on the end-points, shape (k, 3), [N].
    """

    bars: np.ndarray
    quaternions: np.ndarray
    lengths: np.ndarray
    parts: np.ndarray
    turns: np.ndarray
    tips: np.ndarray
    forces: np.ndarray

    def same(self, other: Poses) -> bool:
        """Whether nobody could see a difference: 10 µm, 10 µN."""
        pairs = ((self.parts, other.parts), (self.bars, other.bars), (self.forces, other.forces))
        return all(float(np.abs(one - two).max()) < UNSEEN for one, two in pairs)

    def is_finite(self) -> bool:
        """Whether all of it can be drawn."""
        sums = (self.bars, self.quaternions, self.parts, self.tips, self.forces)
        return bool(np.isfinite(sum(float(array.sum()) for array in sums)))


class Layout:
    """Turns snapshots of robots with a constant number of parts into poses.

    Links 1 and 3 lie in the back layer, link 2 and the pieces of link 4 in the front one, so that
    none runs through another; bearings span both.

    Args:
        stage: where k robots stand.
        robots: as they are at first.
    """

    def __init__(self, stage: Stage, robots: list[RobotView]) -> None:
        self._bases = stage.origins
        self._away = float(stage.away[0]), float(stage.away[1])
        n_bars = [len(robot.bars) for robot in robots]
        n_parts = [len(robot.joints) + 3 + len(robot.extra_points) for robot in robots]
        self._bar_robot = np.repeat(np.arange(len(robots)), n_bars)
        self._part_robot = np.repeat(np.arange(len(robots)), n_parts)
        back, front, boss, pen = stage.depths
        self._bar_depth = np.concatenate([[back, front, back] + [front] * (n - 3) for n in n_bars])
        across, before = list[float](), list[float]()
        for robot in robots:
            extras = len(robot.extra_points)
            across += [*[boss] * len(robot.joints), pen, *[0.0] * (2 + extras)]
            before += [*[0.0] * (len(robot.joints) + 1), *MARKER_DEPTHS]
            before += [MARKER_DEPTHS[0]] * extras
        self._part_depth, depth = np.array(across), np.array(before)
        self._marks = depth < 0.0  # these face the viewer, however the linkage is turned
        self._before = np.column_stack([np.zeros_like(depth), depth, np.zeros_like(depth)])
        self._turn([0.0] * len(robots))

    def poses(self, robots: list[RobotView]) -> Poses:
        """The poses at one instant."""
        waists = [waist_angle(robot.bars, self._away) for robot in robots]
        if waists != self._waists:
            self._turn(waists)
        bars = np.concatenate([robot.bars for robot in robots])
        begins = bars[:, 0]
        along = bars[:, 1] - begins
        parts: list[np.ndarray] = []
        for robot in robots:
            marker = robot.marker[None]
            parts += [robot.joints, robot.tip[None], marker, marker, robot.extra_points]
        return Poses(
            bars=begins + self._bar_offsets,
            quaternions=bar_quaternions(along, self._bar_waists),
            lengths=np.sqrt((along * along).sum(axis=1)),
            parts=np.concatenate(parts) + self._part_offsets,
            turns=self._turns,
            tips=np.array([robot.tip for robot in robots]) + self._bases,
            forces=np.array([robot.force for robot in robots]),
        )

    def _turn(self, waists: list[float]) -> None:
        """Find what depends on the angles of the linkages' planes alone, [rad]."""
        self._waists, angles = waists, np.array(waists)
        normals = np.stack([-np.sin(angles), np.cos(angles), np.zeros_like(angles)], axis=1)
        self._bar_waists = angles[self._bar_robot]
        half = np.where(self._marks, 0.0, angles[self._part_robot]) / 2
        still = np.zeros_like(half)
        self._turns = np.column_stack([np.cos(half), still, still, np.sin(half)])
        self._bar_offsets = self._offsets(self._bar_robot, self._bar_depth, normals)
        aside = self._offsets(self._part_robot, self._part_depth, normals)
        self._part_offsets = aside + self._before

    def _offsets(self, robot: np.ndarray, depth: np.ndarray, normals: np.ndarray) -> np.ndarray:
        return self._bases[robot] + depth[:, None] * normals[robot]


def trace_segments(trace: np.ndarray, count: int) -> np.ndarray:
    """A trace as exactly `count` segments, shape (count, 2, 3); the missing ones have no length.

    A constant count lets their colours stay as they are. A trace is thinned evenly, never at its
    newest end.
    """
    if len(trace) == 0:
        return np.zeros((count, 2, 3))
    step = max(1, -(-(len(trace) - 1) // count))
    kept = trace[::-1][::step][: count + 1][::-1]
    line = np.concatenate([np.repeat(kept[:1], count + 1 - len(kept), axis=0), kept])
    return np.stack([line[:-1], line[1:]], axis=1)
