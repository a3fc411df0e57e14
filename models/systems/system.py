"""A controlled mechanical system, defined by symbols from which everything else is derived.

    M(q) v' + c(q, v) = B(q) u + J_h(q)^T F,   q' = v,   y = h(q),

with m inputs u and F the external force at the end-point. CasADi differentiates; nothing is derived
by hand.

Source: eqs. (1)-(3).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import casadi as ca
import numpy as np

from onpath.models.arrays import Array

GRAVITY = 9.81  # [m/s²]


@dataclass(frozen=True, slots=True, eq=False)
class MechanicalSystem:
    """The symbols of one robot: n coordinates, m inputs, p outputs. All vectors are columns.

    Attributes:
        name: as in files and on the command line.
        q: generalized coordinates, (n, 1).
        v: their velocities, (n, 1).
        tau: generalized forces B u + J_h^T F, (n, 1).
        actuation: B(q), (n, m); by default it selects the first m coordinates.
        parameters: numbers that may change without rebuilding, (k, 1).
        parameter_names: k names.
        coordinate_names: n names of q with units, such as "q1_rad", for file headers.
        mass: M(q), (n, n).
        bias: c(q, v), (n, 1).
        acceleration: v' = M⁻¹ (τ - c), (n, 1).
        drift: f_v(q, v) = -M⁻¹ c, (n, 1).
        input_gain: g_v(q) = M⁻¹ B, (n, m).
        output: h(q), the actual end-point, (p, 1), [m].
        controlled_output: the output for the control laws, (p, 1), [m]; usually h itself.
        energy: total mechanical energy ½ v^T M v + V(q), (1, 1), [J].
        modes: number of modal coordinates of a flexible link, which are the last of q; 0: all links
            are rigid. All other coordinates have encoders.
        posture: torques u0(q, v) of which a redundant robot, m > p, takes the part that does not
            move its end-point, (m, 1), see `linearization`; None: zeros.
        strength: torque of each motor per unit of the parameter `torque_limit`, m numbers, [N m].
        ends: generalized forces of buffers at the ends of its travel, in q and v, (n, 1). They act
            on the plant, and the controller does not know them. None: there are no buffers.
        n, m, p: numbers of coordinates, inputs and outputs.
    """

    name: str
    q: ca.SX
    v: ca.SX
    tau: ca.SX
    actuation: ca.SX
    parameters: ca.SX
    parameter_names: tuple[str, ...]
    coordinate_names: tuple[str, ...]
    mass: ca.SX
    bias: ca.SX
    acceleration: ca.SX
    drift: ca.SX
    input_gain: ca.SX
    output: ca.SX
    controlled_output: ca.SX
    energy: ca.SX
    strength: tuple[float, ...]
    modes: int = 0
    posture: ca.SX | None = None
    ends: ca.SX | None = None
    n: int = field(init=False)
    m: int = field(init=False)
    p: int = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "n", self.q.numel())
        object.__setattr__(self, "m", self.input_gain.size2())
        object.__setattr__(self, "p", self.output.numel())

    @property
    def motor_units(self) -> tuple[str, ...]:
        """The unit of each input: "N" if it acts on a coordinate that is a length, else "N m"."""
        along = [i for i, name in enumerate(self.coordinate_names) if name.endswith("_m")]
        turns = [all(self.actuation[i, j].is_zero() for i in along) for j in range(self.m)]
        return tuple(["N m" if turn else "N" for turn in turns])

    @property
    def joints(self) -> int:
        """Number of coordinates that encoders measure, the first of q."""
        return self.n - self.modes

    def torque_limits(self, limit: ca.SX) -> ca.SX:
        """The largest torque of each motor, (m, 1), [N m], for a value of `torque_limit`."""
        return ca.DM(self.strength) * limit

    def function(self, *names: str) -> ca.Function:
        """The function (q, v, parameters) -> the named attributes (all but `acceleration`)."""
        outputs = [getattr(self, name) for name in names]
        return ca.Function("_".join(names), [self.q, self.v, self.parameters], outputs)

    def with_rate(self, output: ca.SX) -> ca.Function:
        """The function (q, v, parameters) -> (y, (dy/dq) v) of an output y(q)."""
        rate = ca.jtimes(output, self.q, self.v)
        return ca.Function("with_rate", [self.q, self.v, self.parameters], [output, rate])

    def effort(self, q: ca.SX, u: ca.SX, parameters: ca.SX) -> ca.SX:
        """The generalized forces B(q) u of the inputs, (m, 1) -> (n, 1)."""
        inputs = [self.q, self.parameters]
        return ca.Function("actuation", inputs, [self.actuation])(q, parameters) @ u

    def input_rates(self, q: ca.SX, v: ca.SX, parameters: ca.SX) -> ca.SX:
        """The velocities B(q)^T v at which the inputs do work, (n, 1) -> (m, 1)."""
        inputs = [self.q, self.parameters]
        return ca.Function("actuation", inputs, [self.actuation])(q, parameters).T @ v

    def end_forces(self, q: ca.SX, v: ca.SX) -> ca.SX:
        """The generalized forces of the buffers, (n, 1)."""
        if self.ends is None:
            return ca.SX(self.n, 1)  # sparse, so that a sum with it has no further operation
        return ca.Function("ends", [self.q, self.v], [self.ends])(q, v)

    def compliance(self, q: ca.SX, parameters: ca.SX) -> ca.SX:
        """B(q)^T M⁻¹ B, (m, m): how `input_rates` change with the inputs."""
        inputs, spread = [self.q, self.parameters], self.actuation.T @ self.input_gain
        return ca.densify(ca.Function("compliance", inputs, [spread])(q, parameters))

    def parameter_vector(self, values: dict[str, float]) -> Array:
        """The values in the order of `parameter_names`, shape (k,)."""
        return np.array([values[name] for name in self.parameter_names])


def mechanical_system(
    *,
    name: str,
    q: ca.SX,
    v: ca.SX,
    parameters: ca.SX,
    parameter_names: tuple[str, ...],
    mass: ca.SX,
    inputs: int,
    output: ca.SX,
    potential_energy: ca.SX,
    friction: ca.SX | None = None,
    bias: ca.SX | None = None,
    coordinate_names: tuple[str, ...] | None = None,
    actuation: ca.SX | None = None,
    controlled_output: ca.SX | None = None,
    solve: Callable[[ca.SX, ca.SX], ca.SX] = ca.solve,
    modes: int = 0,
    posture: ca.SX | None = None,
    strength: tuple[float, ...] | None = None,
    ends: ca.SX | None = None,
) -> MechanicalSystem:
    """A system from M, V, friction, B and h.

    Args:
        mass: M(q), (n, n).
        inputs: m, with p <= m <= n.
        output: h(q), (p, 1), [m].
        potential_energy: V(q), [J].
        friction: generalized forces that oppose the motion, in v, (n, 1); None: none.
        bias: c(q, v): Coriolis, gravity, elastic and viscous terms, (n, 1). None: by Lagrange's
            equations, see `lagrange_bias`. If it is given, V is used for the energy only.
        coordinate_names: see `MechanicalSystem`; None: "q1_rad", "q2_rad", ...
        actuation: B(q), (n, m), of rank m; None: it selects the first m coordinates.
        controlled_output: (p, 1), [m]; None: h.
        solve: (M, R) -> M⁻¹ R; replace it where M has structure.
        modes, posture, ends: see `MechanicalSystem`.
        strength: see `MechanicalSystem`; None: 1 N m each.

    Raises:
        ValueError: m is less than p or greater than n, or B does not have the shape (n, m).

    Source: eqs. (1)-(3).
    """
    n, p = q.numel(), output.numel()
    actuation = ca.SX.eye(n)[:, : min(inputs, n)] if actuation is None else actuation
    if not p <= inputs <= n or actuation.shape != (n, inputs):
        raise ValueError(f"{name}: B must have {n} rows and {p} to {n} columns, one an input")
    if bias is None:
        kinetic, viscous = ca.dot(v, mass @ v) / 2, ca.SX(n, 1) if friction is None else friction
        bias = lagrange_bias(q, v, kinetic, potential_energy, viscous)
    tau = ca.SX.sym("tau", n)
    gains = solve(mass, ca.horzcat(-bias, actuation))
    return MechanicalSystem(
        name=name,
        q=q,
        v=v,
        tau=tau,
        actuation=actuation,
        parameters=parameters,
        parameter_names=parameter_names,
        coordinate_names=coordinate_names or tuple(f"q{i + 1}_rad" for i in range(n)),
        mass=mass,
        bias=bias,
        acceleration=solve(mass, tau - bias),
        drift=gains[:, 0],
        input_gain=gains[:, 1:],
        output=output,
        controlled_output=output if controlled_output is None else controlled_output,
        energy=0.5 * ca.dot(v, mass @ v) + potential_energy,
        modes=modes,
        posture=posture,
        strength=(1.0,) * inputs if strength is None else strength,
        ends=ends,
    )


def lagrange_bias(
    q: ca.SX, v: ca.SX, kinetic_energy: ca.SX, potential_energy: ca.SX, friction: ca.SX
) -> ca.SX:
    """c(q, v) = d/dt(dT/dv) at v' = 0, minus dT/dq, plus dV/dq, plus friction; (n, 1)."""
    momentum = ca.gradient(kinetic_energy, v)
    turning = ca.jtimes(momentum, q, v) - ca.gradient(kinetic_energy, q)
    return turning + ca.gradient(potential_energy, q) + friction


def coriolis(system: MechanicalSystem) -> ca.SX:
    """The Coriolis matrix C(q, v) by Christoffel's symbols, (n, n), for which M' - 2 C is skew.

        C_ij = ½ Σ_k (∂M_ij/∂q_k + ∂M_ik/∂q_j - ∂M_jk/∂q_i) v_k

    C v is the part of c(q, v) that is quadratic in the velocities.

    Source: any textbook of robotics, such as Siciliano et al., Robotics, 7.2.1.
    """
    n, q, v = system.n, system.q, system.v
    mass = ca.densify(system.mass)
    slopes = [ca.reshape(ca.jacobian(ca.vec(mass), q[k]), n, n) for k in range(n)]
    rate = ca.reshape(ca.jtimes(ca.vec(mass), q, v), n, n)
    forms = ca.horzcat(*[slope @ v for slope in slopes])  # column k: (∂M/∂q_k) v
    return (rate + forms - forms.T) / 2


def decoupling_matrix(system: MechanicalSystem) -> ca.Function:
    """The function (q, parameters) -> J g_v with J = dh/dq of the controlled output, shape (p, m).

    The virtual output has a relative degree where this matrix has rank p. It is square for m = p.

    Source: Theorem 2.1, eq. (11).
    """
    jacobian = ca.jacobian(system.controlled_output, system.q)
    matrix = ca.densify(jacobian @ system.input_gain)
    return ca.Function("decoupling_matrix", [system.q, system.parameters], [matrix])


def conditioning_of(matrix: ca.SX) -> ca.SX:
    """`conditioning` of a matrix with three rows as an expression, (3, m) -> (1, 1).

    With the eigenvalues λ1 >= λ2 >= λ3 of A Aᵀ it is sqrt(det(A Aᵀ) / (λ1² λ2)), which is accurate
    also where λ3 is nearly 0.

    Source: O. K. Smith, Eigenvalues of a symmetric 3 x 3 matrix, Comm. ACM 4 (1961).
    """
    square = matrix @ matrix.T
    mean = ca.trace(square) / 3
    rest = square - mean * ca.SX.eye(3)
    size = ca.sqrt(ca.fmax(ca.dot(rest, rest) / 6, 1e-60))
    cosine = ca.fmax(ca.fmin(ca.det(rest) / (2 * size**3), 1), -1)
    angle = ca.acos(cosine) / 3
    first, third = (mean + 2 * size * ca.cos(angle + turn) for turn in (0.0, 2 * np.pi / 3))
    second = 3 * mean - first - third
    product = (
        ca.fabs(ca.det(matrix)) if matrix.size2() == 3 else ca.sqrt(ca.fmax(ca.det(square), 0))
    )
    return product / (first * ca.sqrt(second))


def conditioning(matrices: Array) -> Array:
    """σ_min / σ_max of matrices, shape (..., p, m) -> (...), in [0, 1]; 0 where rank is lost.

    Source: the rank test (11) as a number.
    """
    values = np.linalg.svd(matrices, compute_uv=False)
    largest = values[..., 0]
    return np.where(largest > 0, values[..., -1] / np.where(largest > 0, largest, 1.0), 0.0)
