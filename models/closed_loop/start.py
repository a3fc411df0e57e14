"""The initial state of a run: position, velocity, and lead of the reference point."""

from __future__ import annotations

from dataclasses import astuple, dataclass, fields, replace
from functools import lru_cache

import casadi as ca
import numpy as np

from onpath.models.arrays import Array
from onpath.models.closed_loop.loop_vectors import LoopLayouts
from onpath.models.closed_loop.simulation import MOST_STARTS, first_state
from onpath.models.errors import CodedError
from onpath.models.paths.curves import PERIOD, Curve
from onpath.models.paths.distance import closest_parameter
from onpath.models.paths.path_checks import LEAST_MARGIN
from onpath.models.systems.parameter_specs import out_of_range
from onpath.models.systems.parameters import Parameters
from onpath.models.systems.robots import Robot

BOUNDS = {"theta": np.pi, "beside": 0.2, "along": 2.0, "across": 2.0, "clock_offset": np.pi}
"""Largest absolute value of each number of a start, SI."""
NEAR = 5e-5  # [m] along the path, from a place to what the global search finds on its strand


@dataclass(frozen=True, slots=True)
class Start:
    """The start of a run, relative to the path.

    Attributes:
        theta: parameter of a point of the path, [rad].
        beside: distance of the end-point from that point along the normal, positive to the left of
            the path, [m].
        along, across: velocity of the end-point along the path's tangent, and along its normal to
            the left, [m/s].
        clock_offset: how far the reference point of a law with a clock is ahead of the closest
            point, [rad].

    Raises:
        CodedError: a number is out of range or not finite.
    """

    theta: float = 0.0
    beside: float = 0.0
    along: float = 0.0
    across: float = 0.0
    clock_offset: float = 0.0

    def __post_init__(self) -> None:
        for field, value in zip(fields(self), astuple(self), strict=True):
            most = BOUNDS[field.name]
            if not -most <= value <= most:  # NaN fails too
                raise out_of_range(field.name, f"{value:g}", f"{-most:g}", f"{most:g}")

    def place(self, curve: Curve) -> Array:
        """The starting point in the path's plane or in space, (2,) or (3,), [m]."""
        here = curve.at(np.array(self.theta))
        return here + self.beside * left_of(curve, self.theta) if self.beside else here


ON_PATH = Start()
"""On the path where runs begin, which is at θ = 0 unless it is a drawing, at rest."""


def left_of(curve: Curve, theta: float) -> Array:
    """The unit normal to the left of a path, level if it is a space curve, (2,) or (3,)."""
    first = curve.at(np.array(theta), 1)
    plan = first[:2] / np.linalg.norm(first[:2])
    return np.array([-plan[1], plan[0], 0.0])[: len(first)]


def nearest_start(curve: Curve, z: Array, start: Start = ON_PATH) -> Start:
    """The start nearest to a point z of the path's plane, shape (2,).

    Args:
        start: its velocity and clock offset are kept.
    """
    theta = float(curve.plan.nearest(z[None])[0][0])
    theta = float(
        np.clip((theta + np.pi) % (2 * np.pi) - np.pi if curve.closed else theta, -np.pi, np.pi)
    )
    beside = float((z - curve.at(np.array(theta))[:2]) @ left_of(curve, theta)[:2])
    beside = float(np.clip(beside, -BOUNDS["beside"], BOUNDS["beside"]))
    return replace(start, theta=theta, beside=beside)


def velocity_at(
    robot: Robot,
    parameters: Parameters,
    curve: Curve,
    q: Array,
    along: float,
    across: float,
    theta: float | None = None,
) -> Array:
    """Joint velocities for a velocity of the end-point relative to the path, shape (n,).

    Coordinates without a motor are at rest: v = B w.

    Args:
        q: configuration, shape (n,).
        along, across: velocity along the tangent, and along the normal to the left, at the closest
            point, [m/s].
        theta: of the closest point, [rad]; None: found by global search.
    """
    v = np.zeros_like(q)
    if along == 0 == across:
        return v
    frame = robot.frame
    if theta is None:
        theta = closest_parameter(frame, curve, robot.endpoint(q))
    first = curve.at(np.array(theta), 1)
    rate = along * (first / np.linalg.norm(first)) + across * left_of(curve, theta)
    return driven_rates(robot, parameters, q, frame.lift(rate) - frame.lift(np.zeros(2)))


def driven_rates(robot: Robot, parameters: Parameters, q: Array, y_rate: Array) -> Array:
    """Joint velocities v = B w for a velocity of the end-point, (p,) -> (n,).

    Coordinates without a motor are at rest.

    Args:
        q: configuration, shape (n,).
    """
    jacobian, actuation = _matrices(robot)(q, robot.plant(parameters))
    drives = np.array(actuation)
    inputs = np.linalg.lstsq(np.array(jacobian) @ drives, y_rate, rcond=None)[0]
    return np.asarray(drives @ inputs, dtype=float)


@lru_cache(maxsize=64)
def _matrices(robot: Robot) -> ca.Function:
    """The function (q, parameters) -> dh/dq, (p, n), and B, (n, m)."""
    system = robot.system
    matrices = ca.densify(ca.jacobian(system.output, system.q)), ca.densify(system.actuation)
    return ca.Function("matrices", [system.q, system.parameters], matrices)


def lead(state: Array, layouts: LoopLayouts, curve: Curve, offset: float) -> Array:
    """Move a first state's reference point ahead by an offset, [rad], at most to a path's end."""
    theta_ref = layouts.state.unpack(state)["theta_ref"]
    theta_ref += offset
    if not curve.closed:
        np.clip(theta_ref, -np.pi, np.pi, out=theta_ref)
    return state


def start_state(
    robot: Robot, layouts: LoopLayouts, curve: Curve, parameters: Parameters, start: Start
) -> Array:
    """The first state of a run, shape (layouts.state.size,).

    Raises:
        ValueError: the start is out of reach.
    """
    return _started(robot, layouts, curve, parameters, start).copy()


@lru_cache(maxsize=MOST_STARTS)
def _started(
    robot: Robot, layouts: LoopLayouts, curve: Curve, parameters: Parameters, start: Start
) -> Array:
    """`start_state`, computed once for the labs of a class."""
    start = _begun(start, curve)
    q, v, theta = _motion(robot, curve, parameters, start)
    state = first_state(robot, layouts, curve, q, v)
    if theta is not None:
        fields = layouts.state.unpack(state)
        fields["theta"][:] = fields["theta_ref"][:] = theta
    return lead(state, layouts, curve, start.clock_offset)


def _begun(start: Start, curve: Curve) -> Start:
    """A start, with the place where runs on a path begin for `ON_PATH`."""
    return replace(start, theta=curve.begin) if start == ON_PATH else start


@lru_cache(maxsize=MOST_STARTS)
def check_start(robot: Robot, curve: Curve, parameters: Parameters, start: Start) -> None:
    """Refuse a start that is out of reach, near a singular configuration, or too fast.

    Raises:
        CodedError: it is one of these.
    """
    z = start.place(curve)
    if not robot.margin(z[None])[0] >= LEAST_MARGIN:
        raise CodedError("error.start_out_of_reach")
    q, v, _ = _motion(robot, curve, parameters, start)
    fault = robot.fault(q[None], v[None], parameters)
    if fault is not None:
        raise CodedError("error.start_not_possible", reason=fault[1])


def _motion(
    robot: Robot, curve: Curve, parameters: Parameters, start: Start
) -> tuple[Array, Array, float | None]:
    """Configuration and velocity of a start, each shape (n,), and θ as in `_on_strand`."""
    q = robot.rest(robot.frame.lift(start.place(curve)))
    theta = _on_strand(robot, curve, start, q)
    v = velocity_at(robot, parameters, curve, q, start.along, start.across, theta)
    return q, v, theta


def _on_strand(robot: Robot, curve: Curve, start: Start, q: Array) -> float | None:
    """θ of a start on the path, if the global search would find another strand; else None."""
    if start.beside:
        return None
    found = closest_parameter(robot.frame, curve, robot.endpoint(q))
    turns = round((found - start.theta) / PERIOD) if curve.closed else 0
    away = curve.length_between(found - turns * PERIOD, start.theta)
    return start.theta if away > NEAR else None
