"""Passive velocity field control: the path as a current that carries the robot and never pushes."""

from __future__ import annotations

import casadi as ca

from onpath.models.control.laws.law import ControlAction, Law, View, own_gain
from onpath.models.control.laws.references import rate_at
from onpath.models.paths.projection import LocalCurve
from onpath.models.systems.system import coriolis

FLYWHEEL = "flywheel"  # energy of the fictitious flywheel, [J]; 0: not started yet
BEFORE = "joints"  # q at the last evaluation, [rad]; two or three numbers are used
FIELD_SHARE = 0.8  # largest energy of the field, as a share of all
RESERVE = 0.01  # energy that stays in the flywheel, as a share of all
TINY = 1e-12  # [J], keeps quotients finite where nothing moves


def velocity_field(view: View) -> ControlAction:
    """Torques of passive velocity field control, (n, 1), [N m].

    The field leads along the path and back to it, with J = dh/dq, λ the distance and N the normal
    (in space λ N = y - σ; a distance from the path's plane is led back in the same way):

        V(q) = J⁻¹ (ω σ'(θ) - k λ N),   scaled down where ½ Vᵀ M V would exceed 0.8 Ē.

    A fictitious flywheel of inertia 1 kg m² and rate v_f stores the energy E_f = ½ v_f². With
    M̄ = diag(M, 1) and V̄ = (V, V_f), V_f is such that ½ V̄ᵀ M̄ V̄ = Ē is constant. `_turning` finds the
    torque τ that turns the velocity into the field and takes its work from the flywheel.

    Gravity g and the viscous friction B v are compensated by the model. In an interval T the
    torques do the work u · Δq, and the flywheel pays for it exactly:

        u = s (τ + B v) + g,   E_f⁺ = E_f - u · Δq + ΔU + Δqᵀ B Δq / T,

    with U the potential energy. The last term is at most the loss by friction, so that ½ vᵀ M v +
    E_f never rises by more than the work of a hand. To keep E_f above 0, s ≤ 1 bounds the work to
    come, with |v|² = vᵀ M v and |τ|² = τᵀ M⁻¹ τ:

        s W ≤ E_f - Ē / 100,   W = T |τ| (|v| + sqrt(2 Ē)) + T vᵀ B v / 4.

    This suffices as long as nobody changes |v| by more than sqrt(2 Ē) within T. With the right
    model, exact sensors and no delay, a hand thus gets no more than ½ vᵀ M v + E_f from the robot.

    k is `field_gain`, γ `field_circulation`, Ē `field_energy`.

    Source: Li and Horowitz, Passive velocity field control of mechanical manipulators, [2]; the
    flywheel as an energy tank that bounds the torque: Franken et al., Bilateral telemanipulation
    with time delays: a two-layer approach combining passivity and transparency, IEEE Transactions
    on Robotics 27 (2011), 741-756.
    """
    energy, interval = view.own_gains["field_energy"], view.clock.interval
    q, v = view.measured
    mass, gyration, friction, weight = _dynamics(view)
    speed2, loss = ca.dot(v, mass @ v), friction @ view.v
    stored = _flywheel(view, friction, speed2 / 2)
    torque, size = _turning(view, mass, gyration, ca.sqrt(2 * ca.fmax(stored, 0)))
    work = interval * size * (ca.sqrt(speed2) + ca.sqrt(2 * energy))
    work += interval * ca.dot(view.v, loss) / 4
    spare = ca.fmax(stored - RESERVE * energy, 0)
    share = ca.fmin(1, spare / ca.fmax(work, TINY))
    return ControlAction(
        torque=share * (torque + loss) + weight,
        theta_ref=view.output.theta,
        memory={FLYWHEEL: stored, BEFORE: ca.vertcat(q, ca.SX(3 - q.numel(), 1))},
    )


def _turning(view: View, mass: ca.SX, gyration: ca.SX, wheel: ca.SX) -> tuple[ca.SX, ca.SX]:
    """τ, (n, 1), [N m], which turns the velocity into the field, and |τ| = sqrt(τᵀ M⁻¹ τ).

    With P = M̄ V̄, p = M̄ q̄', q̄' = (v, v_f) and w = M̄ V̄' + C̄ V̄, the torque of [2] is

        τ̄ = K q̄',   K = a Pᵀ - P aᵀ,   a = w / (2 Ē) - γ p,

    which has no power, because K is skew. When sampled, it has none if it is evaluated for the
    velocity in the middle of the interval T, to which V̄, p and w are predicted,

        τ̄ = K (q̄' + T/2 M̄⁻¹ (τ̄ - C̄ q̄')) = a α - P β.

    α and β solve two linear equations, whose determinant is at least 1, by Cauchy and Schwarz.

    Args:
        mass, gyration: M and C, (n, n).
        wheel: v_f, [rad/s].
    """
    energy, circulation = view.own_gains["field_energy"], view.own_gains["field_circulation"]
    half, (_, v) = view.clock.interval / 2, view.measured
    field, momentum_rate = _field(view, mass, gyration)
    wheel_field = ca.sqrt(2 * energy - ca.dot(field, mass @ field))
    wheel_rate = -ca.dot(field, momentum_rate) / wheel_field
    wanted = ca.vertcat(mass @ field, wheel_field)  # P
    change = ca.vertcat(momentum_rate, wheel_rate)  # w
    turn = change / (2 * energy) - circulation * ca.vertcat(mass @ view.v, wheel)  # a
    solved = ca.solve(mass, ca.horzcat(turn[:-1], gyration @ v))
    eased = ca.vertcat(solved[:, 0], turn[-1])  # M̄⁻¹ a
    velocity = ca.vertcat(v - half * solved[:, 1], wheel)  # in the middle, if τ were 0
    one, other = ca.dot(wanted, velocity), ca.dot(turn, velocity)
    mixed, turned = half * ca.dot(wanted, eased), half * ca.dot(turn, eased)
    det = 1 - mixed**2 + 2 * energy * half * turned
    alpha = ((1 + mixed) * one - half * 2 * energy * other) / det
    beta = ((1 - mixed) * other + turned * one) / det
    torque = (alpha * turn - beta * wanted)[:-1]
    acceleration = alpha * eased[:-1] - beta * field
    return torque, ca.sqrt(ca.fmax(ca.dot(torque, acceleration), 0))


def _flywheel(view: View, friction: ca.SX, kinetic: ca.SX) -> ca.SX:
    """E_f after the work since the last evaluation, [J]; at the start Ē - ½ vᵀ M v or Ē / 5.

    Args:
        friction: B, (n, n).
        kinetic: ½ vᵀ M v, [J].
    """
    energy, memory = view.own_gains["field_energy"], view.clock.memory
    system, (q, _) = view.system, view.measured
    last = memory[BEFORE][: q.numel()]
    moved = q - last
    rest = ca.SX.zeros(system.n)
    potential = ca.Function("potential", [system.q, system.v, system.parameters], [system.energy])
    gained = potential(q, rest, view.model) - potential(last, rest, view.model)
    gained += ca.dot(moved, friction @ moved) / view.clock.interval
    paid = memory[FLYWHEEL] - ca.dot(view.held, moved) + gained
    fresh = ca.fmax(energy - kinetic, (1 - FIELD_SHARE) * energy)
    return ca.if_else(memory[FLYWHEEL] == 0, fresh, paid)


def _dynamics(view: View) -> tuple[ca.SX, ca.SX, ca.SX, ca.SX]:
    """M, the Coriolis matrix C and B of the friction B v, (n, n), and the weight g, (n, 1)."""
    system = view.system
    bias, rest = ca.densify(system.bias), ca.SX.zeros(system.n)
    friction, weight = (
        ca.substitute(each, system.v, rest) for each in (ca.jacobian(bias, system.v), bias)
    )
    outputs = [system.mass, coriolis(system), friction, weight]
    function = ca.Function("dynamics", [system.q, system.v, system.parameters], outputs)
    return function(view.q, view.v, view.model)


def _field(view: View, mass: ca.SX, gyration: ca.SX) -> tuple[ca.SX, ca.SX]:
    """The field V, (n, 1), [rad/s], and M V' + C V, the rate of its momentum, (n, 1), [N m].

    With z' = ω σ' - k λ N the wanted velocity of the end-point,

        V = J⁻¹ z',   V' = J⁻¹ (z'' - J' V),   z'' = ω σ'' θ' - k (λ' N + λ N'),   N' = -φ' T,

    where φ' is the rate of the angle of the tangent T. ω is taken as constant. Where V is scaled
    down, Vᵀ M V is constant, and its rate 2 Vᵀ (M V' + C V) is 0, because M' - 2 C is skew.
    """
    system, output, closest, frame = view.system, view.output, view.closest, view.frame
    gain = view.own_gains["field_gain"]
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
    field_rate = back @ (frame.join(wanted_rate, -gain * off_rate, rate=True) - turning @ field)
    momentum, momentum_rate = mass @ field, mass @ field_rate + gyration @ field
    doubled = ca.fmax(ca.dot(field, momentum), TINY)
    scale = ca.sqrt(ca.fmin(1, 2 * FIELD_SHARE * view.own_gains["field_energy"] / doubled))
    slowing = (scale < 1) * ca.dot(field, momentum_rate) / doubled
    return scale * field, scale * (momentum_rate - slowing * momentum)


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
    text="A current along the curve that carries the robot, and with the right model and exact"
    " sensors gives a hand no more energy than it has stored.",
    source="Li and Horowitz, Passive velocity field control, reference [2]",
    command=velocity_field,
    aim="theta",
    gains=(),
    own_gains=(
        own_gain(
            "field_gain",
            10.0,
            "1/s",
            (0, 40, 0.5),
            "velocity field: how quickly it leads back to the path",
            label="Field to path",
        ),
        own_gain(
            "field_circulation",
            30.0,
            "1/(J s)",
            (0, 100, 1),
            "velocity field: how quickly the velocity turns into the field",
            label="Field turns",
        ),
        own_gain(
            "field_energy",
            0.2,
            "J",
            (0.02, 2, 0.01),
            "velocity field: energy of the robot and the flywheel together",
            label="Field energy",
        ),
    ),
    memory=((FLYWHEEL, 1), (BEFORE, 3)),
    square=True,
    commands_acceleration=False,
    pace="energy",
    good="Pulled off the curve, it gives the hand less energy than any law that keeps a timetable.",
    limits="It regulates its energy and not its speed: pulled back and let go, it goes on"
    " faster than wanted.",
    objection="Its authors bound no torque, since in continuous time their flywheel is"
    " never empty.",
)
