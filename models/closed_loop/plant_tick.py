"""The robot's part of a tick: the torque that is held, pushes from outside, Runge-Kutta."""

from __future__ import annotations

import casadi as ca

from onpath.models.closed_loop.loop_kind import Kind
from onpath.models.layout import Fields
from onpath.models.systems import forces
from onpath.models.systems.system import MechanicalSystem


def held_torque(
    kind: Kind, state: Fields, settings: Fields, wanted: ca.SX
) -> tuple[ca.SX, ca.SX, ca.SX]:
    """Torque of this tick, whether the controller acts in it, whether it saturates."""
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
    """The actual end-point, the force on it, and all generalized forces, held over the tick."""
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
    """Classical Runge-Kutta of the plant over one tick with generalized forces tau held."""
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
