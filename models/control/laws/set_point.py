"""Set-point regulation: go straight to a fixed point of the path."""

from __future__ import annotations

import casadi as ca

from onpath.models.control.laws.law import Clock, ControlAction, Law, View


def target(clock: Clock) -> ca.SX:
    """The parameter θ_target of the fixed point, [rad]."""
    return clock.task.target


def set_point(view: View) -> ControlAction:
    """Commanded y'' = -K1 (y - σ(θ_target)) - K2 y' - K3 ∫(y - σ(θ_target)) dt, (p, 1), [m/s²].

    Source: the set-point regulators with which the paper compares experiment 1 (III.B.4): they cut
    across the circle.
    """
    assert view.reference is not None
    gains, none = view.gains, ca.SX.zeros(view.frame.p - 2, 1)
    error = view.y - view.frame.join(view.reference.sigma, none)
    acceleration = -gains.k1 * error - gains.k2 * view.y_rate - gains.k3 * view.integral
    return ControlAction(acceleration, error=error, theta_ref=target(view.clock))


LAW = Law(
    name="set_point",
    label="Set point",
    text="Goes straight to the target and knows nothing of the curve between.",
    source="Hladio, Nielsen and Wang, section III.B.4",
    command=set_point,
    reference=target,
    pace="none",
    linear=True,
    good="It reaches the target and stays there, wherever it begins.",
    limits="It leaves the curve on its way, because it takes the straight one.",
    objection="Nobody proposes it for following a path: it shows what the path adds.",
)
