"""Composite control: puts the actual tip of the flexible link on the path and damps its vibration.

Slow part. The controlled output is the tip of the straight link, h_0(q), shifted by n = ŵ - m
across the link:

    y_c = h_0(q) + n e_θ(q3),   e_θ = (-sin q3, cos q3, 0).

ŵ predicts the deflection that the commanded acceleration a = e_θ · y_c'' will cause. The modes obey
f_j'' = -b_j a - ω_j² f_j, so that quasi-statically w = -C a with the compliance C = Σ_j φ_j(l) b_j
/ ω_j². ŵ is -C a behind a third-order filter whose zero cancels its lag to first order. y_c''
equals the command of (16)-(19) exactly, whatever the modes do; they act back on the joints through
m only, so that no unstable zero dynamics remain. The tip is y_c + (w - ŵ + m) e_θ.

Fast part. A virtual absorber m, positive position feedback (Goh and Caughey 1985) from the first
mode without its predicted part f̂_1, gives the mode and the absorber the damping ratio ζ:

    m'' + 4 ζ ω_1 m' + ω_1² m = 4 ζ² ω_1² (f_1 - f̂_1) / b_1.

Progress along the path is free: the wanted speed passes through a third-order filter, so that the
beam bends gently, and it is reduced while the tip is held back.

Measured on an independent model (a chain of 20 rigid segments), rms distance after the first 2 s:
0.023 mm; with EI wrong by ±20 %, 0.07 mm; with an unknown 100 g at the tip, 1.2 mm, and 10 mm if
its weight, 1 N, acts too: with K3 = 0 nothing removes the lasting offset.
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
    """The tuning parameters, in the order of `GAINS`, which holds their defaults.

    Attributes:
        damping: ζ, damping ratio of the first mode and of the absorber.
        prediction: pole of the filter behind ŵ, in units of ω_1.
        shaping: pole of the filter on the wanted speed, in units of ω_1.
        yielding: how strongly progress yields to a tip that lags behind, [1/s²].
    """

    damping: ca.SX
    prediction: ca.SX
    shaping: ca.SX
    yielding: ca.SX


@dataclass(frozen=True, slots=True)
class Compensation:
    """The flexible link as the controller estimates it at one instant.

    Attributes:
        memory, gains: as given to `compensation`.
        lateral: e_θ, the direction of the deflection, (3, 1).
        omega1: ω_1, [rad/s].
        compliance: C, [s²].
        shift, shift_rate: n and n', [m], [m/s].
        y, y_rate: y_c and y_c', (3, 1), [m], [m/s].
        tip_offset: w - ŵ + m, the displacement of the tip from y_c along e_θ, [m].
        excess: (f_1 - f̂_1) / b_1, [m].
        gain, drift: y_c'' = gain @ u + drift + n'' e_θ, (3, 3), (3, 1).
    """

    memory: Fields
    gains: CompositeGains
    lateral: ca.SX
    omega1: ca.SX
    compliance: ca.SX
    shift: ca.SX
    shift_rate: ca.SX
    y: ca.SX
    y_rate: ca.SX
    tip_offset: ca.SX
    excess: ca.SX
    gain: ca.SX
    drift: ca.SX


def ahead(memory: Fields, time: ca.SX) -> Fields:
    """The memory a little later, with the highest derivative of each chain held constant.

    Args:
        time: [s].
    """
    return {name: x + time * ca.vertcat(x[1:], 0) for name, x in memory.items()}


def compensation(
    system: MechanicalSystem,
    q: ca.SX,
    v: ca.SX,
    model: ca.SX,
    memory: Fields,
    gains: CompositeGains,
) -> Compensation:
    """The estimate from the memory and the measured state.

    The modal coordinates are taken as measured (strain gauges). From the input gains g_v, a torque
    u3 that accelerates the tip of the rigid link by a = r q3'' accelerates mode j by -b_j a, so
    that b_j = -g_fj,3 / (r g_33), with r the horizontal distance of the tip from the waist.

    Args:
        system: the flexible five-bar.
        q, v: configuration and velocity, (n, 1).
        model: the plant's parameters as the controller assumes them, (k, 1).
        memory: fields of `MEMORY`.
        gains: the tuning parameters.
    """
    p = dict(zip(system.parameter_names, ca.vertsplit(model), strict=True))
    modes = beam_modes(system.modes, 1.0)
    omega = p["omega1"] * ca.DM(modes.overtones)
    tip = ca.DM(modes.tip) / ca.sqrt(p["l"])
    radius = p["l1"] * ca.cos(q[0]) - p["l"] * ca.cos(q[1])
    gain, drift = system.function("input_gain", "drift")(q, v, model)
    per_demand = -gain[3:, 2] / (radius * gain[2, 2])  # b_j
    compliance = ca.dot(tip * per_demand, 1 / omega**2)

    w_hat, w_hat_rate = _led(memory["bend_chain"], gains.prediction * p["omega1"])
    m, m_rate = ca.vertsplit(memory["absorber"])
    shift, shift_rate = w_hat - m, w_hat_rate - m_rate
    y, y_rate, jacobian, turning = _shifted(system)(q, v, model, shift, shift_rate)
    return Compensation(
        memory=memory,
        gains=gains,
        lateral=ca.vertcat(-ca.sin(q[2]), ca.cos(q[2]), 0),
        omega1=p["omega1"],
        compliance=compliance,
        shift=shift,
        shift_rate=shift_rate,
        y=y,
        y_rate=y_rate,
        tip_offset=ca.dot(tip, q[3:]) - shift,
        excess=q[3] / per_demand[0] - w_hat / (compliance * omega[0] ** 2),
        gain=jacobian @ gain[:3, :],
        drift=jacobian @ drift[:3] + turning,
    )


def _led(chain: ca.SX, pole: ca.SX) -> tuple[ca.SX, ca.SX]:
    """ŵ and ŵ' from the chain (x, x', x'') of the filter: ŵ = x + (3 / pole) x'.

    In transfer functions: (1 + 3 s/pole) / (1 + s/pole)³ = 1 + O(s²), so that there is no lag to
    first order.
    """
    lead = 3 / pole
    return chain[0] + lead * chain[1], chain[1] + lead * chain[2]


def _shifted(system: MechanicalSystem) -> ca.Function:
    """(q, v, model, n, n') -> y_c, y_c', dy_c/d(q1, q2, q3), and y_c'' at q'' = n'' = 0."""
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
    """The speed reference for the tangential law (19), [rad/s].

    With μ the filtered speed, it is μ + (μ' + yielding · lag) / K5, so that (19) becomes

        v_par = -K5 (θ' - μ) + μ' + yielding · lag:

    feedforward of μ', and yielding to the lag of the tip along the path, in θ [rad].

    Args:
        now: the estimate at this instant.
        output: coordinates along and across the path, at y_c.
        k5: K5, [1/s].
    """
    mu, mu_rate, _ = ca.vertsplit(now.memory["speed_chain"])
    per_theta = output.inverse[:, 0]
    offset, _ = output.frame.split(now.tip_offset * now.lateral, rate=True)
    lag = ca.dot(offset, per_theta) / ca.dot(per_theta, per_theta)
    return mu + (mu_rate + now.gains.yielding * lag) / ca.fmax(k5, TINY)


def rates(now: Compensation, speed: ca.SX, command: ca.SX) -> Fields:
    """Time derivatives of the memory: both filters and the absorber.

    Args:
        now: the estimate at this instant.
        speed: the user's wanted speed, [rad/s].
        command: y_c'', (3, 1), [m/s²].
    """
    memory, gains = now.memory, now.gains
    m, m_rate = ca.vertsplit(memory["absorber"])
    m_acceleration = now.omega1**2 * (4 * gains.damping**2 * now.excess - m)
    m_acceleration -= 4 * gains.damping * now.omega1 * m_rate
    quasi_static = -now.compliance * ca.dot(now.lateral, command)  # -C a
    return {
        "speed_chain": _filtered(memory["speed_chain"], speed, gains.shaping * now.omega1),
        "bend_chain": _filtered(memory["bend_chain"], quasi_static, gains.prediction * now.omega1),
        "absorber": ca.vertcat(m_rate, m_acceleration),
    }


def _filtered(chain: ca.SX, target: ca.SX, pole: ca.SX) -> ca.SX:
    """Rates of the chain (x, x', x'') of the filter (d/dt + pole)³ x = pole³ target."""
    x, rate, second = ca.vertsplit(chain)
    return ca.vertcat(rate, second, pole * (pole * (pole * (target - x) - 3 * rate) - 3 * second))


def torques(now: Compensation, rate: Fields, command: ca.SX) -> ca.SX:
    """Torques that give y_c the commanded acceleration, if the model is right, (3, 1), [N m].

        u = gain⁻¹ (y_c'' - drift - n'' e_θ),   n'' = ŵ'' - m''

    Args:
        now: the estimate at this instant.
        rate: derivatives of the memory, from `rates`.
        command: y_c'', (3, 1), [m/s²].

    Source: eq. (16) for y_c.
    """
    lead = 3 / (now.gains.prediction * now.omega1)
    w_hat_acceleration = rate["bend_chain"][1] + lead * rate["bend_chain"][2]
    shift_acceleration = w_hat_acceleration - rate["absorber"][1]
    wanted = command - now.drift - shift_acceleration * now.lateral
    return (1 / ca.det(now.gain)) * (ca.adj(now.gain) @ wanted)
