"""Zero dynamics: what the modes do while the controlled output is held exactly on its path.

With n coordinates, m inputs and p = m outputs, holding y = h(q) leaves the n - m coordinates f that
no motor moves: eta_1 = (f, f') in the normal form (10). Where their linearization has an exponent
with a positive real part, exact input-output linearization lets the inside blow up, however well
the output sits on the path.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from onpath.models.arrays import Array
from onpath.models.systems.flexible_five_bar import flexible_five_bar
from onpath.models.systems.system import MechanicalSystem

Complex = NDArray[np.complex128]
HIGHEST_ALPHA = 1.5
_SCAN = 61  # values of alpha looked at before bisection
_HALVINGS = 16
_NEUTRAL = 1e-7  # of the largest exponent: rounding, when nothing is damped


@dataclass(frozen=True, slots=True, eq=False)
class ZeroDynamics:
    """The linearized internal dynamics of a system with as many outputs as inputs.

    Attributes:
        system: whose.
        function: (q, y', y'', parameters) -> A with eta_1' = A eta_1, (2 (n - m), 2 (n - m)),
            about f' = 0 and the f in q.
    """

    system: MechanicalSystem
    function: ca.Function

    def exponents(
        self,
        q: Array,
        parameters: Array,
        y_rate: Array | None = None,
        y_acceleration: Array | None = None,
    ) -> Complex:
        """Eigenvalues of A, frozen at this instant of the motion; real part falling.

        Args:
            q: configurations, shape (k, n) or (n,).
            parameters: the system's, shape (k, size) or (size,).
            y_rate, y_acceleration: of the output along its path, (k, p) or (p,); None: at rest.

        Returns:
            Shape (k, 2 (n - m)), [1/s].
        """
        still = np.zeros(self.system.p)
        given = (q, still if y_rate is None else y_rate)
        given += (still if y_acceleration is None else y_acceleration, parameters)
        rows = np.broadcast_shapes(*[np.atleast_2d(part).shape[:1] for part in given])
        inputs = [np.broadcast_to(part, (*rows, part.shape[-1])).T for part in given]
        size = 2 * (self.system.n - self.system.m)
        columns = np.array(self.function(*inputs)).reshape(size, -1, size)
        values: Complex = np.linalg.eigvals(columns.transpose(1, 0, 2)).astype(np.complex128)
        return np.take_along_axis(values, np.argsort(-values.real, axis=-1), axis=-1)

    def critical_alpha(self, q: Array, parameters: Array, highest: float = HIGHEST_ALPHA) -> float:
        """The smallest positive alpha at which an exponent crosses to the right, at rest at q.

        It depends on how the modes are damped: the flexible five-bar at home, with three modes, has
        0.7227 with the same damping ratio 0.01 in each and 0.7585 without any. In between it is
        damping that destabilises.

        Args:
            q: shape (n,).
            parameters: the system's; their own alpha does not matter.
            highest: where the search ends.

        Returns:
            alpha, or infinity if all of [0, highest] is stable.
        """
        scan = np.linspace(0.0, highest, _SCAN)
        unstable = np.flatnonzero(self._grows(q, parameters, scan))
        if not unstable.size:
            return math.inf
        if unstable[0] == 0:
            return 0.0
        low, high = scan[unstable[0] - 1], scan[unstable[0]]
        for _ in range(_HALVINGS):
            middle = (low + high) / 2
            grows = self._grows(q, parameters, np.array([middle]))[0]
            low, high = (low, middle) if grows else (middle, high)
        return float((low + high) / 2)

    def _grows(self, q: Array, parameters: Array, alphas: Array) -> NDArray[np.bool_]:
        exponents = self.exponents(q, self.with_alpha(parameters, alphas))
        return exponents[:, 0].real > _NEUTRAL * np.abs(exponents).max(-1)

    def with_alpha(self, parameters: Array, alphas: Array) -> Array:
        """The parameters for each alpha, (size,) and (k,) -> (k, size)."""
        rows = np.tile(parameters, (alphas.size, 1))
        rows[:, self.system.parameter_names.index("alpha")] = alphas
        return rows


def zero_dynamics(system: MechanicalSystem) -> ZeroDynamics:
    """Derive them.

    The rows of M v' + c = B u that no input enters, with v' of the actuated joints from
    y'' = J v' + J' v, leave f'' as a function of f, f', y' and y''; joints follow f by dy = 0.

    Raises:
        ValueError: no coordinate without a motor, or more or fewer outputs than inputs.

    Source: eq. (10) with xi = 0.
    """
    n, m = system.n, system.m
    if system.p != m or n == m:
        raise ValueError(f"{system.name}: no zero dynamics with {m} inputs, {system.p} outputs")
    y_rate, y_acceleration = ca.SX.sym("y_rate", m), ca.SX.sym("y_acceleration", m)
    jacobian = ca.jacobian(system.controlled_output, system.q)
    joints, modes = jacobian[:, :m], jacobian[:, m:]
    follow = -ca.solve(joints, modes)  # of the joints, per motion of f
    turning = ca.jtimes(jacobian @ system.v, system.q, system.v)
    rows = system.mass[m:, :]
    carried = ca.solve(joints, y_acceleration - turning)
    inertia = rows[:, m:] + rows[:, :m] @ follow
    f_acceleration = -ca.solve(inertia, system.bias[m:] + rows[:, :m] @ carried)

    f_rate = system.v[m:]
    velocity = ca.vertcat(ca.solve(joints, y_rate) + follow @ f_rate, f_rate)
    held = ca.substitute(f_acceleration, system.v, ca.vertcat(velocity[:m], f_rate))
    stiffness = ca.jacobian(held, system.q)
    stiffness = stiffness[:, m:] + stiffness[:, :m] @ follow
    n_f = n - m
    a = ca.blockcat([[ca.SX(n_f, n_f), ca.SX.eye(n_f)], [stiffness, ca.jacobian(held, f_rate)]])
    at_rest = ca.substitute(ca.densify(a), f_rate, ca.SX.zeros(n_f))
    inputs = [system.q, y_rate, y_acceleration, system.parameters]
    return ZeroDynamics(system, ca.Function("zero_dynamics", inputs, [ca.cse(at_rest)]))


@lru_cache(maxsize=16)
def flexible_zero_dynamics(modes: int = 3, plant: str = "lagrangian") -> ZeroDynamics:
    """Those of the flexible five-bar, derived once."""
    return zero_dynamics(flexible_five_bar(modes, plant))


def natural_rate(parameters: dict[str, float], first_root: float) -> float:
    """sqrt(EI / rho) / l^2 = omega_1 / beta_1^2, the unit in which exponents are compared, [1/s].

    Args:
        parameters: the flexible five-bar's by name.
        first_root: beta_1.
    """
    return parameters["omega1"] / first_root**2
