"""Computations of a page without a server besides closed loops: geometry, distance, hand, brake.

They are CasADi functions, which `wasm_loop.py` translates, so that such a page contains no
mathematics. Positions in the picture are (right, up), [m], seen from far away.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import lru_cache, partial
from types import MappingProxyType

import casadi as ca
import numpy as np

from onpath.models.arrays import Array
from onpath.models.closed_loop.faults import foreseen, not_finite
from onpath.models.closed_loop.loop_kind import Kind
from onpath.models.errors import Message
from onpath.models.paths.projection import LocalCurve, basis
from onpath.models.systems.parameters import Parameters
from onpath.models.systems.robots import Robot, stop_code, stops_of

GRID = 128
"""Points of the path from which the search for the closest one begins."""
REFINEMENTS = 4
Lift = Callable[[ca.SX, bool], ca.SX]


@lru_cache(maxsize=16)
def page_functions(robot: Robot, kind: Kind) -> Mapping[str, ca.Function]:
    """The functions for a robot on paths of a kind.

    All points y are those of the output space, (p, 1), [m]; `table` is `Curve.table`, `grid` has
    `grid_of` as columns.

        picture: q -> ends of the bars, (2, 2 n), begin and end as columns; joints (2, m)
        tip: q -> y of the actual end-point
        place: y -> its position in the picture, (2, 1)
        arrow: (y, force on it) -> the end of the arrow in the picture
        at: (table, θ) -> y of σ(θ)
        distance: (table, grid, y, guess of θ) -> Euclidean distance to the path, [m], followed by
            the closest point, (1 + p, 1)
        brake: (table, y, θ) -> the unit tangent at θ, (p, 1), see `brake_at`
        fault: (q, v, θ_r) -> 0, or the number of the reason why a run has stopped: its position
            in `stop_reasons`, counted from 1
        hand: (y, from, to) -> y moved in the path's plane as the picture's point moves
    """
    system = robot.system
    q, y = ca.SX.sym("q", system.n), ca.SX.sym("y", system.p)
    seen, offset = view_of(robot)
    bars, joints = robot.skeleton(q, ca.SX(1))
    table, theta = ca.SX.sym("table", *kind.table_shape), ca.SX.sym("theta")
    lift = lift_of(robot, kind)
    place = ca.Function("place", [y], [placed(robot, y, seen) + offset])
    local = LocalCurve.from_values(theta, kind.closed, table @ basis(theta, kind.closed))
    tangent = lift(local.first, True)
    force = ca.SX.sym("force", system.p)
    tip = ca.vec(ca.densify(bars))[-3:]  # in the robot's frame
    functions = {
        "picture": ca.Function("picture", [q], [_dense(seen @ bars), _dense(seen @ joints)]),
        "tip": ca.Function("tip", [q], [_dense(_unplaced(robot, tip))]),
        "place": place,
        "arrow": ca.Function("arrow", [y, force], [place(y + robot.drawing.force_scale * force)]),
        "at": ca.Function("at", [table, theta], [_dense(lift(local.sigma, False))]),
        "distance": _distance(kind, lift, table, y),
        "brake": ca.Function("brake", [table, y, theta], [tangent / _length(tangent)]),
        "fault": _fault(robot),
        "hand": _hand(robot, kind, seen, y),
    }
    return MappingProxyType(functions)


def measurements(robot: Robot, parameters: Parameters) -> dict[str, ca.Function]:
    """For a robot with a flexible link: (q, v) -> its tip's deflection [m], the modes' energy [J],
    and the share of each mode in the deflection [m]."""
    if not robot.extras.keys() >= {"deflection", "internal_energy"}:
        return {}
    system = robot.system
    extras = robot.extras
    measured = ca.vertcat(extras["deflection"], extras["internal_energy"], extras["modes"])
    plant = ca.SX(ca.DM(robot.plant(parameters)))
    values = ca.substitute(measured, system.parameters, plant)
    return {"measured": ca.Function("measured", [system.q, system.v], [_dense(values)])}


def grid_of(robot: Robot, curve_points: Array) -> Array:
    """The argument `grid` of `distance`: points of the path in the output space, (n, p)."""
    return np.ascontiguousarray(robot.frame.lift(curve_points))


def view_of(robot: Robot) -> tuple[ca.DM, ca.DM]:
    """`Robot.seen`, (2, 3), and `place` of y = 0."""
    seen = ca.DM(robot.seen)
    return seen, seen @ ca.DM(robot.position(np.zeros(robot.system.p)))


def front_of(robot: Robot) -> Array:
    """Two directions of the output space, (2, p), that span the plane of the path.

    They have length 1, are at right angles, and look most like right and up in the picture.
    """
    seen = view_of(robot)[0].full() @ robot.axes.T
    home = robot.frame.lift(np.zeros(2))
    plane = np.linalg.qr((robot.frame.lift(np.eye(2)) - home).T)[0]
    left, _, right = np.linalg.svd(seen @ plane)
    return left @ right @ plane.T


def placed(robot: Robot, vector: ca.SX, seen: ca.DM) -> ca.SX:
    """A vector of the output space in the picture."""
    return ca.densify((seen @ ca.DM(robot.axes.T)) @ vector)


def _unplaced(robot: Robot, point: ca.SX) -> ca.SX:
    """`Robot.output_at`."""
    return ca.DM(robot.axes) @ (point - ca.DM(robot.home))


def lift_of(robot: Robot, kind: Kind) -> Lift:
    """The map from the curve's coordinates to the output space; with `rate`, of vectors."""
    frame = robot.frame.space if kind.space and robot.frame.space else robot.frame
    plane, size = frame.at(ca.SX(ca.DM(list(frame.numbers)))), kind.dimension
    zeta = ca.SX.zeros(robot.system.p - size, 1)
    return lambda z, rate: plane.join(z, zeta, rate)


def _distance(kind: Kind, lift: Lift, table: ca.SX, y: ca.SX) -> ca.Function:
    """The smaller of the distances found from the guess and from the grid, and its point."""
    grid, guess = ca.SX.sym("grid", y.numel(), GRID), ca.SX.sym("guess")
    span = 2 * np.pi / (GRID if kind.closed else GRID - 1)
    squared = ca.sum1((grid - y @ ca.DM.ones(1, GRID)) ** 2)
    best, nearest = squared[0], ca.SX(-np.pi)
    for i in range(1, GRID):
        nearest = ca.if_else(squared[i] < best, -np.pi + i * span, nearest)
        best = ca.fmin(best, squared[i])
    improve = partial(_improved, kind, lift, table, y)
    found = [improve(guess), improve(nearest)]
    if not kind.closed:
        found += [_beyond(lift, table, y, end) for end in (-np.pi, np.pi)]
    closest = found[0]
    for other in found[1:]:
        closest = ca.if_else(_length(other - y) < _length(closest - y), other, closest)
    both = ca.vertcat(_length(closest - y), closest)
    return ca.Function("distance", [table, grid, y, guess], ca.cse([both]))


def _beyond(lift: Lift, table: ca.SX, y: ca.SX, end: float) -> ca.SX:
    """The closest point of the half-line by which an open curve continues beyond an end."""
    local = LocalCurve.from_values(ca.SX(end), False, table @ basis(ca.SX(end), False))
    tip, away = lift(local.sigma, False), np.sign(end) * lift(local.first, True)
    return tip + ca.fmax(ca.dot(y - tip, away), 0) / ca.dot(away, away) * away


def _improved(kind: Kind, lift: Lift, table: ca.SX, y: ca.SX, theta: ca.SX) -> ca.SX:
    """The point at a local minimum of the distance near θ.

    Newton's method for (σ - y) · σ' = 0, as in `onpath.models.paths.distance`.
    """
    for _ in range(REFINEMENTS):
        local = LocalCurve.from_values(theta, kind.closed, table @ basis(theta, kind.closed))
        gap, first = lift(local.sigma, False) - y, lift(local.first, True)
        squared = ca.dot(first, first)
        slope = ca.fmax(squared + ca.dot(gap, lift(local.second, True)), 0.2 * squared)
        theta = theta - ca.fmin(ca.fmax(ca.dot(gap, first) / slope, -0.1), 0.1)
    local = LocalCurve.from_values(theta, kind.closed, table @ basis(theta, kind.closed))
    return lift(local.sigma, False)


def _fault(robot: Robot) -> ca.Function:
    """The function "fault": the number of the first reason that applies, as in `fault_in`."""
    q, v, theta_ref = robot.system.q, robot.system.v, ca.SX.sym("theta_ref")
    stop, last = stop_code(robot), len(stops_of(robot)) + 3
    code = ca.if_else(stop, stop, ca.if_else(theta_ref != theta_ref, last, 0))
    return ca.Function("fault", [q, v, theta_ref], [code])


def stop_reasons(robot: Robot, parameters: Parameters, q: Array | None, law: str) -> list[Message]:
    """The reasons why a run may stop, in the order of `fault`.

    Args:
        q: a configuration of the run, or None; see `Robot.reasons`.
    """
    reasons = [*robot.reasons(q, parameters)]
    if q is not None and (causes := foreseen(robot, law, q, parameters)):
        reasons = [Message("stop.because", {"reason": r, "causes": causes}) for r in reasons]
    return [*reasons, not_finite(law)]


def _hand(robot: Robot, kind: Kind, seen: ca.DM, y: ca.SX) -> ca.Function:
    """The function "hand", which moves in the path's plane also on a space curve."""
    frame = robot.frame
    plane, zeta = frame.at(ca.SX(ca.DM(list(frame.numbers)))), ca.SX.zeros(robot.system.p - 2, 1)
    axes = ca.horzcat(*(plane.join(ca.SX(ca.DM(e)), zeta, True) for e in ([1, 0], [0, 1])))
    begin, end = ca.SX.sym("begin", 2), ca.SX.sym("end", 2)
    moved = axes @ (ca.inv(placed(robot, axes, seen)) @ (end - begin))
    return ca.Function("hand", [y, begin, end], [_dense(y + moved)])


def _length(vector: ca.SX) -> ca.SX:
    return ca.sqrt(ca.dot(vector, vector))


def _dense(matrix: ca.SX) -> ca.SX:
    return ca.densify(matrix)
