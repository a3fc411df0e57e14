"""Identification of any robot whose equations of motion are linear in its parameters π.

With the momentum p = M(q) v, M v' + c = dp/dt + r with r = c - (dM/dt) v. Both p = P(q, v) π + p_0
and r = R(q, v) π + r_0 are linear in π, and P and R follow by differentiation. Multiplied by a
window w of finite length and integrated by parts, so that no acceleration is needed,

    (-<w', P> + <w, R>) π = <w, B u + J_h^T F> + <w', p_0> - <w, r_0>,   <w, x> = ∫ w(t) x(t) dt.

Dry friction is c sign(r) with the rate r of a motor; where that is slow, nothing is assumed of it
(see slow_friction.py).

Columns of the regressor that depend on others belong to parameters that the record cannot
distinguish. A QR decomposition with column pivoting chooses independent columns. For each of them,
the sum of its parameter and a combination of the others, a base parameter, is estimated.

Source: Khalil and Dombre, Modeling, Identification and Control of Robots, 12.3 and 12.4.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

import casadi as ca
import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from onpath.models.arrays import Array
from onpath.models.studies.identification import (
    BUMP,
    ENOUGH,
    EXACT,
    FEWEST,
    LAGS,
    LEAST_MOTION,
    OVERLAP,
    SHORTEST,
    WORST_CONDITION,
    bump,
    least_squares,
    step_means,
)
from onpath.models.studies.slow_friction import SlowFriction, slow_friction, slow_rows
from onpath.models.systems.system import MechanicalSystem

INDEPENDENT = 2.5  # windows that tell as much of white noise as one without overlap
FEWEST_FREE = 3.0  # degrees of freedom, with fewer of which there is no interval
SLOW, SLOW_SHARE = 0.2, 0.25  # [rad/s] or [m/s], and share of a motor's largest rate
TURNED = 0.02  # [rad/s] or [m/s], width of the smooth sign of dry friction
HARDLY = 1e-3  # rms of a column without slow friction, relative to before, that counts as zero
UNMOVED = 1e-9  # rms of a column, relative to the largest, below which it counts as zero
LATEST = 0.1  # [s], largest delay or lead of logged torques
DELAY = "delay"  # name of the delay among the estimates
NEGLIGIBLE = 1e-3  # smaller shares of a parameter in a combination are left out
Sums = tuple[tuple[str, float], ...]


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
    """An estimated parameter, or with `others` its sum with multiples of those (SI).

    Attributes:
        name: of the parameter.
        value: estimate.
        error: its standard error.
        low, high: interval that contains the true value with a probability of 95 %, whatever the
            friction of slow motors; infinite if the record is too short for one.
        others: (name, multiple) of each further parameter of the sum.
    """

    name: str
    value: float
    error: float
    low: float
    high: float
    others: tuple[tuple[str, float], ...] = ()

    @property
    def is_dry_friction(self) -> bool:
        """Whether it is the dry friction of a motor alone."""
        return not self.others and self.name[:1] == "c" and self.name[1:].isdigit()

    def label(self) -> str:
        """For instance "a1 + 0.0484 g2"."""
        parts = (f" {'-' if c < 0 else '+'} {abs(c):.3g} {name}" for name, c in self.others)
        return self.name + "".join(parts)


@dataclass(frozen=True, slots=True, eq=False)
class Estimate:
    """The result of an identification.

    Attributes:
        found: the estimates, in the order of the robot's parameters.
        unexcited: parameters on which the record does not depend.
        unexplained: rms of the filtered torque that the model does not explain, as a share.
        delay: by which the logged torques are late, [s]; None if the motion does not show it.
        times: middle of each window, from the beginning of its record, shape (windows,), [s].
        torque: filtered torque of each coordinate, shape (windows, n), without what any friction of
            slow motors would explain.
        residual: the part of it that the model does not explain, shape (windows, n).
    """

    found: tuple[BaseParameter, ...]
    unexcited: tuple[str, ...]
    unexplained: float
    delay: BaseParameter | None
    times: Array
    torque: Array
    residual: Array


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

    The logged torques of the motors may be late or early by an unknown time, the same in all
    records, which is estimated with the parameters.

    Args:
        geometry: the system's parameters; only those on which h and B depend are used.

    Raises:
        ValueError: the model is not linear, or a record is too short, too coarse, or without
            motion.
    """
    model = linear_model(system)
    parts = [_equations(system, model, record, geometry) for record in records]
    names = (*model.names, *(f"c{i + 1}" for i in range(system.m)))
    late = _delay(parts)
    dry = _solved(names, parts, late)
    if any(record.measured for record in records):
        return dry
    without = [replace(part, slow=None) for part in parts]  # there is no friction to stick
    smooth = _solved(names[: len(model.names)], without, late)
    return smooth if smooth.unexplained <= max(ENOUGH * dry.unexplained, EXACT) else dry


def unexplained_of(
    system: MechanicalSystem, found: Estimate, records: list[MotionRecord], geometry: Array
) -> float:
    """The share of the torque in other records that an estimate does not explain, rms.

    Parameters that it leaves out count as 0, also where these records depend on them. The torques
    are as late as in its own records.

    Args:
        geometry: as for `estimate`.

    Raises:
        ValueError: as `estimate`.
    """
    model = linear_model(system)
    parts = [_equations(system, model, record, geometry) for record in records]
    names = (*model.names, *(f"c{i + 1}" for i in range(system.m)))
    known = {each.name: each.value for each in found.found}
    values = np.array([known.get(name, 0.0) for name in names])
    late = 0.0 if found.delay is None else found.delay.value
    torque = _torque(parts, late)
    left = _without_slow(parts, torque - _columns(parts) @ values)
    return _share(left, _without_slow(parts, torque))


@dataclass(frozen=True, slots=True, eq=False)
class _Equations:
    """The equations that a record gives, one for each coordinate and window.

    Attributes:
        dt: time step of the record, [s].
        columns: regressor, shape (windows, n, k + m); the last m are for dry friction.
        known: what the right-hand side has besides the motors' torques, (windows, n).
        motors: column of B for each motor, (rows, n, m).
        u: logged torques, (rows, m).
        starts: first row of each window. All torques are known there, however late they are.
        slow: the unknown friction of slow motors, or None if there is none.
    """

    dt: float
    columns: Array
    known: Array
    motors: Array
    u: Array
    starts: NDArray[np.int_]
    slow: SlowFriction | None

    def torque(self, late: float) -> Array:
        """Right-hand side if the torques were logged `late` seconds after they acted."""
        edges = np.arange(len(self.u) + 1.0)
        moved = step_means(edges, self.u, edges + late / self.dt)
        held = bump(self.dt)[3]
        acting = _filtered(np.einsum("rnm,rm->rn", self.motors, moved), held, self.dt)
        return acting[self.starts // _stride(self.dt)] + self.known

    def middles(self) -> Array:
        """Middle of each window, from the beginning of the record, [s]."""
        half = len(bump(self.dt)[3]) / 2
        return np.asarray(self.dt * (self.starts + half), dtype=float)


def _filtered(signal: Array, kernel: Array, dt: float) -> Array:
    """<kernel, signal> for all windows, whose first axis replaces that of the rows."""
    weight = bump(dt)[0]
    windows = sliding_window_view(signal, len(weight), axis=0)[:: _stride(dt)]
    return np.asarray(windows[..., : len(kernel)] @ kernel, dtype=float)


def _stride(dt: float) -> int:
    """Rows from one window to the next."""
    return len(bump(dt)[3]) // OVERLAP


def _equations(
    system: MechanicalSystem, model: LinearModel, record: MotionRecord, geometry: Array
) -> _Equations:
    _check(record)
    dt, rows, n, size = record.dt, len(record.q), system.n, len(model.names)
    weight, rate, _, held = bump(dt)
    terms, offset = model.terms.map(rows)(record.q.T, record.v.T)
    slopes = terms.full().reshape(n, rows, 2 * size).swapaxes(0, 1)
    offsets = offset.full().reshape(n, rows, 2).swapaxes(0, 1)
    plant, none = np.tile(geometry[:, None], rows), 0 * record.force.T

    def effort(u: Array, force: Array) -> Array:
        return np.asarray(model.effort.map(rows)(record.q.T, u, force, plant).full().T, dtype=float)

    columns = _filtered(slopes[..., size:], weight, dt) - _filtered(slopes[..., :size], rate, dt)
    known = _filtered(effort(0 * record.u.T, record.force.T), held, dt)
    known += _filtered(offsets[..., 0], rate, dt) - _filtered(offsets[..., 1], weight, dt)
    motors = np.stack([effort(np.tile(u[:, None], rows), none) for u in np.eye(system.m)], axis=2)
    rates = np.einsum("rnm,rn->rm", motors, record.v)
    dry = motors * (rates / np.sqrt(rates**2 + TURNED**2))[:, None]
    columns = np.concatenate([columns, _filtered(dry, held, dt)], axis=2)
    starts = np.arange(len(columns)) * _stride(dt)
    reach = (LATEST + BUMP / FEWEST) / dt
    kept = (starts >= reach) & (starts + len(held) + reach <= rows)
    bounds = np.minimum(SLOW, SLOW_SHARE * np.abs(rates).max(axis=0))
    slow = slow_rows(rates, bounds, dt)
    return _Equations(
        dt=dt,
        columns=columns[kept],
        known=known[kept],
        motors=motors,
        u=record.u,
        starts=starts[kept],
        slow=slow_friction(motors, slow, dt, starts[kept], held),
    )


def _check(record: MotionRecord) -> None:
    if not 0 < record.dt <= BUMP / FEWEST:
        raise ValueError(f"samples every {record.dt:g} s: at most {BUMP / FEWEST:g} s apart")
    seconds = len(record.q) * record.dt
    if seconds < SHORTEST:
        raise ValueError(f"{seconds:.2g} s of motion: at least {SHORTEST:g} s are needed")
    if np.ptp(record.q, axis=0).max() < LEAST_MOTION:
        raise ValueError("the robot hardly moves")


def _columns(parts: list[_Equations]) -> Array:
    """Regressor of all records, (windows, n, k + m)."""
    return np.concatenate([part.columns for part in parts])


def _torque(parts: list[_Equations], late: float) -> Array:
    """Right-hand side of all records, (windows, n)."""
    return np.concatenate([part.torque(late) for part in parts])


def _without_slow(parts: list[_Equations], values: Array) -> Array:
    """Values of all records, (windows, n, ...), without what friction of slow motors explains."""
    each = np.split(values, np.cumsum([len(part.starts) for part in parts])[:-1])
    return np.concatenate(
        [part.slow.removed(x) if part.slow else x for part, x in zip(parts, each, strict=True)]
    )


def _share(left: Array, torque: Array) -> float:
    """Ratio of their rms; 0 without torques."""
    total = float(np.sqrt(np.mean(torque**2)))
    return float(np.sqrt(np.mean(left**2))) / total if total else 0.0


def _delay(parts: list[_Equations]) -> float:
    """The delay of the logged torques with which the model explains most of them, [s]."""
    from scipy.optimize import minimize_scalar  # slow to import

    _, scaled, _ = _scaled(parts, range(parts[0].columns.shape[2]))
    basis = np.linalg.qr(scaled.reshape(-1, scaled.shape[-1]))[0]

    def unexplained(late: float) -> float:
        torque = _without_slow(parts, _torque(parts, late)).ravel()
        return _share(torque - basis @ (basis.T @ torque), torque)

    steps = np.linspace(-LATEST, LATEST, 21)
    best = float(min(steps, key=unexplained))
    away = float(steps[1] - steps[0])
    found = minimize_scalar(
        unexplained,
        bounds=(max(best - away, -LATEST), min(best + away, LATEST)),
        method="bounded",
        options={"xatol": 1e-6},
    )
    return float(found.x)


def dependent_names(
    system: MechanicalSystem, records: list[MotionRecord], geometry: Array, names: tuple[str, ...]
) -> tuple[str, ...]:
    """Parameters that the records do not tell: unexcited, or only told in sums with others.

    Args:
        geometry: see `estimate`.
        names: of the parameters that matter, in any order.
    """
    model = linear_model(system)
    known = (*model.names, *(f"c{i + 1}" for i in range(system.m)))
    used = [i for i, name in enumerate(known) if name in names]
    parts = [_equations(system, model, record, geometry) for record in records]
    moved, scaled, _ = _scaled(parts, used)
    chosen, others, shares = _independent(scaled.reshape(-1, len(moved)))
    mixed = {moved[j] for j in others}
    mixed |= {moved[i] for i, row in zip(chosen, shares, strict=True) if _significant(row)}
    return tuple(known[used[j]] for j in range(len(used)) if j not in moved or j in mixed)


def conditioning(
    system: MechanicalSystem, records: list[MotionRecord], geometry: Array
) -> tuple[int, float]:
    """Number of parameters, or sums of some, that motions tell, and the condition number of these.

    The columns of the regressor have an rms of 1; what friction of slow motors hides is left out.

    Args:
        geometry: see `estimate`.
    """
    model = linear_model(system)
    parts = [_equations(system, model, record, geometry) for record in records]
    _, scaled, _ = _scaled(parts, range(parts[0].columns.shape[2]))
    sizes = np.linalg.svd(scaled.reshape(-1, scaled.shape[-1]), compute_uv=False)
    told = sizes[sizes > sizes[0] / WORST_CONDITION] if len(sizes) else sizes
    return len(told), float(told[0] / told[-1]) if len(told) else np.inf


def _significant(shares: Array) -> bool:
    return bool(np.any(np.abs(shares) > NEGLIGIBLE))


def _scaled(parts: list[_Equations], used: Sequence[int]) -> tuple[list[int], Array, Array]:
    """The columns that tell something where motors are not slow.

    Args:
        used: the columns to take.

    Returns:
        Their places in `used`, these columns without what slow friction explains, with an rms of 1,
        and the rms that they had.
    """
    whole = _columns(parts)[..., used]
    columns = _without_slow(parts, whole)
    before, size = (np.sqrt(np.mean(each**2, axis=(0, 1))) for each in (whole, columns))
    told = (before > UNMOVED * before.max(initial=0.0)) & (size > HARDLY * before)
    moved = np.flatnonzero(told).tolist()
    return moved, columns[..., moved] / size[moved], size[moved]


def _solved(names: tuple[str, ...], parts: list[_Equations], late: float) -> Estimate:
    """Estimates of the base parameters and the delay, with the first columns of the regressor."""
    moved, scaled, scale = _scaled(parts, range(len(names)))
    if not moved:
        raise ValueError("the robot hardly moves")
    change = _change(parts, late)
    shows = not _depends(change, scaled)
    if late and not shows:
        return _solved(names, parts, 0.0)
    torque = _without_slow(parts, _torque(parts, late))
    chosen, others, shares = _independent(scaled.reshape(-1, len(moved)))
    jerk = float(np.sqrt(np.mean(change**2))) or 1.0
    regressor = scaled[..., chosen]
    if shows:
        regressor = np.concatenate([regressor, -change[..., None] / jerk], axis=2)
    values, _ = least_squares(regressor, torque)
    residual = np.asarray(torque - regressor @ values, dtype=float)
    unknown = sum(part.slow.torques for part in parts if part.slow)
    errors = _errors(regressor, residual, unknown)
    wide = errors * _quantile(regressor, unknown)

    def parameter(i: int, name: str, size: float, sums: Sums = (), shift: float = 0.0):
        value = float(values[i]) / size + shift
        error, half = float(errors[i]) / size, float(wide[i]) / size
        return BaseParameter(name, value, error, value - half, value + half, sums)

    found = list[tuple[int, BaseParameter]]()
    for i, place in enumerate(chosen):
        sums = tuple(
            (names[moved[j]], float(share) * scale[j] / scale[place])
            for j, share in zip(others, shares[i], strict=True)
            if abs(share) > NEGLIGIBLE
        )
        found.append((moved[place], parameter(i, names[moved[place]], scale[place], sums)))
    return Estimate(
        found=tuple(each for _, each in sorted(found, key=lambda pair: pair[0])),
        unexcited=tuple(name for j, name in enumerate(names) if j not in moved),
        unexplained=_share(residual, torque),
        delay=parameter(len(chosen), DELAY, jerk, shift=late) if shows else None,
        times=np.concatenate([part.middles() for part in parts]),
        torque=torque,
        residual=residual,
    )


def _change(parts: list[_Equations], late: float) -> Array:
    """Derivative of the right-hand side with respect to the delay, shape (windows, n), [N m/s]."""
    step = max(*(part.dt for part in parts), 1e-3)
    after, before = _torque(parts, late + step), _torque(parts, late - step)
    return _without_slow(parts, (after - before) / (2 * step))


def _depends(change: Array, scaled: Array) -> bool:
    """Whether the effect of a delay is that of a change of parameters."""
    flat, column = scaled.reshape(-1, scaled.shape[-1]), change.ravel()
    left = column - flat @ np.linalg.lstsq(flat, column)[0]
    return bool(np.linalg.norm(left) <= np.linalg.norm(column) / WORST_CONDITION)


def _errors(regressor: Array, residual: Array, removed: int) -> Array:
    """Standard errors of the least-squares estimates, shape (unknowns,).

    Windows overlap, and friction leaves residuals where motors turn round: they are correlated, and
    not stationary. The covariance is therefore A⁻¹ S A⁻¹ with A = X^T X and

        S = Σ_l w_l Σ_k s_k s_{k+l}^T,   s_k = X_k^T r_k,   w_l = 1 - |l| / LAGS.

    Source: Newey and West, Econometrica 55, 1987.

    Args:
        regressor: X, shape (windows, n, unknowns).
        residual: r, shape (windows, n).
        removed: torques that were removed from the equations.
    """
    flat = regressor.reshape(-1, regressor.shape[-1])
    inverse = np.linalg.inv(flat.T @ flat)
    scores = np.einsum("kji,kj->ki", regressor, residual)
    middle = scores.T @ scores
    for lag in range(1, min(LAGS, len(scores))):
        part = (1 - lag / LAGS) * scores[:-lag].T @ scores[lag:]
        middle += part + part.T
    lost = residual.size / INDEPENDENT / _freedom(regressor, removed)
    return np.sqrt(np.maximum(np.diag(inverse @ middle @ inverse), 0.0) * lost)


def _freedom(regressor: Array, removed: int) -> float:
    """Degrees of freedom, at least 1: independent windows, less the unknowns."""
    windows, coordinates, unknowns = regressor.shape
    return max((windows * coordinates - removed) / INDEPENDENT - unknowns, 1.0)


def _quantile(regressor: Array, removed: int) -> float:
    """Half of a 95 % interval in standard errors: Student's t, or infinity if there is none."""
    from scipy.stats import t  # slow to import

    free = _freedom(regressor, removed)
    return float(t.ppf(0.975, free)) if free >= FEWEST_FREE else np.inf


def _independent(regressor: Array) -> tuple[list[int], list[int], Array]:
    """Independent columns, the others, and the shares (chosen, others) of the former in these."""
    from scipy.linalg import qr, solve_triangular  # slow to import

    triangle, order = qr(regressor, mode="r", pivoting=True)
    diagonal = np.abs(np.diag(triangle))
    rank = int(np.sum(diagonal > diagonal[0] / WORST_CONDITION))
    shares = solve_triangular(triangle[:rank, :rank], triangle[:rank, rank:])
    return order[:rank].tolist(), order[rank:].tolist(), np.asarray(shares, dtype=float)
