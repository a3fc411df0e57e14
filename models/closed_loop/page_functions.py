"""Computations of a page without a server besides closed loops: geometry, hand, brake.

They are CasADi functions, which `wasm_loop.py` translates, so that such a page contains no
mathematics. Positions in the picture are (right, up), [m], seen from far away.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import lru_cache
from types import MappingProxyType

import casadi as ca
import numpy as np

from onpath.models.arrays import Array
from onpath.models.closed_loop.faults import foreseen, not_finite
from onpath.models.closed_loop.loop_kind import Kind
from onpath.models.errors import Message
from onpath.models.systems.parameters import Parameters
from onpath.models.systems.robots import Robot, stop_code, stops_of

Lift = Callable[[ca.SX, bool], ca.SX]


@lru_cache(maxsize=16)
def page_functions(robot: Robot, kind: Kind) -> Mapping[str, ca.Function]:
    """The functions for a robot on paths of a kind.

    All points y are those of the output space, (p, 1), [m]; `values` are σ, σ', σ'' and σ''' at a
    θ, as the scan "curve" of models/standalone/curve_scans.py has them.

        picture: q -> ends of the bars, (2, 2 n), begin and end as columns; joints (2, m)
        tip: q -> y of the actual end-point
        place: y -> its position in the picture, (2, 1)
        arrow: (y, force on it) -> the end of the arrow in the picture
        at: values -> y of σ
        brake: values -> the unit tangent, (p, 1), see `brake_at`
        fault: (q, v, θ_r) -> 0, or the number of the reason why a run has stopped: its position
            in `stop_reasons`, counted from 1
        hand: (y, from, to) -> y moved in the path's plane as the picture's point moves
    """
    system = robot.system
    q, y = ca.SX.sym("q", system.n), ca.SX.sym("y", system.p)
    seen, offset = view_of(robot)
    bars, joints = robot.skeleton(q, ca.SX(1))
    values, lift = ca.SX.sym("values", kind.value_rows), lift_of(robot, kind)
    sigma, first, *_ = ca.vertsplit(values, kind.dimension)
    place = ca.Function("place", [y], [placed(robot, y, seen) + offset])
    tangent = lift(first, True)
    force = ca.SX.sym("force", system.p)
    tip = ca.vec(ca.densify(bars))[-3:]  # in the robot's frame
    functions = {
        "picture": ca.Function("picture", [q], [_dense(seen @ bars), _dense(seen @ joints)]),
        "tip": ca.Function("tip", [q], [_dense(_unplaced(robot, tip))]),
        "place": place,
        "arrow": ca.Function("arrow", [y, force], [place(y + robot.drawing.force_scale * force)]),
        "at": ca.Function("at", [values], [_dense(lift(sigma, False))]),
        "brake": ca.Function("brake", [values], [tangent / ca.sqrt(ca.dot(tangent, tangent))]),
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


def _dense(matrix: ca.SX) -> ca.SX:
    return ca.densify(matrix)
