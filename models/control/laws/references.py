"""The wanted speed along the path, by a clock or at a place, and the error to a reference point."""

from __future__ import annotations

import casadi as ca
import numpy as np

from onpath.models.control.laws.law import Clock, View
from onpath.models.paths.frames import PlaneCoordinates
from onpath.models.paths.projection import LocalCurve, wrap

ZERO = ca.SX(0)
LEAST_GAIN = 1e-3  # [1/s], below which K5 is not divided by


def clock_rate(clock: Clock) -> ca.SX:
    """Speed ω of a reference point that moves by the clock, [rad/s].

        position task:  ω = clip(wrap(θ_target - θ_r) / dt, -|speed|, |speed|)
        speed task:     ω = speed

    In the position task the point stops at the target after at most one tick of rounding. On an
    open curve it stops at the end. No measured quantity enters: the reference does not wait for the
    robot.
    """
    task, dt = clock.task, clock.dt
    limit = ca.fabs(task.speed)
    to_target = wrap(task.target - clock.theta, clock.closed) / dt
    homing = ca.fmin(ca.fmax(to_target, -limit), limit)
    moving = task.speed
    if not clock.closed:
        back, ahead = (-np.pi - clock.theta) / dt, (np.pi - clock.theta) / dt
        back, ahead = ca.fmin(back, 0), ca.fmax(ahead, 0)  # a point beyond an end is not sent back
        moving = ca.fmin(ca.fmax(moving, back), ahead)
    return ca.if_else(task.position, homing, moving)


def clock_acceleration(clock: Clock) -> ca.SX:
    """Rate ω' of `clock_rate`: that of the wanted speed where the point moves with it, [rad/s²]."""
    task = clock.task
    return (clock_rate(clock) == task.speed) * (1 - task.position) * task.acceleration


def clock_ahead(clock: Clock) -> ca.SX:
    """Where the reference point is when the command acts: θ_r + ahead · ω, [rad]."""
    return clock.theta + clock.ahead * clock_rate(clock)


def rate_at(view: View) -> ca.SX:
    """Wanted speed along the path where the robot is, for laws without a clock, [rad/s].

    position task:  ω = clip(K4 / K5 wrap(θ_target - θ), -|speed|, |speed|)
    speed task:     ω = speed, which `fading` reduces at the ends of an open curve
    """
    task, theta, gains, closed = view.task, view.output.theta, view.gains, view.clock.closed
    limit, pull = ca.fabs(task.speed), gains.k4 / ca.fmax(gains.k5, LEAST_GAIN)
    homing = ca.fmin(ca.fmax(pull * wrap(task.target - theta, closed), -limit), limit)
    moving = task.speed if closed else fading(theta, task.speed, gains.k5)
    return ca.if_else(task.position, homing, moving)


def fading(theta: ca.SX, speed: ca.SX, k5: ca.SX) -> ca.SX:
    """The speed reference on an open curve, which goes to 0 at both ends, [rad/s].

        ω_ref = clip(speed, K5/4 (-π - θ), K5/4 (π - θ))

    Near the end (19) becomes θ'' = -K5 θ' - K5²/4 (θ - π), which is critically damped.
    """
    pull = k5 / 4
    return ca.fmin(ca.fmax(speed, pull * (-np.pi - theta)), pull * (np.pi - theta))


def tracking_error(
    reference: LocalCurve,
    frame: PlaneCoordinates,
    y: ca.SX,
    y_rate: ca.SX,
    rate: ca.SX,
    acceleration: ca.SX = ZERO,
) -> tuple[ca.SX, ca.SX, ca.SX]:
    """(e, e', y_r'') for the reference point y_r = σ(θ_r), each (p, 1), [m], [m/s], [m/s²].

        e = y - σ(θ_r),   e' = y' - σ'(θ_r) ω,   y_r'' = σ''(θ_r) ω² + σ'(θ_r) ω'

    Args:
        reference: the curve about θ_r.
        frame: how the plane of the path lies in the output space.
        y, y_rate: the output and its rate, (p, 1), [m], [m/s].
        rate: ω = dθ_r/dt, [rad/s].
        acceleration: ω', [rad/s²].
    """
    none = ca.SX.zeros(frame.p - 2, 1)
    error = y - frame.join(reference.sigma, none)
    error_rate = y_rate - frame.join(reference.first * rate, none, rate=True)
    planar = reference.second * rate**2 + reference.first * acceleration
    return error, error_rate, frame.join(planar, none, rate=True)
