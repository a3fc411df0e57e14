"""Trajectory tracking: follow a point that moves along the path by the clock."""

from __future__ import annotations

import casadi as ca

from onpath.models.control.laws.law import ControlAction, Law, View
from onpath.models.control.laws.references import (
    clock_acceleration,
    clock_ahead,
    clock_rate,
    tracking_error,
)


def trajectory_tracking(view: View) -> ControlAction:
    """Commanded y'' = y_r'' - K2 e' - K1 e - K3 ∫e dt, (p, 1), [m/s²].

    e, e' and y_r'' are those of `tracking_error`, with the rates of `clock_rate` and
    `clock_acceleration`.

    Source: computed-torque control, as in any textbook.
    """
    assert view.reference is not None
    error, error_rate, feedforward = tracking_error(
        view.reference,
        view.frame,
        view.y,
        view.y_rate,
        rate=clock_rate(view.clock),
        acceleration=clock_acceleration(view.clock),
    )
    return ControlAction(pid(view, error, error_rate, feedforward), error=error)


def pid(view: View, error: ca.SX, error_rate: ca.SX, feedforward: ca.SX) -> ca.SX:
    """y_r'' - K2 e' - K1 e - K3 ∫e dt, (p, 1), [m/s²]."""
    gains = view.gains
    return feedforward - gains.k2 * error_rate - gains.k1 * error - gains.k3 * view.integral


LAW = Law(
    name="trajectory_tracking",
    label="Trajectory tracking",
    text="Follows a point that moves along the curve by the clock, whatever the robot does.",
    source="computed-torque control, as in any textbook",
    command=trajectory_tracking,
    reference=clock_ahead,
    by_clock=True,
    linear=True,
    good="It is on time: also after an obstruction it is again where the clock wants it to be.",
    limits="Held back, it does not wait: let go, it leaves the curve to catch up.",
    objection="Whoever uses it would plan the timetable anew after a release, so that it"
    " need not catch up.",
)
