"""The fastest speed that the torque limits allow, as a wanted motion along the path."""

from __future__ import annotations

from dataclasses import replace

import casadi as ca
import numpy as np

from onpath.models.arrays import Array
from onpath.models.control.fastest_speed import (
    COEFFICIENTS,
    LEAST,
    fastest_speed,
    square_of_speed,
)
from onpath.models.control.laws.law import PathReference
from onpath.models.control.speed_limit import NO_SPEED_LIMIT
from onpath.models.paths.curves import Curve
from onpath.models.paths.spline_curves import SplineCurve
from onpath.models.systems.parameters import Parameters
from onpath.models.systems.robots import Robot


def speed_plan(robot: Robot, parameters: Parameters, curve: Curve) -> Array:
    """1 and the coefficients of `fastest_speed`; nothing if the torques have no limit.

    On a drawing, too, there is nothing: it has more bends than the plan has coefficients.
    """
    if parameters.torque_limit == 0 or isinstance(curve, SplineCurve):
        return np.zeros(0)
    model, backwards = tuple(robot.model(parameters).tolist()), parameters.speed < 0
    found = fastest_speed(robot, model, curve, parameters.torque_limit, backwards)
    return np.append(1.0, found)


def planned(
    plan: ca.SX, theta: ca.SX, task: PathReference, closed: bool, rate: ca.SX | None = None
) -> PathReference:
    """The task with the fastest speed at θ; without a plan, the task as it is.

        ω = ± sqrt(x(θ)),   ω' = dω/dθ θ',   dω/dθ = x'(θ) / (2 ω),

    in the direction of the wanted speed. On an open path, where x is 0 at the ends, ω is the root
    of x + (0.05 rad/s)², so that a start from an end is possible.

    Args:
        plan: see `speed_plan`.
        theta: the place, [rad].
        task: the wanted motion at the wanted speed.
        closed: whether the path is closed.
        rate: θ', [rad/s]; None: that of the plan, so that ω' = x' / 2.
    """
    inside = theta if closed else ca.fmin(ca.fmax(theta, -np.pi), np.pi)
    x, slope = square_of_speed(plan[1 : 1 + COEFFICIENTS], inside, closed)
    direction, exists = ca.sign(task.speed), plan[0]
    speed = direction * ca.sqrt(ca.fmax(x, 0) + (0 if closed else LEAST**2))
    size = ca.fmax(ca.fabs(speed), LEAST)
    pace = speed if rate is None else rate
    return replace(
        task,
        speed=ca.if_else(exists, speed, task.speed),
        acceleration=ca.if_else(exists, direction * slope / (2 * size) * pace, task.acceleration),
        limit=ca.if_else(exists, NO_SPEED_LIMIT, task.limit),
    )
