"""Identification of any robot whose equations of motion are linear in its parameters π.

With the momentum p = M(q) v, M v' + c = dp/dt + r with r = c - (dM/dt) v. Both p = P(q, v) π + p_0
and r = R(q, v) π + r_0 are linear in π, and P and R follow by differentiation. Multiplied by a
window w of finite length and integrated by parts, so that no acceleration is needed,

    (-<w', P> + <w, R>) π = <w, B u + J_h^T F> + <w', p_0> - <w, r_0>,   <w, x> = ∫ w(t) x(t) dt.

Columns of the regressor that depend on others belong to parameters that the record cannot
distinguish. A QR decomposition with column pivoting chooses independent columns. For each of them,
the sum of its parameter and a combination of the others, a base parameter, is estimated.

Source: Khalil and Dombre, Modeling, Identification and Control of Robots, 12.3 and 12.4.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache

import casadi as ca
import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from onpath.models.arrays import Array
from onpath.models.studies.identification import (
    BUMP,
    ENOUGH,
    EXACT,
    FEWEST,
    LEAST_MOTION,
    OVERLAP,
    SHORTEST,
    WORST_CONDITION,
    bump,
    least_squares,
    standard_errors,
)
from onpath.models.systems.forces import DRY_VELOCITY
from onpath.models.systems.system import MechanicalSystem

UNMOVED = 1e-9  # rms of a column, relative to the largest, below which it counts as zero
LATE = 1e-3  # [s], from which torques count as late
NEGLIGIBLE = 1e-3  # smaller shares of a parameter in a combination are left out


@dataclass(frozen=True, slots=True, eq=False)
class MotionRecord:
    """Measured motion, torque and force at uniform time steps.

    Attributes:
        dt: time step, [s].
        q, v: coordinates and their rates, shape (rows, n).
        u: torque of the motors, constant over each step, (rows, m), [N m].
        force: at the end-point, (rows, p), [N].
        measured: whether the joint angles are sensor readings, with rates from a filter.
    """

    dt: float
    q: Array
    v: Array
    u: Array
    force: Array
    measured: bool = False


@dataclass(frozen=True, slots=True)
class BaseParameter:
    """An estimated parameter, or with `others` its sum with multiples of those (SI)."""

    name: str
    value: float
    error: float
    others: tuple[tuple[str, float], ...] = ()

    def label(self) -> str:
        """For instance "a1 + 0.0484 g2"."""
        parts = (f" {'-' if c < 0 else '+'} {abs(c):.3g} {name}" for name, c in self.others)
        return self.name + "".join(parts)


@dataclass(frozen=True, slots=True)
class Estimate:
    """The result of an identification.

    Attributes:
        found: the estimates, in the order of the robot's parameters.
        unexcited: parameters on which the record does not depend.
        unexplained: rms of the filtered torque that the model does not explain, as a share.
        late: apparent delay of the logged torques behind the motion, [s]; 0 unless a delay explains
            much more.
    """

    found: tuple[BaseParameter, ...]
    unexcited: tuple[str, ...]
    unexplained: float
    late: float = 0.0


@dataclass(frozen=True, slots=True, eq=False)
class LinearModel:
    """P, p_0, R, r_0 and B u + J_h^T F as functions, for many rows at once.

    Attributes:
        names: of the parameters π, those on which M and c depend.
        terms: (q, v) -> [P, R] (n, 2 k) and [p_0, r_0] (n, 2).
        effort: (q, u, F, parameters) -> B u + J_h^T F, (n, 1).
    """

    names: tuple[str, ...]
    terms: ca.Function
    effort: ca.Function


@lru_cache(maxsize=8)
def linear_model(system: MechanicalSystem) -> LinearModel:
    """The regressors of a robot.

    Raises:
        ValueError: the equations of motion are not linear in parameters, or depend on none.
    """
    q, v, symbols = system.q, system.v, system.parameters
    momentum = system.mass @ v
    rest = system.bias - ca.jtimes(momentum, q, v)
    both = ca.vertcat(momentum, rest)
    slopes = ca.jacobian(both, symbols)
    if not ca.jacobian(ca.vec(ca.densify(slopes)), symbols).is_zero():
        raise ValueError(f"{system.name}: its equations of motion are not linear in its parameters")
    used = [j for j in range(symbols.numel()) if not slopes[:, j].is_zero()]
    if not used:
        raise ValueError(f"{system.name}: its equations of motion depend on no parameter")
    chosen = ca.horzcat(*[slopes[:, j] for j in used])
    known = ca.substitute(both, symbols, ca.SX.zeros(symbols.numel()))
    n = system.n
    columns = ca.horzcat(chosen[:n, :], chosen[n:, :])
    offsets = ca.horzcat(known[:n], known[n:])
    u, force = ca.SX.sym("u", system.m), ca.SX.sym("force", system.p)
    tau = system.actuation @ u + ca.jtimes(system.output, q, force, True)
    return LinearModel(
        tuple(system.parameter_names[j] for j in used),
        ca.Function("terms", [q, v], [ca.densify(columns), ca.densify(offsets)]),
        ca.Function("effort", [q, u, force, symbols], [ca.densify(tau)]),
    )


def estimate(system: MechanicalSystem, records: list[MotionRecord], geometry: Array) -> Estimate:
    """Least-squares estimates from all records, with dry friction c_i if it explains much more.

    Args:
        geometry: the system's parameters; only those on which h and B depend are used.

    Raises:
        ValueError: the model is not linear, or a record is too short, too coarse, or without
            motion.
    """
    model = linear_model(system)
    parts = [_equations(system, model, record, geometry) for record in records]
    columns, torque, change = (np.concatenate(each) for each in zip(*parts, strict=True))
    names = (*model.names, *(f"c{i + 1}" for i in range(system.m)))
    smooth = _solved(names[: len(model.names)], columns[..., : len(model.names)], torque)
    dry = _solved(names, columns, torque)
    enough = smooth.unexplained <= max(ENOUGH * dry.unexplained, EXACT)
    best, used = (smooth, len(model.names)) if enough else (dry, len(names))
    return replace(best, late=_lateness(columns[..., :used], torque, change))


def _lateness(columns: Array, torque: Array, change: Array) -> float:
    """Delay of the motors' logged torque, [s]; 0 unless a delay explains much more.

    If B u lags by d, it was B u + d (B u)' to first order, so that -<w, (B u)'> is the column of d.
    """
    flat = columns.reshape(-1, columns.shape[-1])
    sizes = np.sqrt(np.mean(flat**2, axis=0))
    moved = sizes > UNMOVED * sizes.max()
    basis, singular, _ = np.linalg.svd(flat[:, moved] / sizes[moved], full_matrices=False)
    basis = basis[:, singular > singular[0] / WORST_CONDITION] * np.sqrt(len(flat))
    scale = float(np.sqrt(np.mean(change**2))) or 1.0
    whole = np.concatenate([basis.reshape(*change.shape, -1), -change[..., None] / scale], axis=2)
    without = torque - whole[..., :-1] @ least_squares(whole[..., :-1], torque)[0]
    values, _ = least_squares(whole, torque)
    late, explained = float(values[-1]) / scale, ENOUGH * np.linalg.norm(torque - whole @ values)
    return late if abs(late) > LATE and np.linalg.norm(without) > explained else 0.0


def _equations(
    system: MechanicalSystem, model: LinearModel, record: MotionRecord, geometry: Array
) -> tuple[Array, Array, Array]:
    """Regressor (windows, n, k + m), right-hand side, and <w, (B u)'>.

    The last m columns of the regressor are for dry friction.
    """
    _check(record)
    weight, rate, _, held = bump(record.dt)
    step, rows, n = len(held) // OVERLAP, len(record.q), system.n

    def filtered(signal: Array, kernel: Array) -> Array:
        windows = sliding_window_view(signal, len(weight), axis=0)[::step]
        return np.asarray(windows[..., : len(kernel)] @ kernel, dtype=float)

    terms, known = model.terms.map(rows)(record.q.T, record.v.T)
    size = len(model.names)
    slopes = terms.full().reshape(n, rows, 2 * size).swapaxes(0, 1)
    offsets = known.full().reshape(n, rows, 2).swapaxes(0, 1)
    plant = np.tile(geometry[:, None], rows)
    tau = model.effort.map(rows)(record.q.T, record.u.T, record.force.T, plant).full().T
    columns = filtered(slopes[..., size:], weight) - filtered(slopes[..., :size], rate)
    right = filtered(tau, held) + filtered(offsets[..., 0], rate)
    right -= filtered(offsets[..., 1], weight)
    friction = np.zeros((len(right), n, system.m))
    for motor, u in enumerate(np.eye(system.m)):
        unit = np.tile(u[:, None], rows)
        column = model.effort.map(rows)(record.q.T, unit, 0 * record.force.T, plant).full().T
        rate = np.sum(column * record.v, axis=1, keepdims=True)
        friction[..., motor] = filtered(column * rate / np.sqrt(rate**2 + DRY_VELOCITY**2), held)
    motors = model.effort.map(rows)(record.q.T, record.u.T, 0 * record.force.T, plant).full().T
    change = -filtered(motors, np.diff(weight) / record.dt)  # <w, τ'> = -<w', τ>, by steps
    return np.concatenate([columns, friction], axis=2), right, change


def _check(record: MotionRecord) -> None:
    if not 0 < record.dt <= BUMP / FEWEST:
        raise ValueError(f"samples every {record.dt:g} s: at most {BUMP / FEWEST:g} s apart")
    seconds = len(record.q) * record.dt
    if seconds < SHORTEST:
        raise ValueError(f"{seconds:.2g} s of motion: at least {SHORTEST:g} s are needed")
    if np.ptp(record.q, axis=0).max() < LEAST_MOTION:
        raise ValueError("the robot hardly moves")


def _solved(names: tuple[str, ...], columns: Array, torque: Array) -> Estimate:
    """Estimates of the base parameters from a regressor (windows, n, k)."""
    scale = np.sqrt(np.mean(columns**2, axis=(0, 1)))
    moved = [j for j in range(len(names)) if scale[j] > UNMOVED * scale.max()]
    scaled = columns[..., moved] / scale[moved]
    chosen, others, shares = _independent(scaled.reshape(-1, len(moved)))
    regressor = scaled[..., chosen]
    values, _ = least_squares(regressor, torque)
    residual: Array = np.asarray(torque - regressor @ values, dtype=float)
    errors = standard_errors(regressor, residual)
    found = list[tuple[int, BaseParameter]]()
    for i, place in enumerate(chosen):
        size = scale[moved[place]]
        sums = [(moved[j], float(share)) for j, share in zip(others, shares[i], strict=True)]
        combined = tuple(
            (names[j], share * scale[j] / size) for j, share in sums if abs(share) > NEGLIGIBLE
        )
        known = BaseParameter(names[moved[place]], values[i] / size, errors[i] / size, combined)
        found.append((moved[place], known))
    total = float(np.sqrt(np.mean(torque**2)))
    left = float(np.sqrt(np.mean(residual**2)))
    return Estimate(
        tuple(each for _, each in sorted(found, key=lambda pair: pair[0])),
        tuple(name for j, name in enumerate(names) if j not in moved),
        left / total if total else 0.0,
    )


def _independent(regressor: Array) -> tuple[list[int], list[int], Array]:
    """Independent columns, the others, and the shares (chosen, others) of the former in these."""
    from scipy.linalg import qr, solve_triangular  # slow to import

    triangle, order = qr(regressor, mode="r", pivoting=True)
    diagonal = np.abs(np.diag(triangle))
    rank = int(np.sum(diagonal > diagonal[0] / WORST_CONDITION))
    shares = solve_triangular(triangle[:rank, :rank], triangle[:rank, rank:])
    return order[:rank].tolist(), order[rank:].tolist(), np.asarray(shares, dtype=float)
