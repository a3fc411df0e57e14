"""Trajectory tracking with a clock that waits, because it feels the error along the path."""

from __future__ import annotations

import casadi as ca

from onpath.models.control.laws.law import Clock, ControlAction, Law, View, own_gain
from onpath.models.control.laws.references import clock_acceleration, clock_rate, tracking_error
from onpath.models.control.laws.trajectory_tracking import pid

RATE = "clock_rate"


def waiting_ahead(clock: Clock) -> ca.SX:
    """Where the reference point is when the command acts, at its latest rate, [rad]."""
    return clock.theta + clock.ahead * clock.memory[RATE]


def waiting_clock(view: View) -> ControlAction:
    """Commanded y'' of tracking, (p, 1), [m/s²], with a reference point that waits.

        θ_r' = ω + μ w,   w = e · σ' / |σ'|²,   e = y - σ(θ_r)

    w is the error along the path in units of θ, so that the clock descends the gradient of ½ |e|².
    The feedforward is y_r'' = σ'' θ_r'² + σ' θ_r'', with

        θ_r'' = ω' + μ w',   w' = (e' · σ' + e · σ'' θ_r' - 2 w (σ' · σ'') θ_r') / |σ'|².

    K3 integrates the part of e across the path: along the path the clock gives way. The clock runs
    at the rate found by the previous evaluation of the law. μ is `clock_gain`.

    It is a simplification of maneuvering; see `maneuvering.py` for what differs.

    Source: after the gradient update law of Skjetne, Fossen and Kokotović, reference [6].
    """
    reference, frame = view.reference, view.frame
    assert reference is not None
    mu, first, second = view.own_gains["clock_gain"], reference.first, reference.second
    length2 = ca.dot(first, first)
    gap = frame.split(view.y)[0] - reference.sigma
    lag = ca.dot(gap, first) / length2
    rate = clock_rate(view.clock) + mu * lag
    error, error_rate, feedforward = tracking_error(reference, frame, view.y, view.y_rate, rate)
    gap_rate = frame.split(view.y_rate, rate=True)[0] - first * rate
    turning = (ca.dot(gap, second) - 2 * lag * ca.dot(first, second)) * rate
    second_rate = clock_acceleration(view.clock)
    second_rate += mu * (ca.dot(gap_rate, first) + turning) / length2
    none = ca.SX.zeros(frame.p - 2, 1)
    feedforward += frame.join(first * second_rate, none, rate=True)
    return ControlAction(
        pid(view, error, error_rate, feedforward),
        error=error - frame.join(first * lag, none, rate=True),
        theta_ref=view.clock.theta + view.clock.dt * view.clock.memory[RATE],
        memory={RATE: rate},
    )


LAW = Law(
    name="waiting_clock",
    label="Waiting clock",
    text="Tracks a point whose clock slows down when the robot falls behind.",
    source="after Skjetne, Fossen and Kokotović, Robust output maneuvering, reference [6]",
    command=waiting_clock,
    reference=waiting_ahead,
    own_gains=(
        own_gain(
            "clock_gain",
            50.0,
            "1/s",
            (0, 200, 1),
            "how strongly the waiting clock feels the error along the path; 0: an ordinary clock",
            label="Clock waits",
        ),
    ),
    memory=((RATE, 1),),
    good="Held back and let go, it stays as close to the curve as path following.",
    limits="A hand that pulls it away disturbs its clock as well: afterwards it first rushes to"
    " find it again.",
    objection="The Lyapunov function of its authors also has the velocity in it, as that of"
    " maneuvering here.",
)
