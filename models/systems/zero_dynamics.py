"""Zero dynamics: the motion of the modes while the controlled output stays exactly on its path.

With n coordinates, m inputs and p = m outputs, a prescribed y = h(q) leaves the n - m unactuated
coordinates f: η1 = (f, f') in the normal form (10). Where their linearization has an eigenvalue
with a positive real part, exact input-output linearization makes the internal motion diverge, while
the output stays on its path.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import combinations

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from onpath.models.arrays import Array
from onpath.models.systems.flexible_five_bar import flexible_five_bar
from onpath.models.systems.system import MechanicalSystem

Complex = NDArray[np.complex128]
HIGHEST_ALPHA = 1.5
_SCAN = 61  # values of α on a grid, before bisection
_HALVINGS = 16  # bisections
_NEUTRAL = 1e-7  # relative to the largest exponent: rounding error of undamped modes


@dataclass(frozen=True, slots=True, eq=False)
class ZeroDynamics:
    """The linearized internal dynamics of a system with as many outputs as inputs.

    Attributes:
        system: the system.
        function: (q, y', y'', parameters) -> A in η1' = A η1, (2 (n - m), 2 (n - m)), linearized
            about f' = 0 and the f in q.
        acceleration: the same arguments -> f'' at f' = 0, (n - m, 1). At rest it is 0 where the
            robot is in equilibrium.
    """

    system: MechanicalSystem
    function: ca.Function
    acceleration: ca.Function

    def exponents(self, q: Array, parameters: Array) -> Complex:
        """Eigenvalues of A at rest, by decreasing real part.

        Args:
            q: configurations, shape (k, n) or (n,).
            parameters: of the system, shape (k, size) or (size,).

        Returns:
            Shape (k, 2 (n - m)), [1/s]; infinity where the decoupling matrix is singular.
        """
        still = np.zeros(self.system.p)
        given = (q, still, still, parameters)
        rows = np.broadcast_shapes(*[np.atleast_2d(part).shape[:1] for part in given])
        inputs = [np.broadcast_to(part, (*rows, part.shape[-1])).T for part in given]
        size = 2 * (self.system.n - self.system.m)
        with np.errstate(divide="ignore", invalid="ignore"):
            columns = np.array(self.function(*inputs)).reshape(size, -1, size)
        matrices = columns.transpose(1, 0, 2).copy()
        singular = ~np.isfinite(matrices.reshape(len(matrices), -1)).all(axis=1)
        matrices[singular] = 0
        values: Complex = np.linalg.eigvals(matrices).astype(np.complex128)
        values[singular] = np.inf
        return np.take_along_axis(values, np.argsort(-values.real, axis=-1), axis=-1)

    def critical_alpha(self, q: Array, parameters: Array, highest: float = HIGHEST_ALPHA) -> float:
        """The smallest α at which the zero dynamics become unstable, at rest at q.

        It depends on the damping of the modes. For the flexible five-bar at home with three modes,
        it is 0.7227 with a damping ratio of 0.01 in each mode, and 0.7585 without damping: between
        these values it is the damping that destabilises.

        Args:
            q: shape (n,).
            parameters: of the system; their own α is ignored.
            highest: end of the search interval, which begins at 0.

        Returns:
            α, or infinity if the whole interval is stable.
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
        """For every α, whether an exponent has a positive real part, shape (k,) -> (k,)."""
        exponents = self.exponents(q, self.with_alpha(parameters, alphas))
        largest = np.abs(exponents).max(-1)
        return (exponents[:, 0].real > _NEUTRAL * largest) | np.isinf(largest)

    def with_alpha(self, parameters: Array, alphas: Array) -> Array:
        """The parameters with each α, shapes (size,) and (k,) -> (k, size)."""
        rows = np.tile(parameters, (alphas.size, 1))
        rows[:, self.system.parameter_names.index("alpha")] = alphas
        return rows


def zero_dynamics(
    system: MechanicalSystem, following: tuple[int, ...] | None = None
) -> ZeroDynamics:
    """Derive the zero dynamics of a system.

    With N(q) B = 0, the rows N (M v' + c) = 0 have no input. Of the coordinates, m follow the
    output, y'' = J v' + J' v, and the others are f. So these rows give f'' as a function of f, f',
    y' and y''. In the linearization, the coordinates that follow the output move with f so that dy
    = 0.

    Args:
        following: numbers of the m coordinates that follow the output, for which dh/dq must be
            invertible where it is evaluated; None: the first m, if it is invertible for these.

    Raises:
        ValueError: all coordinates have inputs, or the numbers of inputs and outputs differ.

    Source: eq. (10) with ξ = 0.
    """
    n, m = system.n, system.m
    if system.p != m or n == m:
        raise ValueError(f"{system.name}: no zero dynamics with {m} inputs, {system.p} outputs")
    y_rate, y_acceleration = ca.SX.sym("y_rate", m), ca.SX.sym("y_acceleration", m)
    jacobian = ca.jacobian(system.controlled_output, system.q)
    chosen = following or _independent(jacobian.T)
    led, free = _selection(n, chosen), _others(n, chosen)
    at_led, at_free = jacobian @ led.T, jacobian @ free.T
    follow = -ca.solve(at_led, at_free)  # dq_led / df at constant y
    turning = ca.jtimes(jacobian @ system.v, system.q, system.v)
    undriven = _annihilator(system.actuation)
    rows, bias = undriven @ system.mass, undriven @ system.bias
    carried = ca.solve(at_led, y_acceleration - turning)
    inertia = rows @ free.T + (rows @ led.T) @ follow
    f_acceleration = -ca.solve(inertia, bias + (rows @ led.T) @ carried)

    f_rate = free @ system.v
    velocity = led.T @ (ca.solve(at_led, y_rate) + follow @ f_rate) + free.T @ f_rate
    held = ca.substitute(f_acceleration, system.v, velocity)
    stiffness = ca.jacobian(held, system.q)
    stiffness = stiffness @ free.T + (stiffness @ led.T) @ follow
    n_f = n - m
    a = ca.blockcat(
        [[ca.SX(n_f, n_f), ca.SX.eye(n_f)], [stiffness, ca.jacobian(held, system.v) @ free.T]]
    )
    inputs = [system.q, y_rate, y_acceleration, system.parameters]
    still = ca.SX.zeros(n, 1)
    matrix, motion = (ca.substitute(ca.densify(x), system.v, still) for x in (a, held))
    return ZeroDynamics(
        system,
        function=ca.Function("zero_dynamics", inputs, [ca.cse(matrix)]),
        acceleration=ca.Function("internal_acceleration", inputs, [ca.cse(motion)]),
    )


def _selection(n: int, chosen: Iterable[int]) -> ca.SX:
    """The rows of the unit matrix (n, n) with these numbers."""
    numbers = list(chosen)
    rows = ca.SX(len(numbers), n)
    for row, number in enumerate(numbers):
        rows[row, number] = 1
    return rows


def _others(n: int, chosen: Sequence[int]) -> ca.SX:
    """The other rows of the unit matrix (n, n)."""
    return _selection(n, (i for i in range(n) if i not in chosen))


def _independent(matrix: ca.SX) -> tuple[int, ...]:
    """The first m rows of a matrix (n, m) that are independent, as far as its symbols tell."""
    n, m = matrix.shape
    every = combinations(range(n), m)
    rows = (each for each in every if not ca.det(_selection(n, each) @ matrix).is_zero())
    return next(rows, tuple(range(m)))


def _annihilator(actuation: ca.SX) -> ca.SX:
    """N of N B = 0, (n - m, n): -B₂ B₁⁻¹ at m independent rows B₁ of B, and 1 at the others."""
    driven = _independent(actuation)
    first, rest = _selection(actuation.size1(), driven), _others(actuation.size1(), driven)
    carried = ca.solve((first @ actuation).T, (rest @ actuation).T).T
    return rest - carried @ first


@lru_cache(maxsize=16)
def flexible_zero_dynamics(modes: int = 3, plant: str = "lagrangian") -> ZeroDynamics:
    """The zero dynamics of the flexible five-bar, derived once."""
    return zero_dynamics(flexible_five_bar(modes, plant))


def natural_rate(parameters: dict[str, float], first_root: float) -> float:
    """sqrt(EI / ρ) / l² = ω_1 / β_1², a unit for comparing the exponents of different beams, [1/s].

    Args:
        parameters: of the flexible five-bar, by name.
        first_root: β_1.
    """
    return parameters["omega1"] / first_root**2
