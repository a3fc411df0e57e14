"""Maneuvering: a reference point on the path that descends the gradient of a Lyapunov function."""

from __future__ import annotations

import casadi as ca

from onpath.models.control.laws.law import Clock, ControlAction, Law, View, own_gain
from onpath.models.control.laws.references import clock_acceleration, clock_rate, tracking_error

RATE = "point_rate"


def point_ahead(clock: Clock) -> ca.SX:
    """Where the reference point is when the command acts, at its latest rate, [rad]."""
    return clock.theta + clock.ahead * clock.memory[RATE]


def maneuvering(view: View) -> ControlAction:
    """Commanded y'', (p, 1), [m/s²], with a reference point θ_r whose rate is a second input.

    The geometric task is y → σ(θ_r), the dynamic task θ_r' → ω. With e = y - σ(θ_r) and the error
    of the rate at the wanted speed, ε = y' - σ'(θ_r) ω,

        y'' = σ'' ω² + σ' ω' - K1 e - K2 ε,

    which gives, with x = (e, ε) and s = (σ', σ'' ω),

        x' = A x - s (θ_r' - ω),   A = (0 1; -K1 -K2).

    P solves the Lyapunov equation Aᵀ P + P A = -diag(K1 K2, K2):

        P11 = K1 + K2²/2,   P12 = K2/2,   P22 = 1,   V = P11 |e|² + 2 P12 e · ε + P22 |ε|².

    The gradient update law

        θ_r' = ω + μ g,   g = (σ' · (P11 e + P12 ε) + ω σ'' · (P12 e + P22 ε)) / (P11 |σ'|²)

    makes V' = -K1 K2 |e|² - K2 |ε|² - 2 μ P11 |σ'|² g². μ is `maneuver_gain`.

    The waiting clock differs in three ways: its w is the part of g with |e|² alone, its
    feedforward is that of the actual rate θ_r', which makes e'' = -K1 e - K2 e' without any
    argument about V, and K3 integrates. Here the feedforward is that of the wanted rate ω, as in
    the source: while the robot is held, y'' keeps asking for the centripetal acceleration of a
    speed that neither the robot nor the point has.

    On the rigid five-bar with the default gains, held by a brake at eight places of the circle, it
    is up to 46, 24, 21 and 18 mm off with μ = 50, 80, 100 and 200 1/s, the waiting clock up to
    3.7 mm. V' < 0 says nothing of a robot that is held.

    Source: Skjetne, Fossen and Kokotović, Robust output maneuvering for a class of nonlinear
    systems, Automatica 40 (2004), reference [6].
    """
    reference, frame, gains = view.reference, view.frame, view.gains
    assert reference is not None
    mu, first, second = view.own_gains["maneuver_gain"], reference.first, reference.second
    speed = clock_rate(view.clock)
    error, error_rate, feedforward = tracking_error(
        reference, frame, view.y, view.y_rate, speed, clock_acceleration(view.clock)
    )
    gap = frame.split(error, rate=True)[0]
    gap_rate = frame.split(error_rate, rate=True)[0]
    p11, p12 = gains.k1 + gains.k2**2 / 2, gains.k2 / 2
    slope = ca.dot(first, p11 * gap + p12 * gap_rate)
    slope += speed * ca.dot(second, p12 * gap + gap_rate)
    rate = speed + mu * slope / (ca.fmax(p11, 1e-6) * ca.dot(first, first))
    return ControlAction(
        acceleration=feedforward - gains.k1 * error - gains.k2 * error_rate,
        theta_ref=view.clock.theta + view.clock.dt * view.clock.memory[RATE],
        memory={RATE: rate},
    )


LAW = Law(
    name="maneuvering",
    label="Maneuvering",
    text="Tracks a point that moves along the curve so that a Lyapunov function falls.",
    source="Skjetne, Fossen and Kokotović, Robust output maneuvering, reference [6]",
    command=maneuvering,
    reference=point_ahead,
    gains=("K1", "K2"),
    own_gains=(
        own_gain(
            "maneuver_gain",
            100.0,
            "1/s",
            (0, 200, 1),
            "how strongly the point of maneuvering descends; 0: an ordinary clock",
            label="Point descends",
        ),
    ),
    memory=((RATE, 1),),
    good="It takes up the wanted speed after a start or a pull without the haste of a waiting"
    " clock.",
    limits="Held back, it still feeds forward the wanted speed, and leaves the curve further than a"
    " waiting clock.",
    objection="Its authors would filter the gradient, and prove robustness to disturbances,"
    " of which no use is made here.",
)
