"""Inputs of the control laws in a tick: exact or measured states, predicted a little ahead."""

from __future__ import annotations

from math import sqrt

import casadi as ca
import numpy as np

from onpath.models.arrays import Array
from onpath.models.closed_loop.loop_kind import Kind
from onpath.models.closed_loop.noise import standard_normal
from onpath.models.closed_loop.observer import corrected
from onpath.models.control.virtual_output import VirtualOutput
from onpath.models.layout import Fields, Layout
from onpath.models.systems.beam import beam_modes
from onpath.models.systems.system import MechanicalSystem


def measure(
    system: MechanicalSystem, kind: Kind, state: Fields, settings: Fields
) -> tuple[ca.SX, ca.SX, ca.SX]:
    """q and v as measured, each (n, 1), and the encoder readings, (joints, 1), [rad].

    Without encoders and noise the state is exact. The velocities come from an observer, see
    observer.py, which also smooths the coordinates, or else from a filter. The filter takes the
    joint angles as they are read, and differentiates them behind a first-order low-pass of time
    constant `encoder_filter`:

        v_f⁺ = v_f + T / (encoder_filter + T) ((r - r_previous) / T - v_f),   T = hold_ticks dt;

    the rates of a flexible link's modes are then exact.
    """
    joints, v, reading = system.joints, state["v"], read(system, kind, state, settings)
    if not (kind.encoder or kind.noise):
        return reading, v, reading[:joints]
    if kind.observer:
        estimate = corrected(state, settings, reading)
    else:
        estimate = reading, ca.vertcat(filtered(state, settings, reading[:joints]), v[joints:])
    if not kind.encoder:  # exact angles have exact velocities
        noisy, exact = settings["sensor_noise"] > 0, (reading, v)
        angles, rates = (
            ca.if_else(noisy, estimated[:joints], known[:joints])
            for estimated, known in zip(estimate, exact, strict=True)
        )
        estimate = ca.vertcat(angles, estimate[0][joints:]), ca.vertcat(rates, estimate[1][joints:])
    return *estimate, reading[:joints]


def filtered(state: Fields, settings: Fields, reading: ca.SX) -> ca.SX:
    """The velocities by the filter of `measure`, (joints, 1)."""
    dt = settings["dt"] * settings["hold_ticks"]
    weight = dt / (settings["encoder_filter"] + dt)
    difference = (reading - state["encoder"]) / dt
    return state["encoder_rate"] + weight * (difference - state["encoder_rate"])


def read(system: MechanicalSystem, kind: Kind, state: Fields, settings: Fields) -> ca.SX:
    """What the sensors of all coordinates read, (n, 1).

    Encoders are on all joints, also on those without a motor, and round to `encoder_step`; strain
    gauges measure the modes of a flexible link. Noise of the joint angles is added before they are
    rounded.
    """
    q = state["q"] + _noise(system, state, settings) if kind.noise else state["q"]
    if not kind.encoder:
        return q
    joints, step = system.joints, settings["encoder_step"]
    return ca.vertcat(step * ca.floor(q[:joints] / step + 0.5), q[joints:])


def readings(
    system: MechanicalSystem, kind: Kind, settings_layout: Layout, settings: Array, q: Array
) -> Array:
    """What the encoders read in a run from its first tick on, (ticks, joints), [rad].

    Args:
        settings: flat vector of the run; only the settings of the sensors matter.
        q: true coordinates in each tick, (ticks, n).
    """
    joints = system.joints
    if not len(q):
        return np.zeros((0, joints))
    symbol, fields = settings_layout.symbols("settings")
    state = {"q": ca.SX.sym("q", system.n), "ticks": ca.SX.sym("ticks")}
    angles = read(system, kind, state, fields)[:joints]
    function = ca.Function("readings", [symbol, state["q"], state["ticks"]], [angles])
    ticks, constant = np.arange(len(q))[None], np.tile(settings[:, None], len(q))
    return np.asarray(function.map(len(q))(constant, q.T, ticks), dtype=float).T


def _noise(system: MechanicalSystem, state: Fields, settings: Fields) -> ca.SX:
    """The errors of the measured coordinates in this tick: white noise, (n, 1).

    Joint angles have the standard deviation `sensor_noise`. Strain gauges measure the modal
    coordinates f_j, each with a standard deviation such that that of the deflection of the tip,
    Σ φ_j(l) f_j, is `strain_noise`.
    """
    modes = system.modes
    deviation = settings["sensor_noise"] * ca.SX.ones(system.joints)
    if modes:
        length = settings["model"][system.parameter_names.index("l")]
        tip = ca.DM(beam_modes(modes, 1.0).tip) / ca.sqrt(length)
        deviation = ca.vertcat(deviation, settings["strain_noise"] / (tip * sqrt(modes)))
    return deviation * standard_normal(settings["seed"], state["ticks"], system.n)


def look_ahead(
    system: MechanicalSystem, state: Fields, settings: Fields, q: ca.SX, v: ca.SX, h: ca.SX
) -> tuple[ca.SX, ca.SX]:
    """q and v after the time h, by the controller's model under the torque held until now.

        q̂ = q + h v + h²/2 a(q, v),   v̂ = v + h a(q, v)

    A torque held over an interval T acts, on average, half an interval late. Evaluating the control
    law for the state in the middle of the interval, h = T / 2, keeps the path invariant to O(T²)
    instead of O(T). With T = 1 ms that is half a tick. With a longer T it has a price, which is why
    half a tick is the default for all T: the torque held until now enters the prediction, so that
    K2 must be below 1 / T, and not 2 / (T + 2 h) as for a small h (models/control/poles.py).

    Measured with the rigid five-bar at 100 Hz from 1 s to 6 s, for h = 0.5 and 5 ms, K1 = 400: mean
    speed 1.9 % too high and 0.07 % too low; largest distance 0.10 and 0.06 mm; stable up to K2 =
    181.5 and 98.
    Behind encoders of 2000 steps, noise of 1e-4 rad and an observer: 1.8 % too high and 0.1 % too
    low; 0.3 mm; the arm stands the same K2 as with exact measurements, within 3 %. A filter leaves
    15 and 11 % and 1 mm.

    Args:
        q, v: as measured, (n, 1).
        h: see `look_ahead_time` in models/systems/parameters.py, [s].
    """
    inputs = [system.q, system.v, system.tau, system.parameters]
    slope = ca.Function("slope", inputs, [system.acceleration])
    tau = system.effort(q, state["u"], settings["model"])
    change = h * slope(q, v, tau, settings["model"])  # of v
    return q + h * (v + change / 2), v + change


def logged(output: VirtualOutput) -> Fields:
    """θ, ξ and their rates for the log.

    Args:
        output: the virtual output of the measured state. That of the predicted state would be wrong
            under an external force, which the prediction does not know.
    """
    return {
        "theta": output.theta,
        "theta_rate": output.theta_rate,
        "speed": output.theta_rate * output.per_radian,
        "xi": output.xi,
        "xi_rate": output.xi_rate,
    }


def remembered(kind: Kind, state: Fields, acts: ca.SX, reading: ca.SX, rate: ca.SX) -> Fields:
    """Readings and velocities of which the filter makes the next velocities; ticks of noise.

    Args:
        acts: whether the control law is evaluated in this tick.
        reading: (joints, 1), [rad].
        rate: measured velocity, (joints, 1), [rad/s].
    """
    counted = {"ticks": state["ticks"] + int(kind.noise)} if "ticks" in state else Fields()
    if not (kind.encoder or kind.noise):
        return {"encoder": reading, "encoder_rate": rate, **counted}
    return counted | {
        "encoder": ca.if_else(acts, reading, state["encoder"]),
        "encoder_rate": ca.if_else(acts, rate, state["encoder_rate"]),
    }
