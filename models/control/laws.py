"""The two controllers. Both ask for an acceleration of the output; one linearization gives torques.

Path following knows where the path is and how fast to go along it. Trajectory tracking knows where
a point that runs along the path by the clock is now. Same gains, same linearization, same limits.
"""

from __future__ import annotations

from dataclasses import dataclass

import casadi as ca
import numpy as np

from onpath.models.control.virtual_output import VirtualOutput
from onpath.models.paths.frames import Frame
from onpath.models.paths.projection import LocalCurve, wrap
from onpath.models.systems.system import MechanicalSystem

NAMES = ("trajectory_tracking", "path_following")


@dataclass(frozen=True, slots=True)
class Gains:
    """K1 [1/s^2], K2 [1/s], K3 [1/s^3] across (18); K4 [1/s^2], K5 [1/s] along (19)."""

    k1: ca.SX
    k2: ca.SX
    k3: ca.SX
    k4: ca.SX
    k5: ca.SX


@dataclass(frozen=True, slots=True)
class PathReference:
    """Motion along the path: hold `target` [rad] where `position` is 1, else `speed` [rad/s]."""

    position: ca.SX
    target: ca.SX
    speed: ca.SX


def path_following(
    output: VirtualOutput, closed: bool, gains: Gains, task: PathReference, integral: ca.SX
) -> ca.SX:
    """Commanded y'', (p, 1), [m/s^2].

    Args:
        output: coordinates along and across the path.
        closed: whether the curve is closed.
        integral: integral of xi, (p - 1, 1), [m s].

    Source: eqs. (16), (18), (19).
    """
    transversal = -gains.k1 * output.xi - gains.k2 * output.xi_rate - gains.k3 * integral
    holding = -gains.k4 * wrap(output.theta - task.target, closed) - gains.k5 * output.theta_rate
    reference = task.speed if closed else _fading(output.theta, task.speed, gains.k5)
    moving = -gains.k5 * (output.theta_rate - reference)
    return output.acceleration(ca.if_else(task.position, holding, moving), transversal)


def _fading(theta: ca.SX, speed: ca.SX, k5: ca.SX) -> ca.SX:
    """The speed reference on an open curve: it fades out at the ends, critically damped."""
    pull = k5 / 4
    return ca.fmin(ca.fmax(speed, pull * (-np.pi - theta)), pull * (np.pi - theta))


def reference_rate(theta_ref: ca.SX, closed: bool, task: PathReference, dt: ca.SX) -> ca.SX:
    """Speed of the tracker's reference point, by the clock alone, [rad/s].

    With the position task it runs to the target at |speed| and stays; on an open curve it stops
    at the end.
    """
    limit = ca.fabs(task.speed)
    to_target = wrap(task.target - theta_ref, closed) / dt
    homing = ca.fmin(ca.fmax(to_target, -limit), limit)
    moving = task.speed
    if not closed:
        back, ahead = (-np.pi - theta_ref) / dt, (np.pi - theta_ref) / dt
        moving = ca.fmin(ca.fmax(moving, back), ahead)
    return ca.if_else(task.position, homing, moving)


def tracking_error(
    reference: LocalCurve, frame: Frame, y: ca.SX, y_rate: ca.SX, rate: ca.SX
) -> tuple[ca.SX, ca.SX, ca.SX]:
    """(e, e', y_r'') against the reference point moving at `rate` [rad/s], each (p, 1)."""
    none = ca.SX.zeros(frame.p - 2, 1)
    error = y - frame.join(reference.sigma, none)
    error_rate = y_rate - frame.join(reference.first * rate, none, rate=True)
    return error, error_rate, frame.join(reference.second * rate**2, none, rate=True)


def trajectory_tracking(
    error: ca.SX, error_rate: ca.SX, feedforward: ca.SX, gains: Gains, integral: ca.SX
) -> ca.SX:
    """Commanded y'' = y_r'' - K2 e' - K1 e - K3 integral(e), (p, 1), [m/s^2]."""
    return feedforward - gains.k2 * error_rate - gains.k1 * error - gains.k3 * integral


def linearization(
    system: MechanicalSystem, q: ca.SX, v: ca.SX, model: ca.SX, acceleration: ca.SX
) -> ca.SX:
    """Inputs that give the controlled output the commanded acceleration, if the model is right.

    y'' = J (f_v + g_v u) + J' v, solved for u; with as many inputs as coordinates and outputs that
    is u = M J^-1 (y'' - J' v) + c.

    Args:
        model: the controller's idea of the plant's parameters, (k, 1).
        acceleration: commanded y'', (p, 1), [m/s^2].

    Source: eq. (16).
    """
    jacobian = ca.jacobian(system.controlled_output, system.q)
    turning = ca.jtimes(jacobian @ system.v, system.q, system.v)
    wanted = ca.SX.sym("wanted", system.p)
    if system.n == system.m == system.p:
        u = system.mass @ _solve(jacobian, wanted - turning) + system.bias
    else:
        gain = ca.densify(jacobian @ system.input_gain)
        u = _solve(gain, wanted - jacobian @ system.drift - turning)
    inputs = [system.q, system.v, system.parameters, wanted]
    return ca.Function("linearization", inputs, [u])(q, v, model, acceleration)


def _solve(matrix: ca.SX, rhs: ca.SX) -> ca.SX:
    """A^-1 r of a small dense matrix by its adjugate: one division."""
    return (1 / ca.det(matrix)) * (ca.adj(matrix) @ rhs)
