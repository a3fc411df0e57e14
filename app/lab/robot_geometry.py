"""Both robots as they are drawn at one instant.

The geometry is a function of CasADi, made once for a robot: numpy would take ten times as long for
as few numbers as these. Points are columns in it, and rows of the arrays around it.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache

import casadi as ca
import numpy as np

from onpath.app.common.per_thread import per_thread
from onpath.app.lab.plot_samples import sample_layout
from onpath.app.lab.segments import Instant
from onpath.app.lab.snapshot import END, Counts, FollowerName, RobotView, TrackerName
from onpath.models.arrays import Array
from onpath.models.closed_loop.buffered import Buffered
from onpath.models.control.laws import NAMES
from onpath.models.paths.curves import TABLE_SHAPE, Curve
from onpath.models.paths.projection import LocalCurve, basis
from onpath.models.systems.robots import Robot

AIMS = {TrackerName: "theta_ref", FollowerName: "theta"}
"""Where on the path each controller aims."""
UNTRACED = np.zeros((0, len(NAMES), 3))


def robot_views(
    robot: Robot,
    curve: Curve,
    instant: Instant,
    traces: Array | None = None,
    exaggeration: float = 1.0,
) -> dict[str, RobotView]:
    """Both robots at one instant.

    Args:
        traces: their end-points lately, shape (n, robots, p), [m].
        exaggeration: of a deflection, in the bars and the drawn end-point.
    """
    figure = _figure(robot, curve.closed)
    points = figure.points(instant, curve, exaggeration)
    trails = UNTRACED
    if traces is not None:
        trails = np.concatenate([robot.place(traces), points[None, :, END]])
    sample, slices = instant.sample, sample_layout(robot).slices
    speeds, distances = (sample[:, slices[name].start].tolist() for name in ("speed", "distance"))
    bent = slices.get("deflection")
    return {
        name: RobotView(
            points=points[i],
            counts=figure.counts,
            trace=trails[:, i],
            distance=distances[i],
            max_distance=instant.max_distances[i],
            speed=speeds[i],
            torque=sample[i, slices["u"]],
            deflection=np.nan if bent is None else float(sample[i, bent.start]),
        )
        for i, name in enumerate(NAMES)
    }


class _Figure:
    """The drawing of one kind of robot on open or on closed paths. One thread at a time."""

    def __init__(self, robot: Robot, closed: bool) -> None:
        function, self.counts = _geometry(robot, closed)
        self._draw = Buffered(function)
        self._joints = robot.system.n
        self._seen = np.array(_seen(robot))

    def points(self, instant: Instant, curve: Curve, exaggeration: float) -> Array:
        """As `RobotView.points`, shape (robots, n, 3)."""
        q = [state[: self._joints] for state in instant.states]
        seen = instant.sample.take(self._seen)
        (flat,) = self._draw(np.concatenate(q), seen, curve.table(), exaggeration)
        return flat.reshape(len(NAMES), -1, 3).copy()


@per_thread
def _figure(robot: Robot, closed: bool) -> _Figure:
    return _Figure(robot, closed)


def _seen(robot: Robot) -> list[int]:
    """Where both robots' end-points, forces and aims lie in a flat sample."""
    layout = sample_layout(robot)
    found = list[int]()
    for i, name in enumerate(NAMES):
        for field in ("y", "force", AIMS[name]):
            place = layout.slices[field]
            found.extend(range(i * layout.size + place.start, i * layout.size + place.stop))
    return found


@lru_cache(maxsize=16)
def _geometry(robot: Robot, closed: bool) -> tuple[ca.Function, Counts]:
    """(q of both robots; end-point, force and aim of both; table of the curve; exaggeration) ->
    points of both robots as columns."""
    p, both = robot.system.p, len(NAMES)
    q, seen = ca.SX.sym("q", robot.system.n, both), ca.SX.sym("seen", 2 * p + 1, both)
    table, exaggeration = ca.SX.sym("table", *TABLE_SHAPE), ca.SX.sym("exaggeration")
    placed = _affine(robot.place, p)
    on_path = _affine(lambda z: robot.place(robot.frame.lift(z)), 2)

    def drawn(q: ca.SX, seen: ca.SX) -> list[ca.SX]:
        y, force, aim = seen[:p], seen[p : 2 * p], seen[2 * p]
        bars, joints = robot.skeleton(q, exaggeration)
        sigma = LocalCurve.from_values(aim, closed, table @ basis(aim, closed)).sigma
        pull = placed(force) - placed(ca.SX(p, 1))
        return [bars, joints, robot.marks(q), on_path(sigma), bars[:, -1], placed(y), pull]

    each = [drawn(*columns) for columns in zip(ca.horzsplit(q), ca.horzsplit(seen), strict=True)]
    bars, joints, marks = (part.shape[1] for part in each[0][:3])
    points = ca.densify(ca.horzcat(*[part for parts in each for part in parts]))
    function = ca.Function("figure", [q, seen, table, exaggeration], ca.cse([points]))
    return function, Counts(bars // 2, joints, marks)


def _affine(place: Callable[[Array], Array], size: int) -> Callable[[ca.SX], ca.SX]:
    """An affine map of points, (n, size) -> (n, 3), for symbols, (size, 1) -> (3, 1)."""
    origin, *ends = place(np.vstack([np.zeros(size), np.eye(size)]))
    matrix, offset = ca.DM(np.stack(ends, axis=1) - origin[:, None]), ca.DM(origin)
    return lambda point: matrix @ point + offset
