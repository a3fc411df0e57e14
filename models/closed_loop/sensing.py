"""What the controllers see in a tick: encoders or the truth, and half a tick ahead."""

from __future__ import annotations

import casadi as ca

from onpath.models.closed_loop.loop_kind import Kind
from onpath.models.control.virtual_output import VirtualOutput
from onpath.models.layout import Fields
from onpath.models.systems.system import MechanicalSystem


def measure(
    system: MechanicalSystem, kind: Kind, state: Fields, settings: Fields
) -> tuple[ca.SX, ca.SX, ca.SX]:
    """q and v as the controller sees them, and the encoders' reading.

    Without encoders it sees the truth; with them joint angles come in steps and velocities from
    their filtered differences. Coordinates without a motor are seen exactly.
    """
    q, v, m = state["q"], state["v"], system.m
    if not kind.encoder:
        return q, v, q[:m]
    step, dt = settings["encoder_step"], settings["dt"] * settings["hold_ticks"]
    reading = step * ca.floor(q[:m] / step + 0.5)
    weight = dt / (settings["encoder_filter"] + dt)
    difference = (reading - state["encoder"]) / dt
    rate = state["encoder_rate"] + weight * (difference - state["encoder_rate"])
    return ca.vertcat(reading, q[m:]), ca.vertcat(rate, v[m:]), reading


def look_ahead(
    system: MechanicalSystem, state: Fields, settings: Fields, q: ca.SX, v: ca.SX
) -> tuple[ca.SX, ca.SX]:
    """q and v half a tick later, by the controller's model under the torque held so far.

    A torque held over a tick acts, on average, half a tick late; meeting the robot there keeps
    the path invariant to O(dt^2) and not only O(dt), if the controller acts every tick. At lower
    control rates the torque is held longer, and half a tick is not enough.
    """
    inputs = [system.q, system.v, system.tau, system.parameters]
    slope = ca.Function("slope", inputs, [system.acceleration])
    effort = ca.vertcat(state["u"], ca.SX(system.n - system.m, 1))
    half = settings["dt"] / 2
    gained = half * slope(q, v, effort, settings["model"])
    return q + half * (v + gained / 2), v + gained


def logged(output: VirtualOutput, theta_rate: ca.SX, settings: Fields) -> Fields:
    """What the log says of theta and xi: half a tick back from where the controller looked.

    The speed along the path is the measured one: under a push that the controller cannot foresee,
    the one it looks ahead to would be wrong for as long as the push lasts.
    """
    half = settings["dt"] / 2
    per_radian = output.per_radian - half * theta_rate * output.stretch
    return {
        "theta": output.theta - half * theta_rate,
        "theta_rate": theta_rate,
        "speed": theta_rate * per_radian,
        "xi": output.xi - half * output.xi_rate,
        "xi_rate": output.xi_rate,
    }


def remembered(kind: Kind, state: Fields, acts: ca.SX, reading: ca.SX, rate: ca.SX) -> Fields:
    """What the encoders remember: exact sensing needs no sampling."""
    if not kind.encoder:
        return {"encoder": reading, "encoder_rate": rate}
    return {
        "encoder": ca.if_else(acts, reading, state["encoder"]),
        "encoder_rate": ca.if_else(acts, rate, state["encoder_rate"]),
    }
