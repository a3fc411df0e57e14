"""A controlled mechanical system, defined once by symbols; all else is derived from it.

The class of systems is eqs. (1)-(3):  M(q) v' + c(q, v) = B u + J_h(q)^T F,  y = h(q),
with F the external force at the end-point. CasADi differentiates; nothing is derived by hand.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import casadi as ca
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class MechanicalSystem:
    """Symbols of one robot. Columns throughout; n coordinates, m inputs, p outputs.

    Attributes:
        name: how the robot is called in files and on the command line.
        q: generalized coordinates, (n, 1); the first m of them are the actuated joints.
        v: their velocities, (n, 1).
        parameters: numbers that a run may change without rebuilding, (k, 1).
        parameter_names: k names.
        drift: f_v(q, v), accelerations without input or external force, (n, 1).
        input_gain: g_v(q), accelerations per input, (n, m).
        force_gain: accelerations per external force at the end-point, (n, p).
        output: h(q), the actual end-point, (p, 1), [m].
        controlled_output: what a controller is given instead of h, (p, 1), [m]; often h itself.
        energy: total mechanical energy, (1, 1), [J].
        mass: M(q), (n, n).
    """

    name: str
    q: ca.SX
    v: ca.SX
    parameters: ca.SX
    parameter_names: tuple[str, ...]
    drift: ca.SX
    input_gain: ca.SX
    force_gain: ca.SX
    output: ca.SX
    controlled_output: ca.SX
    energy: ca.SX
    mass: ca.SX

    @property
    def n(self) -> int:
        """Number of degrees of freedom."""
        return self.q.numel()

    @property
    def m(self) -> int:
        """Number of inputs."""
        return self.input_gain.size2()

    @property
    def p(self) -> int:
        """Dimension of the output."""
        return self.output.numel()

    def function(self, *names: str) -> ca.Function:
        """Numeric function (q, v, parameters) -> the named attributes, for use outside the loop."""
        outputs = [getattr(self, name) for name in names]
        return ca.Function("_".join(names), [self.q, self.v, self.parameters], outputs)

    def parameter_vector(self, values: dict[str, float]) -> Array:
        """`values` by name, in the order of `parameters`, shape (k,)."""
        return np.array([values[name] for name in self.parameter_names])


def lagrangian_system(
    *,
    name: str,
    q: ca.SX,
    v: ca.SX,
    parameters: ca.SX,
    parameter_names: tuple[str, ...],
    kinetic_energy: ca.SX,
    potential_energy: ca.SX,
    dissipation: ca.SX,
    inputs: int,
    output: ca.SX,
    controlled_output: ca.SX | None = None,
    solve: Callable[[ca.SX, ca.SX], ca.SX] = ca.solve,
) -> MechanicalSystem:
    """Equations of motion from the energies; the first `inputs` coordinates are actuated.

    Args:
        kinetic_energy: T(q, v), [J]; quadratic in v.
        potential_energy: V(q), [J].
        dissipation: generalized friction forces opposing motion, (n, 1).
        solve: returns M^-1 R for (M, R); replace it where M has structure.

    Source: eqs. (1)-(3).
    """
    momentum = ca.gradient(kinetic_energy, v)
    mass = ca.jacobian(momentum, v)
    coriolis = ca.jacobian(momentum, q) @ v - ca.gradient(kinetic_energy, q)
    bias = coriolis + ca.gradient(potential_energy, q) + dissipation
    n = q.numel()
    selection = ca.SX.eye(n)[:, :inputs]
    gains = solve(mass, ca.horzcat(-bias, selection, ca.jacobian(output, q).T))
    return MechanicalSystem(
        name=name,
        q=q,
        v=v,
        parameters=parameters,
        parameter_names=parameter_names,
        drift=gains[:, 0],
        input_gain=gains[:, 1 : 1 + inputs],
        force_gain=gains[:, 1 + inputs :],
        output=output,
        controlled_output=output if controlled_output is None else controlled_output,
        energy=kinetic_energy + potential_energy,
        mass=mass,
    )


def decoupling_matrix(system: MechanicalSystem) -> ca.Function:
    """(q, parameters) -> dh/dq g_v(q), shape (p, m), whose rank the test (11) asks for.

    Source: Theorem 2.1, eq. (11).
    """
    jacobian = ca.jacobian(system.controlled_output, system.q)
    matrix = ca.densify(jacobian @ system.input_gain)
    return ca.Function("decoupling_matrix", [system.q, system.parameters], [matrix])


def conditioning(matrices: Array) -> Array:
    """The rank test (11) as a number in [0, 1]: 0 where a matrix loses rank.

    Smallest over largest singular value, shape (..., p, m) -> (...).
    """
    values = np.linalg.svd(matrices, compute_uv=False)
    largest = values[..., 0]
    return np.where(largest > 0, values[..., -1] / np.where(largest > 0, largest, 1.0), 0.0)
