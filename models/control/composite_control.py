"""Composite control: the actual tip of the flexible five-bar on the path, and its vibration damped.

Slow part: what follows the path is the straight link's tip moved aside by n = w_hat - m,

    y_c = h_0(q) + n e_theta(q3).

w_hat is the deflection that the commanded acceleration a across the link's plane is about to
cause, -C a with C = sum_j phi_j(l) b_j / omega_j^2 for f_j'' = -b_j a - omega_j^2 f_j, through a
third-order filter that is led by as much as it lags. y_c'' is the command of (16)-(19) exactly,
whatever the modes do, and they act back on the motion by the absorber m alone: no zero dynamics
are left to be unstable. The tip is y_c + (w - w_hat + m) e_theta.

Fast part: a virtual absorber m, positive position feedback (Goh and Caughey 1985) from the first
mode beyond its predicted part f_hat, places both it and the mode at damping ratio zeta:

    m'' + 4 zeta omega_1 m' + omega_1^2 m = 4 zeta^2 omega_1^2 (f_1 - f_hat_1) / b_1.

Progress along the path is free: the wanted speed passes a third-order filter, so that the beam is
bent gently, and gives way to a tip that is held back.
"""

from __future__ import annotations

from dataclasses import dataclass

import casadi as ca

from onpath.models.control.virtual_output import VirtualOutput
from onpath.models.layout import Fields, Layout
from onpath.models.systems.beam import beam_modes
from onpath.models.systems.system import MechanicalSystem

MEMORY = Layout((("speed_chain", 3), ("bend_chain", 3), ("absorber", 2)))
GAINS = {"tip_damping": 0.3, "tip_prediction": 1.2, "tip_shaping": 0.25, "tip_yielding": 100.0}
TINY = 1e-9


@dataclass(frozen=True, slots=True)
class CompositeGains:
    """What a user may turn, in the order of `GAINS`, which holds their defaults.

    Attributes:
        damping: zeta, that of the first mode and the absorber.
        prediction: pole of the filter behind w_hat, in units of omega_1.
        shaping: pole of the filter on the wanted speed, in units of omega_1.
        yielding: how much progress gives way to a tip left behind, [1/s^2].
    """

    damping: ca.SX
    prediction: ca.SX
    shaping: ca.SX
    yielding: ca.SX


@dataclass(frozen=True, slots=True)
class Compensation:
    """The beam as the controller believes it to be at this instant.

    Attributes:
        memory, gains: as given.
        aside: e_theta, the direction of the deflection, (3, 1).
        omega1: [rad/s].
        compliance: C, [s^2].
        shift, shift_rate: n and n', [m], [m/s].
        y, y_rate: y_c and its rate, (3, 1), [m], [m/s].
        surprise: w - w_hat + m, how far aside of y_c the tip is, [m].
        excess: (f_1 - f_hat_1) / b_1, [m].
        gain, free: y_c'' = gain u + free + n'' aside, (3, 3), (3, 1).
    """

    memory: Fields
    gains: CompositeGains
    aside: ca.SX
    omega1: ca.SX
    compliance: ca.SX
    shift: ca.SX
    shift_rate: ca.SX
    y: ca.SX
    y_rate: ca.SX
    surprise: ca.SX
    excess: ca.SX
    gain: ca.SX
    free: ca.SX


def ahead(memory: Fields, time: ca.SX) -> Fields:
    """The memory a little later, its highest derivatives held."""
    return {name: x + time * ca.vertcat(x[1:], 0) for name, x in memory.items()}


def compensation(
    system: MechanicalSystem,
    q: ca.SX,
    v: ca.SX,
    model: ca.SX,
    memory: Fields,
    gains: CompositeGains,
) -> Compensation:
    """What the memory and the measured state say.

    Args:
        q, v: with the modal coordinates measured (strain gauges), (n, 1).
        model: the controller's idea of the plant's parameters, (k, 1).
    """
    p = dict(zip(system.parameter_names, ca.vertsplit(model), strict=True))
    modes = beam_modes(system.n - system.m, 1.0)
    omega = p["omega1"] * ca.DM(modes.overtones)
    tip = ca.DM(modes.tip) / ca.sqrt(p["l"])
    radius = p["l1"] * ca.cos(q[0]) - p["l"] * ca.cos(q[1])
    gain, drift = system.function("input_gain", "drift")(q, v, model)
    per_demand = -gain[3:, 2] / (radius * gain[2, 2])  # b_j
    compliance = ca.dot(tip * per_demand, 1 / omega**2)

    bend, bend_rate = _led(memory["bend_chain"], gains.prediction * p["omega1"])
    m, m_rate = ca.vertsplit(memory["absorber"])
    shift, shift_rate = bend - m, bend_rate - m_rate
    y, y_rate, jacobian, turning = _shifted(system)(q, v, model, shift, shift_rate)
    return Compensation(
        memory=memory,
        gains=gains,
        aside=ca.vertcat(-ca.sin(q[2]), ca.cos(q[2]), 0),
        omega1=p["omega1"],
        compliance=compliance,
        shift=shift,
        shift_rate=shift_rate,
        y=y,
        y_rate=y_rate,
        surprise=ca.dot(tip, q[3:]) - shift,
        excess=q[3] / per_demand[0] - bend / (compliance * omega[0] ** 2),
        gain=jacobian @ gain[:3, :],
        free=jacobian @ drift[:3] + turning,
    )


def _led(chain: ca.SX, pole: ca.SX) -> tuple[ca.SX, ca.SX]:
    """w_hat and its rate from the filter's chain; the zero takes the three poles' lag away."""
    lead = 3 / pole
    return chain[0] + lead * chain[1], chain[1] + lead * chain[2]


def _shifted(system: MechanicalSystem) -> ca.Function:
    """(q, v, model, n, n') -> y_c, y_c', its Jacobian in the joints, y_c'' at q'' = n'' = 0."""
    n, n_rate = ca.SX.sym("n"), ca.SX.sym("n_rate")
    alpha = system.parameters[system.parameter_names.index("alpha")]
    straight = ca.substitute(system.controlled_output, alpha, 0)
    y = straight + n * ca.vertcat(-ca.sin(system.q[2]), ca.cos(system.q[2]), 0)
    position, velocity = ca.vertcat(system.q[:3], n), ca.vertcat(system.v[:3], n_rate)
    jacobian = ca.jacobian(y, position)
    rate = jacobian @ velocity
    outputs = [y, rate, jacobian[:, :3], ca.jtimes(rate, position, velocity)]
    inputs = [system.q, system.v, system.parameters, n, n_rate]
    return ca.Function("shifted", inputs, outputs)


def wanted_speed(now: Compensation, output: VirtualOutput, k5: ca.SX) -> ca.SX:
    """What to give path following as its speed, [rad/s], for (19) with feedforward and yielding.

    -K5 (theta' - this) = mu' - K5 (theta' - mu) + yielding lag, lag the tip's in theta.
    """
    mu, mu_rate, _ = ca.vertsplit(now.memory["speed_chain"])
    per_theta = output.inverse[:, 0]
    left, _ = output.frame.split(now.surprise * now.aside, rate=True)
    lag = ca.dot(left, per_theta) / ca.dot(per_theta, per_theta)
    return mu + (mu_rate + now.gains.yielding * lag) / ca.fmax(k5, TINY)


def rates(now: Compensation, speed: ca.SX, command: ca.SX) -> Fields:
    """Derivatives of the memory.

    Args:
        speed: as the user wants it, [rad/s].
        command: y_c'', (3, 1), [m/s^2].
    """
    memory, gains = now.memory, now.gains
    m, m_rate = ca.vertsplit(memory["absorber"])
    m_acceleration = now.omega1**2 * (4 * gains.damping**2 * now.excess - m)
    m_acceleration -= 4 * gains.damping * now.omega1 * m_rate
    bend = -now.compliance * ca.dot(now.aside, command)
    return {
        "speed_chain": _filtered(memory["speed_chain"], speed, gains.shaping * now.omega1),
        "bend_chain": _filtered(memory["bend_chain"], bend, gains.prediction * now.omega1),
        "absorber": ca.vertcat(m_rate, m_acceleration),
    }


def _filtered(chain: ca.SX, target: ca.SX, pole: ca.SX) -> ca.SX:
    """Rates of x, x', x'' with (d/dt + pole)^3 x = pole^3 target."""
    x, rate, bend = ca.vertsplit(chain)
    return ca.vertcat(rate, bend, pole * (pole * (pole * (target - x) - 3 * rate) - 3 * bend))


def torques(now: Compensation, rate: Fields, command: ca.SX) -> ca.SX:
    """Inputs that give y_c the commanded acceleration, if the model is right, (3, 1), [N m].

    Source: eq. (16) for y_c.
    """
    lead = 3 / (now.gains.prediction * now.omega1)
    bend = rate["bend_chain"][1] + lead * rate["bend_chain"][2]
    shift_acceleration = bend - rate["absorber"][1]
    wanted = command - now.free - shift_acceleration * now.aside
    return (1 / ca.det(now.gain)) * (ca.adj(now.gain) @ wanted)
