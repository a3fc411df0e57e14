"""The two control laws command an output acceleration y''; `linearization` turns it into torques.

Path following (16)-(19) regulates the distance to the path and the speed along it; it knows no
clock. Trajectory tracking regulates the error to a reference point that moves along the path by the
clock. Both have the same gains, the same linearization and the same torque limits.
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
    """The gains of the control laws.

    Attributes:
        k1, k2, k3: proportional [1/s²], derivative [1/s] and integral [1/s³] gain: of the
            transversal law (18), and of the tracking error.
        k4, k5: position [1/s²] and speed gain [1/s] of the tangential law (19).
    """

    k1: ca.SX
    k2: ca.SX
    k3: ca.SX
    k4: ca.SX
    k5: ca.SX


@dataclass(frozen=True, slots=True)
class PathReference:
    """The wanted motion along the path.

    Attributes:
        position: 1 to hold the position θ_ref, 0 to hold the speed ω_ref.
        target: θ_ref, [rad].
        speed: ω_ref, [rad/s].
    """

    position: ca.SX
    target: ca.SX
    speed: ca.SX


def path_following(
    output: VirtualOutput, closed: bool, gains: Gains, task: PathReference, integral: ca.SX
) -> ca.SX:
    """Commanded y'' of path following, (p, 1), [m/s²].

        v_perp = -K1 λ - K2 λ' - K3 ∫λ dt                     (18)
        v_par  = -K4 (θ - θ_ref) - K5 θ'    (position task)   (19)
        v_par  = -K5 (θ' - ω_ref)           (speed task)      (19) with K4 = 0

    λ = ξ_1 is `output.xi`. θ - θ_ref is taken modulo 2π on a closed curve. On an open curve ω_ref
    is reduced near the ends. `VirtualOutput.acceleration` turns (v_par, v_perp) into y''.

    Args:
        output: coordinates along and across the path.
        closed: whether the curve is closed.
        gains: K1 to K5.
        task: the wanted motion along the path.
        integral: ∫λ dt, (p - 1, 1), [m s].

    Source: eqs. (16), (18), (19).
    """
    transversal = -gains.k1 * output.xi - gains.k2 * output.xi_rate - gains.k3 * integral
    holding = -gains.k4 * wrap(output.theta - task.target, closed) - gains.k5 * output.theta_rate
    reference = task.speed if closed else _fading(output.theta, task.speed, gains.k5)
    moving = -gains.k5 * (output.theta_rate - reference)
    return output.acceleration(ca.if_else(task.position, holding, moving), transversal)


def _fading(theta: ca.SX, speed: ca.SX, k5: ca.SX) -> ca.SX:
    """The speed reference on an open curve, which goes to 0 at both ends, [rad/s].

        ω_ref = clip(speed, K5/4 (-π - θ), K5/4 (π - θ))

    Near the end (19) becomes θ'' = -K5 θ' - K5²/4 (θ - π), which is critically damped.
    """
    pull = k5 / 4
    return ca.fmin(ca.fmax(speed, pull * (-np.pi - theta)), pull * (np.pi - theta))


def reference_rate(theta_ref: ca.SX, closed: bool, task: PathReference, dt: ca.SX) -> ca.SX:
    """Speed ω of the reference point of trajectory tracking, [rad/s].

        position task:  ω = clip(wrap(θ_target - θ_r) / dt, -|speed|, |speed|)
        speed task:     ω = speed

    In the position task the point stops at the target after at most one tick of rounding. On an
    open curve it stops at the end. No measured quantity enters: the reference does not wait for the
    robot.

    Args:
        theta_ref: θ_r, [rad].
        closed: whether the curve is closed.
        task: the wanted motion along the path.
        dt: length of a tick, [s].
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
    """(e, e', y_r'') for the reference point y_r = σ(θ_r), each (p, 1), [m], [m/s], [m/s²].

        e = y - σ(θ_r),   e' = y' - σ'(θ_r) ω,   y_r'' = σ''(θ_r) ω²

    Args:
        reference: the curve about θ_r.
        frame: how the plane of the path lies in the output space.
        y, y_rate: the output and its rate, (p, 1), [m], [m/s].
        rate: ω = dθ_r/dt, [rad/s]; taken as constant.
    """
    none = ca.SX.zeros(frame.p - 2, 1)
    error = y - frame.join(reference.sigma, none)
    error_rate = y_rate - frame.join(reference.first * rate, none, rate=True)
    return error, error_rate, frame.join(reference.second * rate**2, none, rate=True)


def trajectory_tracking(
    error: ca.SX, error_rate: ca.SX, feedforward: ca.SX, gains: Gains, integral: ca.SX
) -> ca.SX:
    """Commanded y'' = y_r'' - K2 e' - K1 e - K3 ∫e dt, (p, 1), [m/s²].

    Args:
        error, error_rate, feedforward: e, e' and y_r'' of `tracking_error`.
        gains: K1 to K3.
        integral: ∫e dt, (p, 1), [m s].

    Source: computed-torque control, as in any textbook.
    """
    return feedforward - gains.k2 * error_rate - gains.k1 * error - gains.k3 * integral


def linearization(
    system: MechanicalSystem, q: ca.SX, v: ca.SX, model: ca.SX, acceleration: ca.SX
) -> ca.SX:
    """Inputs u that give the controlled output the acceleration y'', if the model is right, (m, 1).

    With J = dh/dq, f_v and g_v of (2), and J' v the part of y'' that is quadratic in the
    velocities,

        y'' = J (f_v + g_v u) + J' v.

    This is solved for u. For n = m = p it simplifies to u = M J⁻¹ (y'' - J' v) + c.

    Args:
        system: the equations of motion.
        q, v: configuration and velocity, (n, 1).
        model: the plant's parameters as the controller assumes them, (k, 1).
        acceleration: commanded y'', (p, 1), [m/s²].

    Returns:
        Generalized forces of the inputs, (m, 1), [N m].

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
    """A⁻¹ r of a small dense matrix as adj(A) r / det(A), which needs a single division."""
    return (1 / ca.det(matrix)) * (ca.adj(matrix) @ rhs)
