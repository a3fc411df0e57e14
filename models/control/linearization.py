"""Exact linearization: the torques that give the output a commanded acceleration."""

from __future__ import annotations

import casadi as ca

from onpath.models.systems.system import MechanicalSystem


def linearization(
    system: MechanicalSystem, q: ca.SX, v: ca.SX, model: ca.SX, acceleration: ca.SX
) -> ca.SX:
    """Inputs u that give the controlled output the acceleration y'', if the model is right, (m, 1).

    With J = dh/dq, f_v and g_v of (2), and J' v the part of y'' that is quadratic in the
    velocities,

        y'' = J (f_v + g_v u) + J' v,   so that   D u = r,   D = J g_v,   r = y'' - J f_v - J' v.

    For m = p this has one solution u = D⁻¹ r, which for n = m and B = I is u = M J⁻¹ (y'' - J' v) +
    c. For m > p the decoupling matrix D is wide. Of all solutions, the one whose generalized forces
    τ = B u have the smallest norm weighted by M⁻¹, τ^T M⁻¹ τ, is taken:

        u = W⁻¹ D^T (D W⁻¹ D^T)⁻¹ r,   W = B^T M⁻¹ B.

    For B = I it is u = J^T (J M⁻¹ J^T)⁻¹ r. It leaves the motion within the null space of J to the
    robot's own dynamics: c is not compensated there. A robot with a `posture` u0 adds the part of
    u0 that does not move the end-point, v₁∥ in (5):

        u = u0 + W⁻¹ D^T (D W⁻¹ D^T)⁻¹ (r - D u0).

    Args:
        system: the equations of motion.
        q, v: configuration and velocity, (n, 1).
        model: the plant's parameters as the controller assumes them, (k, 1).
        acceleration: commanded y'', (p, 1), [m/s²].

    Returns:
        Inputs, (m, 1), [N m] for torques.

    Source: eqs. (5), (16); for m > p, Khatib, A unified approach for motion and force control of
    robot manipulators, IEEE Journal of Robotics and Automation 3 (1987), 43-53.
    """
    jacobian = ca.jacobian(system.controlled_output, system.q)
    turning = ca.jtimes(jacobian @ system.v, system.q, system.v)
    wanted = ca.SX.sym("wanted", system.p)
    if system.n == system.m == system.p and system.actuation.is_eye():
        u = system.mass @ _solve(jacobian, wanted - turning) + system.bias
    else:
        gain = ca.densify(jacobian @ system.input_gain)
        rest, posture = wanted - jacobian @ system.drift - turning, system.posture
        if posture is None or system.m == system.p:
            u = _least_solution(system, gain, rest)
        else:
            u = posture + _least_solution(system, gain, rest - gain @ posture)
    inputs = [system.q, system.v, system.parameters, wanted]
    return ca.Function("linearization", inputs, [u])(q, v, model, acceleration)


def _least_solution(system: MechanicalSystem, gain: ca.SX, rhs: ca.SX) -> ca.SX:
    """The solution of D u = r; if there are many, the one of least norm: see `linearization`."""
    if system.m == system.p:
        return _solve(gain, rhs)
    spread = gain.T  # W⁻¹ D^T
    if system.n == system.m and system.actuation.is_eye():
        spread = ca.jacobian(system.controlled_output, system.q).T  # W = M⁻¹ and D = J M⁻¹
    else:
        spread = _solve(ca.densify(system.actuation.T @ system.input_gain), spread)
    return spread @ _solve(ca.densify(gain @ spread), rhs)


def _solve(matrix: ca.SX, rhs: ca.SX) -> ca.SX:
    """A⁻¹ r of a small dense matrix as adj(A) r / det(A), which needs a single division."""
    return (1 / ca.det(matrix)) * (ca.adj(matrix) @ rhs)


def admissible_along(base: ca.SX, per_along: ca.SX, along: ca.SX, limit: ca.SX) -> ca.SX:
    """v_par clipped to the interval in which all torques u = A v_par + B are admissible, (1, 1).

        lower = max_i min((±limit - B_i) / A_i),   upper = min_i max((±limit - B_i) / A_i)

    So a torque limit first reduces the motion along the path, and leaves the motion across it as
    commanded as long as possible. If no v_par is admissible, the middle of the two bounds is taken,
    and the torques are clipped afterwards.

    Args:
        base: B, the torques at v_par = 0, (m, 1), [N m].
        per_along: A, (m, 1), [N m s²/rad].
        along: v_par, [rad/s²].
        limit: of each torque, (m, 1), or of all, (1, 1), [N m].
    """
    small = 1e-9
    slope = ca.if_else(ca.fabs(per_along) > small, per_along, small)
    one, other = (limit - base) / slope, (-limit - base) / slope
    lower, upper = ca.mmax(ca.fmin(one, other)), ca.mmin(ca.fmax(one, other))
    middle = (lower + upper) / 2
    return ca.fmin(ca.fmax(along, ca.fmin(lower, middle)), ca.fmax(upper, middle))
