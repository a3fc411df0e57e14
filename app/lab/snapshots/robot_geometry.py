"""Geometry of both robots at one instant: from the state to the pose of every part.

The geometry is a CasADi function, made once per robot; for so few numbers, NumPy would take ten
times as long. Points are columns in the function, and rows of the arrays outside. Everything is in
the robot's own frame (x right, y away, z up); the scene places the robots.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from functools import lru_cache
from math import floor, isfinite, pi
from typing import Any, NamedTuple

import casadi as ca
import numpy as np

from onpath.app.common.per_thread import per_thread
from onpath.app.lab.closed_loop_run import ClosedLoopRun
from onpath.app.lab.plot_samples import sample_layout
from onpath.app.lab.segments import Instant
from onpath.app.lab.snapshots.part_poses import MARKER_DEPTHS, bar_quaternions, waist_angle
from onpath.app.lab.snapshots.snapshot import END, Counts, RobotSnapshot
from onpath.models.arrays import Array
from onpath.models.closed_loop.buffered import Buffered
from onpath.models.closed_loop.loop_vectors import log_layout
from onpath.models.control.laws.registry import law_named
from onpath.models.control.sides import SIDES
from onpath.models.paths.curves import ORDERS, PERIOD, TERMS, Curve
from onpath.models.paths.projection import LocalCurve, basis
from onpath.models.paths.spline_curves import WINDOW, SplineCurve, piece_basis
from onpath.models.systems.rigid_chain import frame_poses
from onpath.models.systems.robots import Robot

UNTRACED = np.zeros((0, len(SIDES), 3))


def robot_snapshots(
    robot: Robot,
    curve: Curve,
    instant: Instant,
    traces: Array | None = None,
    exaggeration: float = 1.0,
) -> dict[str, RobotSnapshot]:
    """Both robots at one instant.

    Args:
        traces: recent positions of their end-points, shape (n, robots, p), [m].
        exaggeration: magnification of the deflection of the bars and the drawn end-point.
    """
    drawn, counts = drawn_robots(robot, curve, instant, exaggeration)
    middle = 3 * counts.points
    points = drawn[:, :middle].reshape(len(SIDES), -1, 3)
    trails = UNTRACED
    if traces is not None:
        trails = np.concatenate([robot.position(traces), points[None, :, END]])
    sample, slices = instant.sample, sample_layout(robot).slices
    names = ("speed", "distance", "far", "integral_used")
    speeds, distances, far, used = (sample[:, slices[name].start].tolist() for name in names)
    bent = slices.get("deflection")
    return {
        side: RobotSnapshot(
            law=instant.laws[i],
            points=points[i],
            poses=drawn[i, middle:],
            counts=counts,
            trace=trails[:, i],
            distance=distances[i],
            max_distance=instant.max_distances[i],
            speed=speeds[i],
            torque=sample[i, slices["u"]],
            far=far[i],
            integral_used=used[i],
            deflection=np.nan if bent is None else float(sample[i, bent.start]),
        )
        for i, side in enumerate(SIDES)
    }


def drawn_robots(
    robot: Robot, curve: Curve, instant: Instant, exaggeration: float = 1.0
) -> tuple[Array, Counts]:
    """`Motion.drawn` of both robots at one instant, and their numbers of parts."""
    geometry = _geometry_of(robot.core, type(curve), curve.closed, curve.dimension)
    return geometry(robot, instant, curve, exaggeration), geometry.counts


def drawn_now(
    robot: Robot, runs: Iterable[ClosedLoopRun], curve: Curve, table: Array, exaggeration: float
) -> tuple[Array, Counts]:
    """`drawn_robots` of the present instant, without making an `Instant`.

    Args:
        table: `Curve.table()` of the path.
    """
    geometry = _geometry_of(robot.core, type(curve), curve.closed, curve.dimension)
    return geometry.of_runs(robot, runs, curve, table, exaggeration), geometry.counts


class RobotGeometry:
    """The geometry of robots with one `core` on one kind of path. Not thread-safe.

    Attributes:
        counts: numbers of parts.
    """

    def __init__(self, robot: Robot, made: type[Curve], closed: bool, dimension: int) -> None:
        spline = issubclass(made, SplineCurve)
        function, self.counts = geometry_function(robot, closed, dimension, spline)
        self._draw = Buffered(function)
        self._joints, self._core, self._dimension = robot.system.n, robot, dimension

    def __call__(self, robot: Robot, instant: Instant, curve: Curve, exaggeration: float) -> Array:
        """`Motion.drawn` of an instant."""
        q = [state[: self._joints] for state in instant.states]
        seen = instant.sample.take(_seen(self._core, instant.laws))
        return self._drawn(robot, q, [seen], curve, curve.table(), exaggeration)

    def of_runs(
        self,
        robot: Robot,
        runs: Iterable[ClosedLoopRun],
        curve: Curve,
        table: Array,
        exaggeration: float,
    ) -> Array:
        """`Motion.drawn` of the present states of two runs; see `drawn_now`."""
        q, seen = list[Array](), list[Array]()
        for run in runs:
            states, i = run.slot
            record = states.records[i]
            q.append(record[: self._joints])
            seen.append(record[states.size :].take(_logged(self._core, run.law)))
        return self._drawn(robot, q, seen, curve, table, exaggeration)

    def _drawn(
        self,
        robot: Robot,
        q: Sequence[Array],
        seen: Sequence[Array],
        curve: Curve,
        table: Array,
        exaggeration: float,
    ) -> Array:
        values = np.concatenate(seen)
        if isinstance(curve, SplineCurve):
            table = pieces_at(curve, values.reshape(len(SIDES), -1)[:, -1].tolist())
        inputs = np.concatenate(q), values, table, exaggeration
        drawn = self._draw(*inputs, path_place(robot, self._dimension))[0]
        return drawn.reshape(len(SIDES), -1).copy()


def pieces_at(curve: SplineCurve, aims: Sequence[float]) -> Array:
    """For each aim, [rad]: where in its piece it is, how many pieces it is beyond an end, and the
    piece's control points, flat."""
    found = list[Any]()
    for aim in aims:
        theta = aim if isfinite(aim) else 0.0
        inner = theta - PERIOD * floor(theta / PERIOD + 0.5) if curve.closed else theta
        whole = (inner + pi) * curve.pieces / PERIOD
        within = min(max(whole, 0.0), float(curve.pieces))
        piece = min(int(within), curve.pieces - 1)
        found += [[within - piece, whole - within], curve.points[piece : piece + WINDOW].ravel()]
    return np.concatenate(found)


@per_thread
def _geometry_of(robot: Robot, made: type[Curve], closed: bool, dimension: int) -> RobotGeometry:
    return RobotGeometry(robot, made, closed, dimension)


@lru_cache(maxsize=256)
def _logged(robot: Robot, law: str) -> np.ndarray:
    """Indices of a robot's end-point, force and aim in its log row."""
    slices = log_layout(robot.system).slices
    fields = [slices[name] for name in ("y", "force", law_named(law).aim)]
    return np.concatenate([np.arange(field.start, field.stop) for field in fields])


@lru_cache(maxsize=256)
def _seen(robot: Robot, laws: tuple[str, ...]) -> np.ndarray:
    """Indices of both robots' end-points, forces and aims in a flat sample."""
    layout = sample_layout(robot)
    indices = list[int]()
    for i, law in enumerate(laws):
        for field in ("y", "force", law_named(law).aim):
            span = layout.slices[field]
            indices.extend(range(i * layout.size + span.start, i * layout.size + span.stop))
    return np.array(indices)


class _Points(NamedTuple):
    """One robot's `RobotSnapshot.points` in their order, as columns of symbols.

    Attributes:
        bars: beginnings and ends of the bars, in turn.
    """

    bars: ca.SX
    joints: ca.SX
    marks: ca.SX
    marker: ca.SX
    tip: ca.SX
    end: ca.SX
    force: ca.SX


@lru_cache(maxsize=64)
def geometry_function(
    robot: Robot, closed: bool, dimension: int = 2, spline: bool = False
) -> tuple[ca.Function, Counts]:
    """Make the function from the state to points and poses of both robots.

    Args:
        closed, dimension: of the path.
        spline: whether it consists of pieces.

    Returns:
        (q, (n, 2); y, force and aim, (2 p + 1, 2); table of the curve, or `pieces_at` of the aims;
        exaggeration; `path_place`) -> one column per robot: `RobotSnapshot.points`, then
        `RobotSnapshot.poses`.
    """
    p, both = robot.system.p, len(SIDES)
    q, seen = ca.SX.sym("q", robot.system.n, both), ca.SX.sym("seen", 2 * p + 1, both)
    shape = (2 + dimension * WINDOW, both) if spline else (dimension * ORDERS, TERMS)
    table = ca.SX.sym("table", *shape)
    tables = ca.horzsplit(table) if spline else [table] * both
    exaggeration = ca.SX.sym("exaggeration")
    placed, path = _affine(robot.position, p), ca.SX.sym("path", 3, dimension + 1)

    def drawn(q: ca.SX, seen: ca.SX, table: ca.SX) -> _Points:
        y, force, aim = seen[:p], seen[p : 2 * p], seen[2 * p]
        bars, joints = robot.skeleton(q, exaggeration)
        if spline:
            value, slope, *_ = (ca.vertcat(*row) for row in piece_basis(table[0], 1.0))
            sigma = ca.reshape(table[2:], dimension, WINDOW) @ (value + table[1] * slope)
        else:
            sigma = LocalCurve.from_values(aim, closed, table @ basis(aim, closed)).sigma
        pull = placed(force) - placed(ca.SX(p, 1))
        straight = robot.skeleton(q, ca.SX(0))[0][:, -1]
        marks = straight if ca.depends_on(bars, exaggeration) else ca.SX(3, 0)  # of a bent link
        return _Points(
            bars=bars,
            joints=joints,
            marks=marks,
            marker=path[:, 0] + path[:, 1:] @ sigma,
            tip=bars[:, -1],
            end=placed(y),
            force=pull,
        )

    robots = list(map(drawn, ca.horzsplit(q), ca.horzsplit(seen), tables))
    first = robots[0]
    counts = Counts(
        bars=first.bars.shape[1] // 2,
        joints=first.joints.shape[1],
        marks=first.marks.shape[1],
        strip=robot.drawing.strip,
        bodies=0 if robot.chain is None else robot.chain.n,
    )
    columns = [
        ca.vertcat(*[ca.vec(part) for part in (*points, *_poses(robot, counts, points, q_of))])
        for points, q_of in zip(robots, ca.horzsplit(q), strict=True)
    ]
    flat = ca.densify(ca.horzcat(*columns))
    inputs = [q, seen, table, exaggeration, path]
    return ca.Function("geometry", inputs, ca.cse([flat])), counts


@lru_cache(maxsize=64)
def path_place(robot: Robot, dimension: int) -> Array:
    """How the plane of the path lies in the robot's frame: origin and axes, flat, by columns."""
    origin, *ends = robot.position(robot.frame.lift(np.eye(dimension + 1, dimension, -1)))
    return np.concatenate([origin, *(end - origin for end in ends)])


def straight_tip(robot: Robot) -> Callable[[Array], Array] | None:
    """Where the end-point would be if no link were bent: q -> y, (n,) -> (p,).

    None if no link of the robot bends.
    """
    return _straight_tip(robot.core)


@per_thread
def _straight_tip(robot: Robot) -> Callable[[Array], Array] | None:
    """`straight_tip` of all robots with one `core`."""
    q, exaggeration = ca.SX.sym("q", robot.system.n), ca.SX.sym("exaggeration")
    if not ca.depends_on(robot.skeleton(q, exaggeration)[0], exaggeration):
        return None
    end = robot.skeleton(q, ca.SX(0))[0][:, -1]
    y = ca.DM(robot.axes) @ (end - ca.DM(robot.home))
    evaluate = Buffered(ca.Function("straight", [q], [ca.densify(y)]))
    return lambda joints: evaluate(joints)[0].copy()


def _poses(robot: Robot, counts: Counts, points: _Points, q: ca.SX) -> tuple[ca.SX, ...]:
    """One robot's `RobotSnapshot.poses`, as columns.

    Links alternate between the back and the front layer, pieces of a strip are in the front
    layer, so that no link intersects another; bearings span both.
    """
    drawing, depths = robot.drawing, robot.drawing.depths
    bodies = ca.SX(3, 0), ca.SX(4, 0)
    if robot.chain is None:
        waist = waist_angle(points.bars, drawing.away)
    else:
        waist, bodies = ca.SX(0), frame_poses(robot.chain, q)
    normal = ca.vertcat(-ca.sin(waist), ca.cos(waist), 0)
    begins, ends = points.bars[:, ::2], points.bars[:, 1::2]
    if counts.marks:  # the strip if it were straight
        begins = ca.horzcat(begins, begins[:, counts.links])
        ends = ca.horzcat(ends, points.marks)
    along = ends - begins
    behind = [*counts.behind, *[False] * counts.marks]
    layers = ca.DM([depths.back if back else depths.front for back in behind]).T
    turned = ca.vertcat(ca.cos(waist / 2), 0, 0, ca.sin(waist / 2))
    still = ca.DM([1, 0, 0, 0])  # these face the viewer at any orientation of the linkage
    discs = [points.marker + ca.DM([0, depth, 0]) for depth in MARKER_DEPTHS]
    further = points.marks + ca.DM([0, MARKER_DEPTHS[0], 0]) @ ca.DM.ones(1, counts.marks)
    bosses = points.joints + depths.boss * (normal @ ca.DM.ones(1, counts.joints))
    pen = points.tip + depths.pen * normal
    return (
        begins + normal @ layers,
        bar_quaternions(along, waist),
        ca.horzcat(bosses, pen, *discs, further),
        points.tip,
        *bodies,
        ca.sqrt(ca.sum1(along**2)),
        ca.horzcat(*[turned] * (counts.joints + 1), *[still] * (2 + counts.marks)),
        points.force,
    )


def _affine(place: Callable[[Array], Array], size: int) -> Callable[[ca.SX], ca.SX]:
    """Extend an affine map of points, (n, size) -> (n, 3), to symbols, (size, 1) -> (3, 1)."""
    origin, *ends = place(np.vstack([np.zeros(size), np.eye(size)]))
    matrix, offset = ca.DM(np.stack(ends, axis=1) - origin[:, None]), ca.DM(origin)
    return lambda point: matrix @ point + offset
