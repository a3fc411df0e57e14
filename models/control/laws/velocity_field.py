"""Passive velocity field control: the path as a current that carries the robot and never pushes."""

from __future__ import annotations

import casadi as ca

from onpath.models.control.laws.law import ControlAction, Law, View
from onpath.models.control.laws.references import rate_at
from onpath.models.paths.projection import LocalCurve
from onpath.models.systems.system import coriolis

FLYWHEEL = "flywheel"  # rate of the fictitious flywheel, [rad/s]; 0: not started yet
INERTIA = 0.01  # M_f, of the fictitious flywheel, [kg m²]
LEAST_SHARE = 0.02  # least energy of the flywheel in the field, as a share of all


def velocity_field(view: View) -> ControlAction:
    """Torques of passive velocity field control, (n, 1), [N m].

    The field leads along the path and back to it, with J = dh/dq, λ the distance and N the normal
    (in space λ N = y - σ; a distance from the path's plane is led back in the same way):

        V(q) = J⁻¹ (ω σ'(θ) - k λ N).

    A fictitious flywheel, M_f v_f' = τ_f, stores energy. With M̄ = diag(M, M_f), q̄' = (v, v_f) and
    V̄ = (V, V_f), V_f is such that ½ V̄ᵀ M̄ V̄ = Ē is constant. With P = M̄ V̄, p = M̄ q̄' and
    w = M̄ V̄' + C̄ V̄,

        τ̄ = [(w Pᵀ - P wᵀ) / (2 Ē) + γ (P pᵀ - p Pᵀ)] q̄'.

    Both matrices are skew, so that τ̄ᵀ q̄' = 0: the law gives the robot and the flywheel together no
    energy. Whoever pulls at the end-point gets no more than they store. Gravity and friction are
    compensated by the model: u = τ + c - C v. Where V alone has nearly Ē, V_f is kept from 0.

    k is `field_gain`, γ `field_circulation`, Ē `field_energy`.

    Source: Li and Horowitz, Passive velocity field control of mechanical manipulators, [2].
    """
    gains, v = view.own_gains, view.v
    energy = gains["field_energy"]
    mass, gyration, bias = _dynamics(view)
    field, field_rate = _field(view, gains["field_gain"])
    stored = ca.dot(field, mass @ field)
    spare = ca.fmax(2 * energy - stored, LEAST_SHARE * 2 * energy)
    wheel_field = ca.sqrt(spare / INERTIA)
    # d/dt (Vᵀ M V) = 2 Vᵀ (M V' + C V), because M' - 2 C is skew
    momentum_rate = mass @ field_rate + gyration @ field
    wheel_rate = -ca.dot(field, momentum_rate) / (INERTIA * wheel_field)
    started = view.clock.memory[FLYWHEEL]
    wheel = ca.if_else(started == 0, ca.sqrt(2 * energy / INERTIA), started)

    velocity = ca.vertcat(v, wheel)
    wanted = ca.vertcat(mass @ field, INERTIA * wheel_field)  # P
    momentum = ca.vertcat(mass @ v, INERTIA * wheel)  # p
    change = ca.vertcat(momentum_rate, INERTIA * wheel_rate)  # w
    torque = skew_action(change, wanted, velocity) / (2 * energy)
    torque += gains["field_circulation"] * skew_action(wanted, momentum, velocity)
    return ControlAction(
        torque=torque[:-1] + bias - gyration @ v,
        theta_ref=view.output.theta,
        memory={FLYWHEEL: wheel + view.clock.interval * torque[-1] / INERTIA},
    )


def skew_action(a: ca.SX, b: ca.SX, x: ca.SX) -> ca.SX:
    """(a bᵀ - b aᵀ) x, (n, 1), which is orthogonal to x."""
    return a * ca.dot(b, x) - b * ca.dot(a, x)


def _dynamics(view: View) -> tuple[ca.SX, ca.SX, ca.SX]:
    """M (n, n), the Coriolis matrix C (n, n), and c (n, 1), by the controller's model."""
    system = view.system
    outputs = [system.mass, coriolis(system), system.bias]
    function = ca.Function("dynamics", [system.q, system.v, system.parameters], outputs)
    return function(view.q, view.v, view.model)


def _field(view: View, gain: ca.SX) -> tuple[ca.SX, ca.SX]:
    """The field V and its rate along the motion, each (n, 1), [rad/s], [rad/s²].

    With z' = ω σ' - k λ N the wanted velocity of the end-point,

        V = J⁻¹ z',   V' = J⁻¹ (z'' - J' V),   z'' = ω σ'' θ' - k (λ' N + λ N'),   N' = -φ' T,

    where φ' is the rate of the angle of the tangent T. ω is taken as constant.
    """
    system, output, closest, frame = view.system, view.output, view.closest, view.frame
    gap, off = frame.split(view.y)
    gap_rate, off_rate = frame.split(view.y_rate, rate=True)
    beside = _beside(closest, gap - closest.sigma, gap_rate, output.theta_rate)
    rate = rate_at(view)
    wanted = rate * closest.first - gain * beside[0]
    wanted_rate = rate * output.theta_rate * closest.second - gain * beside[1]
    jacobian = ca.jacobian(system.controlled_output, system.q)
    jacobian_rate = ca.reshape(ca.jtimes(ca.vec(jacobian), system.q, system.v), *jacobian.shape)
    inputs = [system.q, system.v, system.parameters]
    function = ca.Function("kinematics", inputs, [ca.inv_minor(jacobian), jacobian_rate])
    back, turning = function(view.q, view.v, view.model)
    field = back @ frame.join(wanted, -gain * off, rate=True)
    return field, back @ (frame.join(wanted_rate, -gain * off_rate, rate=True) - turning @ field)


def _beside(
    closest: LocalCurve, gap: ca.SX, gap_rate: ca.SX, theta_rate: ca.SX
) -> tuple[ca.SX, ca.SX]:
    """λ N and its rate, (d, 1), [m], [m/s]; in space y - σ, which is normal to T too.

    Args:
        gap, gap_rate: y - σ and y', (d, 1).
        theta_rate: θ', [rad/s].
    """
    if gap.numel() == 3:
        return gap, gap_rate - closest.first * theta_rate
    length2 = ca.dot(closest.first, closest.first)
    tangent = closest.first / ca.sqrt(length2)
    normal = ca.vertcat(-tangent[1], tangent[0])
    distance, distance_rate = ca.dot(normal, gap), ca.dot(normal, gap_rate)
    cross = closest.first[0] * closest.second[1] - closest.first[1] * closest.second[0]
    turn = cross / length2 * theta_rate
    return distance * normal, distance_rate * normal - distance * turn * tangent


LAW = Law(
    name="velocity_field",
    label="Velocity field",
    text="A current along the curve that carries the robot, and never gives a hand more energy than"
    " it has stored.",
    source="Li and Horowitz, Passive velocity field control, reference [2]",
    command=velocity_field,
    aim="theta",
    gains=("field_gain", "field_circulation", "field_energy"),
    memory=((FLYWHEEL, 1),),
    square=True,
    commands_acceleration=False,
    pace="energy",
    good="Pulled off the curve, it gives the hand less energy than any law that keeps a timetable.",
    limits="It regulates its energy and not its speed, so that it comes too early or too late"
    " even when nobody holds it.",
)
