"""Estimates, with intervals, of the parameters on which the equations of recorded motions depend.

The equations (see linear_model.py) are linear in the parameters, and solved by least squares.

Columns of the regressor that depend on others belong to parameters that the records cannot
distinguish. A QR decomposition with column pivoting chooses independent columns. For each of them,
the sum of its parameter and a combination of the others, a base parameter, is estimated.

Source: Khalil and Dombre, Modeling, Identification and Control of Robots, 12.3 and 12.4.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from onpath.models.arrays import Array
from onpath.models.studies.identification import (
    ENOUGH,
    EXACT,
    LAGS,
    WORST_CONDITION,
    least_squares,
)
from onpath.models.studies.linear_model import (
    LATEST,
    MotionRecord,
    RecordEquations,
    columns_of,
    dry_columns_of,
    linear_model,
    record_equations,
    torque_of,
    without_slow,
)
from onpath.models.systems.system import MechanicalSystem

BLOCKS = 12  # parts of the motion, of which each is left out in turn
BLOCK_QUANTILE = 2.201  # Student's t of 11 degrees of freedom at 97.5 %
INDEPENDENT = 2.5  # windows that tell as much of white noise as one without overlap
FEWEST_WINDOWS = 2.0  # fewer windows that tell a value give it no interval
FEWEST_FREE = 3.0  # degrees of freedom, with fewer of which there is no interval
HARDLY = 0.1  # share of a column that friction of slow motors leaves, below which it counts as zero
MUCH = 0.05  # unexplained share of the torque above which values have no interval
UNMOVED = 1e-9  # rms of a column, relative to the largest, below which it counts as zero
DELAY = "delay"  # name of the delay among the estimates
NEGLIGIBLE = 1e-3  # smaller shares of a parameter in a combination are left out
Sums = tuple[tuple[str, float], ...]


@dataclass(frozen=True, slots=True)
class BaseParameter:
    """An estimated parameter, or with `others` its sum with multiples of those (SI).

    Attributes:
        name: of the parameter.
        value: estimate.
        error: its standard error.
        low, high: interval that contains the true value with a probability of 95 %, whatever the
            friction of slow motors, however wide the transition of dry friction about standstill,
            and whether torques are smooth or constant from row to row; infinite if the record is
            too short for one, if fewer than `FEWEST_WINDOWS` windows tell the value, or if more
            than `MUCH` of the torque is not explained.
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
    parts = [record_equations(system, model, record, geometry) for record in records]
    names = (*model.names, *(f"c{i + 1}" for i in range(system.m)))
    late = _delay(parts)
    noisy = [
        [
            replace(record_equations(system, model, _with_noise(record, sign), geometry), slow=each)
            for record, each in zip(records, (part.slow for part in parts), strict=True)
        ]
        for sign in ((-1, 1) if any(record.noise for record in records) else ())
    ]
    dry = _solved(names, parts, late, noisy)
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
    parts = [record_equations(system, model, record, geometry) for record in records]
    names = (*model.names, *(f"c{i + 1}" for i in range(system.m)))
    known = {each.name: each.value for each in found.found}
    values = np.array([known.get(name, 0.0) for name in names])
    late = 0.0 if found.delay is None else found.delay.value
    torque = torque_of(parts, late)
    left = without_slow(parts, torque - columns_of(parts) @ values)
    return _share(left, without_slow(parts, torque))


def _share(left: Array, torque: Array) -> float:
    """Ratio of their rms; 0 without torques."""
    total = float(np.sqrt(np.mean(torque**2)))
    return float(np.sqrt(np.mean(left**2))) / total if total else 0.0


def _delay(parts: list[RecordEquations]) -> float:
    """The delay of the logged torques with which the model explains most of them, [s]."""
    from scipy.optimize import minimize_scalar  # slow to import

    moved, scaled, _ = _scaled(parts, range(parts[0].columns.shape[2]))
    if not moved:
        raise ValueError("the robot hardly moves")
    basis = np.linalg.qr(scaled.reshape(-1, scaled.shape[-1]))[0]

    def unexplained(late: float) -> float:
        torque = without_slow(parts, torque_of(parts, late)).ravel()
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
    parts = [record_equations(system, model, record, geometry) for record in records]
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
    parts = [record_equations(system, model, record, geometry) for record in records]
    _, scaled, _ = _scaled(parts, range(parts[0].columns.shape[2]))
    sizes = np.linalg.svd(scaled.reshape(-1, scaled.shape[-1]), compute_uv=False)
    told = sizes[sizes > sizes[0] / WORST_CONDITION] if len(sizes) else sizes
    return len(told), float(told[0] / told[-1]) if len(told) else np.inf


def _significant(shares: Array) -> bool:
    return bool(np.any(np.abs(shares) > NEGLIGIBLE))


def _scaled(parts: list[RecordEquations], used: Sequence[int]) -> tuple[list[int], Array, Array]:
    """The columns that tell something where motors are not slow.

    Args:
        used: the columns to take.

    Returns:
        Their places in `used`, these columns without what slow friction explains, with an rms of 1,
        and the rms that they had.
    """
    whole = columns_of(parts)[..., used]
    columns = without_slow(parts, whole)
    before, size = (np.sqrt(np.mean(each**2, axis=(0, 1))) for each in (whole, columns))
    told = (before > UNMOVED * before.max(initial=0.0)) & (size > HARDLY * before)
    moved = np.flatnonzero(told).tolist()
    return moved, columns[..., moved] / size[moved], size[moved]


def windows_that_tell(regressor: Array) -> Array:
    """How many windows tell each value: (Σ e)² / Σ e², with a window's sum e of squares.

    If one window alone tells a value, the estimate fits that window whatever its noise is, and the
    residual does not show the error.

    >>> alike, alone = np.ones(5), np.array([0, 0, 3.0, 0, 0])
    >>> windows_that_tell(np.stack([alike, alone], axis=1)[:, None]).tolist()
    [5.0, 1.0]

    Args:
        regressor: shape (windows, n, values).
    """
    each = np.sum(regressor**2, axis=1)
    return np.sum(each, axis=0) ** 2 / np.sum(each**2, axis=0)


def _with_noise(record: MotionRecord, sign: int) -> MotionRecord:
    """A record whose coordinates and rates have errors of twice the variance."""
    if record.noise is None:
        return record
    q, v = record.noise
    return replace(record, q=record.q + sign * q, v=record.v + sign * v)


def _solved(
    names: tuple[str, ...],
    parts: list[RecordEquations],
    late: float,
    noisy: Sequence[list[RecordEquations]] = (),
) -> Estimate:
    """Estimates of the base parameters and the delay, with the first columns of the regressor.

    Errors of the angles are in the regressor, too, and bias the estimates. What errors of twice the
    variance change in them is therefore taken back.

    Source: Cook and Stefanski, Journal of the American Statistical Association 89, 1994 (SIMEX).

    Args:
        noisy: equations with errors of twice the variance, and the same slow motors.
    """
    moved, scaled, scale = _scaled(parts, range(len(names)))
    if not moved:
        raise ValueError("the robot hardly moves")
    change = _change(parts, late)
    shows = not _depends(change, scaled)
    if late and not shows:
        return _solved(names, parts, 0.0, noisy)
    torque = without_slow(parts, torque_of(parts, late))
    chosen, others, shares = _independent(scaled.reshape(-1, len(moved)))
    jerk = float(np.sqrt(np.mean(change**2))) or 1.0
    regressor = scaled[..., chosen]
    if shows:
        regressor = np.concatenate([regressor, -change[..., None] / jerk], axis=2)
    values, _ = least_squares(regressor, torque)
    residual = np.asarray(torque - regressor @ values, dtype=float)
    unknown = sum(part.slow.torques for part in parts if part.slow)
    places, sizes = [moved[i] for i in chosen], scale[chosen]
    errors, by_blocks = _errors(regressor, residual, unknown), _block_errors(regressor, torque)
    wide = np.maximum(errors * _quantile(regressor, unknown), by_blocks * BLOCK_QUANTILE)
    errors = np.maximum(errors, by_blocks)
    wide += _change_by_friction(parts, places, sizes, regressor, torque)
    held = without_slow(parts, torque_of(parts, late, held=True))
    wide += np.abs(least_squares(regressor, held)[0] - values)
    unexplained = _share(residual, torque)
    wide += np.inf if unexplained > MUCH else 0.0
    wide[windows_that_tell(regressor) < FEWEST_WINDOWS] = np.inf
    values = values - _change_by_noise(noisy, places, sizes, late, regressor, values)

    def parameter(i: int, name: str, size: float, sums: Sums = (), shift: float = 0.0):
        value = float(values[i]) / size + shift
        error, half = float(errors[i]) / size, float(wide[i]) / size
        return BaseParameter(name, value, error, value - half, value + half, sums)

    told = list[tuple[int, BaseParameter]]()
    for i, place in enumerate(chosen):
        sums = tuple(
            (names[moved[j]], float(share) * scale[j] / scale[place])
            for j, share in zip(others, shares[i], strict=True)
            if abs(share) > NEGLIGIBLE
        )
        told.append((moved[place], parameter(i, names[moved[place]], scale[place], sums)))
    return Estimate(
        found=tuple(each for _, each in sorted(told, key=lambda pair: pair[0])),
        unexcited=tuple(name for j, name in enumerate(names) if j not in moved),
        unexplained=unexplained,
        delay=parameter(len(chosen), DELAY, jerk, shift=late) if shows else None,
        times=np.concatenate([part.middles() for part in parts]),
        torque=torque,
        residual=residual,
    )


def _change_by_friction(
    parts: list[RecordEquations], places: list[int], scale: Array, regressor: Array, torque: Array
) -> Array:
    """How much another width of the smooth sign of dry friction changes each estimate at most.

    Args:
        places: of the regressor's first columns among those of the equations.
        scale: by which these have been divided.
    """
    first = parts[0].columns.shape[2] - parts[0].motors.shape[2]
    dry = [(i, place - first) for i, place in enumerate(places) if place >= first]
    values, _ = least_squares(regressor, torque)
    most = np.zeros(len(values))
    for columns in dry_columns_of(parts) if dry else ():
        other, own = regressor.copy(), without_slow(parts, columns)
        for i, motor in dry:
            other[..., i] = own[..., motor] / scale[i]
        most = np.maximum(most, np.abs(least_squares(other, torque)[0] - values))
    return most


def _change_by_noise(
    noisy: Sequence[list[RecordEquations]],
    places: list[int],
    scale: Array,
    late: float,
    regressor: Array,
    values: Array,
) -> Array:
    """How much errors of the angles with twice the variance change each estimate.

    Args:
        noisy: see `_solved`.
        places, scale: see `_change_by_friction`.
    """
    changes = list[Array]()
    for parts in noisy:
        other = regressor.copy()
        other[..., : len(places)] = without_slow(parts, columns_of(parts)[..., places]) / scale
        torque = without_slow(parts, torque_of(parts, late))
        changes.append(least_squares(other, torque)[0] - values)
    return np.asarray(np.mean(changes or [0 * values], axis=0), dtype=float)


def _change(parts: list[RecordEquations], late: float) -> Array:
    """Derivative of the right-hand side with respect to the delay, shape (windows, n), [N m/s]."""
    step = max(*(part.dt for part in parts), 1e-3)
    after, before = torque_of(parts, late + step), torque_of(parts, late - step)
    return without_slow(parts, (after - before) / (2 * step))


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


def _block_errors(regressor: Array, torque: Array) -> Array:
    """Standard errors from estimates without each of B parts of the motion, shape (unknowns,).

    With the estimates θ of all windows, and θ_b without those of part b,

        s² = (B - 1) / B Σ_b (θ_b - θ)².

    Residuals are small where a few windows decide on an estimate, as of a robot that turns quickly
    once or twice. These errors are not, and parts may be correlated within.

    Source: Künsch, Annals of Statistics 17, 1989.

    Args:
        regressor: X, shape (windows, n, unknowns).
        torque: shape (windows, n).
    """
    parts = np.array_split(np.arange(len(regressor)), BLOCKS)
    square: Array = np.stack([np.einsum("kji,kjl->il", regressor[b], regressor[b]) for b in parts])
    right: Array = np.stack([np.einsum("kji,kj->i", regressor[b], torque[b]) for b in parts])
    whole, target = square.sum(axis=0), right.sum(axis=0)
    found = _solution(whole, target)
    without = [_solution(whole - a, target - b) for a, b in zip(square, right, strict=True)]
    spread = sum(((each - found) ** 2 for each in without), np.zeros(len(found)))
    return np.asarray(np.sqrt((BLOCKS - 1) / BLOCKS * spread), dtype=float)


def _solution(square: Array, right: Array) -> Array:
    """The solution of normal equations, and the shortest one if there are several."""
    return np.asarray(np.linalg.lstsq(square, right)[0], dtype=float)


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
