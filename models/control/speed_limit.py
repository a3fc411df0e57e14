"""The speed along a path that the motors can hold everywhere on it."""

from __future__ import annotations

from functools import lru_cache

import casadi as ca
import numpy as np

from onpath.models.arrays import Array
from onpath.models.control.linearization import linearization
from onpath.models.paths.curves import Curve
from onpath.models.systems.robots import Robot
from onpath.models.systems.system import MechanicalSystem

POINTS = 64  # of the path
SHARE = 0.75  # of the torque limit for the motion; the rest is left to the laws
NO_SPEED_LIMIT = 1000.0  # [rad/s], far above any speed that can be asked for, but finite


@lru_cache(maxsize=64)
def speed_limit(
    robot: Robot, model: tuple[float, ...], curve: Curve, torque: float, backwards: bool
) -> float:
    """The largest constant speed ω that takes at most `SHARE` of the torques, [rad/s].

    On the path, with y' = σ' ω and y'' = σ'' ω², the torques are u = a ω² + b ω + c. For each of
    `POINTS` places and each motor, the smallest ω > 0 with |u| = SHARE · torque bounds the speed.

    Args:
        model: the plant's parameters as the controller assumes them, k numbers.
        curve: the path.
        torque: limit of the motors, the value of `torque_limit`.
        backwards: whether θ decreases.

    Returns:
        0 if the robot cannot even rest on the whole path; `NO_SPEED_LIMIT` if nothing bounds the
        speed, or the robot has more coordinates than motors and outputs.
    """
    if not _is_square(robot.system):
        return NO_SPEED_LIMIT
    sign = -1.0 if backwards else 1.0
    ahead, resting, back = (_torques(robot, model, curve, w) for w in (sign, 0.0, -sign))
    a, b = (ahead + back) / 2 - resting, (ahead - back) / 2
    bound = SHARE * torque * np.array(robot.system.strength)[:, None]
    if (np.abs(resting) >= bound).any():
        return 0.0
    roots = [_smallest_root(a, b, resting - level) for level in (bound, -bound)]
    return float(min(NO_SPEED_LIMIT, *(root.min() for root in roots)))


def prepare_speed_limit(robot: Robot) -> None:
    """Build the function of `speed_limit` in advance; it takes tens of milliseconds."""
    if _is_square(robot.system):
        _on_path(robot.system, POINTS)


def _is_square(system: MechanicalSystem) -> bool:
    """Whether there are as many coordinates as motors and outputs."""
    return system.n == system.m == system.p


def _torques(robot: Robot, model: tuple[float, ...], curve: Curve, speed: float) -> Array:
    """Torques on the path at a constant speed [rad/s], shape (m, POINTS), [N m]."""
    theta = np.linspace(-np.pi, np.pi, POINTS, endpoint=not curve.closed)
    rate, second = np.full(POINTS, speed), np.zeros(POINTS)
    return path_torques(robot, model, curve, theta, rate, second)


def path_torques(
    robot: Robot,
    model: tuple[float, ...],
    curve: Curve,
    theta: Array,
    rate: Array,
    second: Array,
) -> Array:
    """Torques of a motion along the path at some places, shape (m, l), [N m].

    With y' = σ' θ' and y'' = σ'' θ'² + σ' θ''.

    Args:
        model: the plant's parameters as the controller assumes them, k numbers.
        theta, rate, second: θ, θ' and θ'' at each place, (l,), [rad], [rad/s], [rad/s²].
    """
    frame, origin = robot.frame, robot.frame.lift(np.zeros(2))
    q = np.stack([robot.rest(frame.lift(z)) for z in curve.at(theta)])
    first = curve.at(theta, 1)
    bent = rate[:, None] ** 2 * curve.at(theta, 2) + second[:, None] * first
    rates, seconds = frame.lift(rate[:, None] * first) - origin, frame.lift(bent) - origin
    repeated = np.repeat(np.array(model)[:, None], len(theta), axis=1)
    return np.array(_on_path(robot.system, len(theta))(q.T, rates.T, seconds.T, repeated))


@lru_cache(maxsize=8)
def _on_path(system: MechanicalSystem, places: int) -> ca.Function:
    """(q, y', y'', model) -> torques, for some places."""
    rate, second = ca.SX.sym("rate", system.p), ca.SX.sym("second", system.p)
    jacobian = ca.jacobian(system.controlled_output, system.q)
    v = ca.inv_minor(jacobian) @ rate
    u = linearization(system, system.q, v, system.parameters, second)
    inputs = [system.q, rate, second, system.parameters]
    return ca.Function("on_path", inputs, [u]).map(places)


def _smallest_root(a: Array, b: Array, c: Array) -> Array:
    """The smallest positive root of a x² + b x + c, infinity where there is none."""
    with np.errstate(divide="ignore", invalid="ignore"):
        disc = np.sqrt(b**2 - 4 * a * c)
        # stable for a near 0: x = 2 c / (-b ± disc)
        roots = np.stack([2 * c / (-b + disc), 2 * c / (-b - disc)])
    return np.where(np.isfinite(roots) & (roots > 0), roots, np.inf).min(0)
