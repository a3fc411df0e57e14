"""The plant's part of a tick: the held torque, external forces, and Runge-Kutta integration."""

from __future__ import annotations

import casadi as ca

from onpath.models.closed_loop.loop_kind import Kind
from onpath.models.closed_loop.stiction import friction
from onpath.models.layout import Fields
from onpath.models.systems import forces
from onpath.models.systems.system import MechanicalSystem


def held_torque(
    system: MechanicalSystem, kind: Kind, state: Fields, settings: Fields, wanted: ca.SX
) -> tuple[ca.SX, ca.SX, ca.SX]:
    """The torque of this tick, within the motors' limits, in steps of torque_step.

    Args:
        wanted: torque that the control law would apply now, (m, 1), [N m].

    Returns:
        u, (m, 1), [N m]; whether the control law is evaluated in this tick; whether a torque
        saturates. The last two are 0 or 1.
    """
    if kind.free:
        return wanted, ca.SX(1), ca.SX(0)
    limit = system.torque_limits(settings["torque_limit"])
    fresh = ca.fmin(ca.fmax(wanted, -limit), limit)
    acts, fresh = state["phase"] < 0.5, _stepped(fresh, limit, settings["torque_step"])
    return ca.if_else(acts, fresh, state["u"]), acts, ca.mmax(ca.fabs(wanted) > limit)


def _stepped(u: ca.SX, limit: ca.SX, step: ca.SX) -> ca.SX:
    """The multiple of `step` nearest to u that is within the limit; u itself if `step` is 0."""
    size = ca.if_else(step > 0, step, 1)
    most = ca.floor(limit / size)
    whole = ca.fmin(ca.fmax(ca.floor(u / size + 0.5), -most), most)
    return ca.if_else(step > 0, size * whole, u)


def push(
    system: MechanicalSystem,
    kind: Kind,
    state: Fields,
    settings: Fields,
    u: ca.SX,
    grip: forces.Grip,
) -> tuple[ca.SX, ca.SX, ca.SX]:
    """All forces on the plant, held constant over the tick.

        τ = B(q) (u + dry friction) + J_h^T (F_hand + F_brake + F_wall) + ends of the travel

    Dry friction acts in the motors, at the rates B^T v. B is taken half a tick ahead, for which the
    control law computed u.

    Args:
        u: torque of the motors, (m, 1), [N m].
        grip: springs of the hand, the brake and the wall.

    Returns:
        The actual end-point y (p, 1) [m], the force on it (p, 1) [N], and all generalized forces τ
        (n, 1).
    """
    y, y_rate = system.with_rate(system.output)(state["q"], state["v"], settings["plant"])
    middle = state["q"] + settings["dt"] / 2 * state["v"]
    ends = system.end_forces(state["q"], state["v"])
    if kind.free:
        return y, ca.SX.zeros(system.p, 1), ends + system.effort(middle, u, settings["plant"])
    pull = forces.hand(y, y_rate, settings["hand_target"], settings["hand_active"], grip.hand)
    where, active = settings["hold_anchor"], settings["hold_active"]
    brake = forces.hold(y, y_rate, where, settings["hold_tangent"], active, grip.hold)
    brake += forces.hold(y, y_rate, where, settings["hold_normal"], active, grip.hold)
    place, normal, solid = (settings[f"wall_{name}"] for name in ("place", "normal", "active"))
    outside = pull + brake + forces.wall(y, y_rate, place, normal, solid, grip.wall)
    force = ca.SX.sym("force", system.p)
    transposed = ca.Function(
        "transposed",
        [system.q, system.parameters, force],
        [ca.jtimes(system.output, system.q, force, True)],
    )
    pushed = transposed(state["q"], settings["plant"], outside)
    if not kind.stiction:  # stiction includes dry friction
        rates = system.input_rates(state["q"], state["v"], settings["plant"])
        compliance = system.compliance(state["q"], settings["plant"])
        u = u + forces.dry_friction(rates, settings["coulomb"], compliance, settings["dt"])
    return y, outside, ends + pushed + system.effort(middle, u, settings["plant"])


def move(
    system: MechanicalSystem,
    kind: Kind,
    state: Fields,
    settings: Fields,
    torques: tuple[tuple[ca.SX, ca.SX], ...],
    plant: tuple[int, forces.Grip],
) -> tuple[ca.SX, ca.SX, Fields]:
    """The plant in one tick.

    Args:
        torques: (torque of the motors (m, 1) [N m], share of the tick) of its consecutive parts.
        plant: number of Runge-Kutta steps in each part, and the springs of hand and brake.

    Returns:
        The actual end-point y [m] and the force on it [N] at the beginning, each (p, 1), and (q, v)
        after the tick.
    """
    now, pushes = {"q": state["q"], "v": state["v"]}, list[tuple[ca.SX, ca.SX]]()
    for torque, share in torques:
        y, force, tau = push(system, kind, now, settings, torque, plant[1])
        pushes.append((y, force))
        resting = None
        if kind.stiction:
            levels = settings["stiction"], settings["coulomb"]
            resting = friction(system, now, tau, settings["plant"], levels)
            tau = tau + system.effort(now["q"], resting.torque, settings["plant"])
        moved = integrate(system, now, settings, tau, share * settings["dt"] / plant[0], plant[0])
        if resting is not None:
            moved = resting.applied(system, now, moved, settings["plant"])
        now = moved
    return *pushes[0], now


def integrate(
    system: MechanicalSystem, state: Fields, settings: Fields, tau: ca.SX, h: ca.SX, steps: int
) -> Fields:
    """(q, v) some steps later, by the classical Runge-Kutta method with τ held constant.

    With q' = v and v' = a(q, v), the four slopes of q are eliminated:

        q⁺ = q + h v + h²/6 (a1 + a2 + a3),   v⁺ = v + h/6 (a1 + 2 a2 + 2 a3 + a4).

    Args:
        tau: generalized forces, (n, 1).
        h: length of a step, [s].
        steps: their number.
    """
    slope = ca.Function(
        "slope",
        [system.q, system.v, system.tau, system.parameters],
        [system.acceleration],
    )
    q, v = state["q"], state["v"]
    half, sixth, plant = h / 2, h / 6, settings["plant"]
    for _ in range(steps):
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
