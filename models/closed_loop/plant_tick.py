"""The plant's part of a tick: the held torque, external forces, and Runge-Kutta integration."""

from __future__ import annotations

import casadi as ca

from onpath.models.closed_loop.loop_kind import Kind
from onpath.models.layout import Fields
from onpath.models.systems import forces
from onpath.models.systems.system import MechanicalSystem


def held_torque(
    kind: Kind, state: Fields, settings: Fields, wanted: ca.SX
) -> tuple[ca.SX, ca.SX, ca.SX]:
    """The torque of this tick, with the limit |u_i| <= torque_limit.

    Args:
        wanted: torque that the control law would apply now, (m, 1), [N m].

    Returns:
        u, (m, 1), [N m]; whether the control law is evaluated in this tick; whether a torque
        saturates. The last two are 0 or 1.
    """
    limit = settings["torque_limit"]
    fresh = ca.fmin(ca.fmax(wanted, -limit), limit)
    if kind.free:
        return fresh, ca.SX(1), ca.SX(0)
    acts = state["phase"] < 0.5
    return ca.if_else(acts, fresh, state["u"]), acts, ca.mmax(ca.fabs(wanted)) > limit


def push(
    system: MechanicalSystem,
    kind: Kind,
    state: Fields,
    settings: Fields,
    u: ca.SX,
    grip: forces.Grip,
) -> tuple[ca.SX, ca.SX, ca.SX]:
    """The external forces on the plant, held constant over the tick.

        τ = (u + dry friction, 0) + J_h^T (F_hand + F_brake)

    Args:
        u: torque of the motors, (m, 1), [N m].
        grip: springs of the hand and the brake.

    Returns:
        The actual end-point y (p, 1) [m], the force on it (p, 1) [N], and all generalized forces τ
        (n, 1).
    """
    y, y_rate = system.with_rate(system.output)(state["q"], state["v"], settings["plant"])
    unactuated = ca.SX(system.n - system.m, 1)
    if kind.free:
        return y, ca.SX.zeros(system.p, 1), ca.vertcat(u, unactuated)
    pull = forces.hand(y, y_rate, settings["hand_target"], settings["hand_active"], grip.hand)
    where = settings["hold_anchor"], settings["hold_tangent"]
    brake = forces.hold(y, y_rate, *where, settings["hold_active"], grip.hold)
    force = ca.SX.sym("force", system.p)
    transposed = ca.Function(
        "transposed",
        [system.q, system.parameters, force],
        [ca.jtimes(system.output, system.q, force, True)],
    )
    pushed = transposed(state["q"], settings["plant"], pull + brake)
    motors = u + forces.dry_friction(state["v"][: system.m], settings["coulomb"])
    return y, pull + brake, pushed + ca.vertcat(motors, unactuated)


def integrate(
    system: MechanicalSystem, state: Fields, settings: Fields, tau: ca.SX, substeps: int
) -> Fields:
    """(q, v) after one tick, by the classical Runge-Kutta method with τ held constant.

    With q' = v and v' = a(q, v), the four slopes of q are eliminated:

        q⁺ = q + h v + h²/6 (a1 + a2 + a3),   v⁺ = v + h/6 (a1 + 2 a2 + 2 a3 + a4).

    Args:
        tau: generalized forces, (n, 1).
        substeps: steps per tick; h = dt / substeps.
    """
    slope = ca.Function(
        "slope",
        [system.q, system.v, system.tau, system.parameters],
        [system.acceleration],
    )
    q, v, h = state["q"], state["v"], settings["dt"] / substeps
    half, sixth, plant = h / 2, h / 6, settings["plant"]
    for _ in range(substeps):
        drift = half * v
        middle = q + drift
        ahead = middle + drift
        a1 = slope(q, v, tau, plant)
        a2 = slope(middle, v + half * a1, tau, plant)
        a3 = slope(middle + half**2 * a1, v + half * a2, tau, plant)
        a4 = slope(ahead + half * h * a2, v + h * a3, tau, plant)
        early, late = a1 + (a2 + a3), (a2 + a3) + a4
        q, v = ahead + h * sixth * early, v + sixth * (early + late)
    return {"q": q, "v": v}
