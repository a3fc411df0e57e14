"""Inputs of the control laws in a tick: exact or measured states, predicted half a tick ahead."""

from __future__ import annotations

from math import sqrt

import casadi as ca

from onpath.models.closed_loop.loop_kind import Kind
from onpath.models.closed_loop.noise import standard_normal
from onpath.models.control.virtual_output import VirtualOutput
from onpath.models.layout import Fields
from onpath.models.systems.beam import beam_modes
from onpath.models.systems.system import MechanicalSystem


def measure(
    system: MechanicalSystem, kind: Kind, state: Fields, settings: Fields
) -> tuple[ca.SX, ca.SX, ca.SX]:
    """q and v as measured, each (n, 1), and the encoder readings, (m, 1), [rad].

    Without encoders the state is exact. With encoders the joint angles are rounded to
    `encoder_step`, and the velocities are their differences behind a first-order low-pass filter of
    time constant `encoder_filter`:

        v_f⁺ = v_f + T / (encoder_filter + T) ((q - q_previous) / T - v_f),   T = hold_ticks dt.

    Encoders are on the first m coordinates; the others are exact, but for the noise of strain
    gauges. Noise of the joint angles is added before they are rounded; it, too, calls for the
    filter.
    """
    m, v = system.m, state["v"]
    q = state["q"] + _noise(system, state, settings) if kind.noise else state["q"]
    if not (kind.encoder or kind.noise):
        return q, v, q[:m]
    step, dt = settings["encoder_step"], settings["dt"] * settings["hold_ticks"]
    reading = step * ca.floor(q[:m] / step + 0.5) if kind.encoder else q[:m]
    weight = dt / (settings["encoder_filter"] + dt)
    difference = (reading - state["encoder"]) / dt
    rate = state["encoder_rate"] + weight * (difference - state["encoder_rate"])
    if not kind.encoder:  # exact velocities without noise of the angles
        rate = ca.if_else(settings["sensor_noise"] > 0, rate, v[:m])
    return ca.vertcat(reading, q[m:]), ca.vertcat(rate, v[m:]), reading


def _noise(system: MechanicalSystem, state: Fields, settings: Fields) -> ca.SX:
    """The errors of the measured coordinates in this tick: white noise, (n, 1).

    Joint angles have the standard deviation `sensor_noise`. Strain gauges measure the modal
    coordinates f_j, each with a standard deviation such that that of the deflection of the tip,
    Σ φ_j(l) f_j, is `strain_noise`. The rates of the modes are not affected.
    """
    n, m = system.n, system.m
    deviation = settings["sensor_noise"] * ca.SX.ones(m)
    if n > m:
        own = system.parameter_names.index("l")
        tip = ca.DM(beam_modes(n - m, 1.0).tip) / ca.sqrt(settings["model"][own])
        deviation = ca.vertcat(deviation, settings["strain_noise"] / (tip * sqrt(n - m)))
    return deviation * standard_normal(settings["seed"], state["ticks"], n)


def look_ahead(
    system: MechanicalSystem, state: Fields, settings: Fields, q: ca.SX, v: ca.SX
) -> tuple[ca.SX, ca.SX]:
    """q and v half a tick later, by the controller's model under the torque held until now.

    A torque held over a tick acts, on average, half a tick late. Evaluating the control law for the
    state in the middle of the tick keeps the path invariant to O(dt²) instead of O(dt), provided
    that the law is evaluated in every tick. At lower control rates the torque is held for longer
    than the prediction covers, and part of the delay remains.

        q̂ = q + h v + h²/2 a(q, v),   v̂ = v + h a(q, v),   h = dt / 2

    Args:
        q, v: as measured, (n, 1).
    """
    inputs = [system.q, system.v, system.tau, system.parameters]
    slope = ca.Function("slope", inputs, [system.acceleration])
    tau = system.effort(q, state["u"], settings["model"])
    half = settings["dt"] / 2
    change = half * slope(q, v, tau, settings["model"])  # of v
    return q + half * (v + change / 2), v + change


def logged(output: VirtualOutput, theta_rate: ca.SX, settings: Fields) -> Fields:
    """θ, ξ and their rates for the log, extrapolated back to the beginning of the tick.

    The speed along the path is the measured one. Under an external force, which the prediction does
    not know, the predicted speed would be wrong for as long as the force lasts.

    Args:
        output: the virtual output at the predicted state.
        theta_rate: θ' from the measured velocities, [rad/s].
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
    """Readings and filtered velocities that the next evaluation differentiates; ticks of noise.

    Args:
        acts: whether the control law is evaluated in this tick.
        reading: (m, 1), [rad].
        rate: filtered velocity, (m, 1), [rad/s].
    """
    counted = {"ticks": state["ticks"] + int(kind.noise)} if "ticks" in state else Fields()
    if not (kind.encoder or kind.noise):
        return {"encoder": reading, "encoder_rate": rate, **counted}
    return counted | {
        "encoder": ca.if_else(acts, reading, state["encoder"]),
        "encoder_rate": ca.if_else(acts, rate, state["encoder_rate"]),
    }
