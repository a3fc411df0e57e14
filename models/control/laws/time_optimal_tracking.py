"""Time-optimal tracking: follow a point that runs along the path as fast as the motors allow."""

from __future__ import annotations

from dataclasses import replace

import casadi as ca

from onpath.models.control.laws.law import Clock, ControlAction, Law, View
from onpath.models.control.laws.planned_speed import planned, speed_plan
from onpath.models.control.laws.references import (
    clock_acceleration,
    clock_ahead,
    clock_rate,
    tracking_error,
)
from onpath.models.control.laws.trajectory_tracking import pid


def planned_clock(clock: Clock, theta: ca.SX) -> Clock:
    """The clock with the speed and acceleration that the plan has at θ."""
    return replace(clock, task=planned(clock.plan, theta, clock.task, clock.closed))


def planned_ahead(clock: Clock) -> ca.SX:
    """Where the reference point is when the command acts, [rad]."""
    return clock_ahead(planned_clock(clock, clock.theta))


def time_optimal_tracking(view: View) -> ControlAction:
    """Commanded y'' = y_r'' - K2 e' - K1 e - K3 ∫e dt, (p, 1), [m/s²], with a planned clock.

    The clock runs at the fastest speed along the path for which the torques, with viscous friction
    and gravity, are at most 90 % of their limit (models/control/fastest_speed.py):

        θ_r' = ω(θ_r),   θ_r'' = x'(θ_r) / 2,   ω = sqrt(x).

    In the position task it homes in on the target at most at this speed. Without a torque limit it
    runs at the wanted speed.

    Circle of 50 mm, rigid five-bar, default gains, torque cut at 0.3 and 0.5 N m: a lap takes 0.85
    and 0.65 s. Unobstructed, no torque reaches its limit after the start.

    Source: path-constrained trajectory planning, LaValle, Path Planning, reference [5]; the plan as
    in Verscheure et al., Time-optimal path tracking for robots: a convex optimization approach,
    IEEE Transactions on Automatic Control 54 (2009), 2318-2327.
    """
    assert view.reference is not None
    clock = planned_clock(view.clock, view.reference.theta)
    error, error_rate, feedforward = tracking_error(
        view.reference,
        view.frame,
        view.y,
        view.y_rate,
        rate=clock_rate(clock),
        acceleration=clock_acceleration(clock),
    )
    now = planned_clock(view.clock, view.clock.theta)
    rate, second = clock_rate(now), clock_acceleration(now)
    return ControlAction(
        pid(view, error, error_rate, feedforward),
        error=error,
        theta_ref=view.clock.theta + now.dt * (rate + now.dt / 2 * second),
    )


LAW = Law(
    name="time_optimal_tracking",
    label="Time-optimal tracking",
    text="Follows a point that runs along the curve as fast as the torque limits allow.",
    source="path-constrained trajectory planning, LaValle [5]; Verscheure et al., Time-optimal path"
    " tracking for robots",
    command=time_optimal_tracking,
    reference=planned_ahead,
    by_clock=True,
    plan=speed_plan,
    square=True,
    linear=True,
    good="Within its torque limits it is on the curve all the way, at the fastest speed that they"
    " allow.",
    limits="Held back, it leaves the curve as any law with a clock does, and what it then asks for"
    " is beyond its limits.",
    objection="Whoever plans so would plan anew from where the robot is after an obstruction.",
)
