"""Inertia and friction of the five-bar from data, by linear least squares.

The equations of motion are linear in their parameters. To differentiate measured angles twice would
amplify their noise; so both sides are filtered by the same smooth bump w of finite length, onto
which the derivatives move by partial integration:

    M11 <w'', q1> - b1 <w', q1> = <w, u1 + (J^T F)1>,    <w, x> the integral of w(t) x(t).

Each place of the bump along the record gives one equation for each joint. The same is done with
what a balanced linkage without dry friction does not have: coupling, gravity, Coulomb friction.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.polynomial import Polynomial
from scipy.linalg import lstsq

from onpath.models.arrays import Array
from onpath.models.errors import CodedError
from onpath.models.systems.forces import DRY_VELOCITY

INERTIA = ("M11", "M22", "b1", "b2")  # what the controller's model has, eq. (12)
DRY = ("c1", "c2")  # dry friction of the joints, [N m]
BALANCE = ("M12", "G1", "G2")  # coupling and gravity of a linkage out of balance
ALL = INERTIA + DRY + BALANCE
CHOICES = (INERTIA, INERTIA + DRY, INERTIA + BALANCE, ALL)

BUMP = 0.25  # [s], length of the filter
OVERLAP = 5  # bumps that cover an instant
LAGS = 2 * OVERLAP  # over which residuals may be correlated
FEWEST = 20  # samples in a bump
SMOOTHING = 41  # samples
SHORTEST = 1.0  # [s]
LEAST_MOTION = 0.02  # [rad], of each joint, from end to end
WORST_CONDITION = 200.0
WORST_ERROR = 0.1  # of an inertia, relative
ENOUGH = 1.25  # times the best residual: simpler is then good enough
EXACT = 1e-3  # of the torque: a residual that needs no explanation


@dataclass(frozen=True, slots=True, eq=False)
class JointRecord:
    """What was measured, at uniform steps.

    Attributes:
        dt: [s].
        q: joint angles, shape (n, 2), [rad].
        v: joint velocities, for dry friction and coupling alone, shape (n, 2), [rad/s].
        torque: of motors and external force, u + J^T F, held over each step, shape (n, 2), [N m].
    """

    dt: float
    q: Array
    v: Array
    torque: Array


@dataclass(frozen=True, slots=True)
class Identified:
    """What a record says.

    Attributes:
        values: estimates by name (SI).
        errors: their standard errors.
        residual: filtered torque that is not explained, rms, [N m].
        torque: all of it, rms, [N m].
        condition: of the regressor with columns of equal length.
    """

    values: dict[str, float]
    errors: dict[str, float]
    residual: float
    torque: float
    condition: float

    @property
    def unexplained(self) -> float:
        """Residual over torque."""
        return self.residual / self.torque if self.torque else 0.0


def joint_torques(q: Array, force: Array, l1: float, l4: float) -> Array:
    """J^T F of a force at the end-point, (n, 2) and (n, 2) -> (n, 2), [N m]. Source: eq. (13)."""
    across = np.cos(q) * force[:, 1:] - np.sin(q) * force[:, :1]
    return across * np.array([l1, -l4])


def smooth_velocities(q: Array, dt: float) -> Array:
    """Joint velocities from angles in encoder steps, (n, 2) -> (n, 2), without delay.

    Raises:
        ValueError: less data than the filter is long.
    """
    from scipy.signal import savgol_filter  # takes long; see app/server/lazy_imports.py

    if len(q) < SMOOTHING:
        raise CodedError("error.hardly_any_data")
    return np.asarray(savgol_filter(q, SMOOTHING, 2, deriv=1, delta=dt, axis=0), dtype=float)


def identify(record: JointRecord, names: tuple[str, ...] = INERTIA) -> Identified:
    """Least squares for the parameters in `names`; what is not named is taken to be zero.

    Raises:
        ValueError: the record is too short, or the motion too poor to tell them apart.

    Source: eq. (12), and Spong and Vidyasagar 6.4.1 for coupling and gravity.
    """
    return _estimated(names, *_equations(record))


def simplest(record: JointRecord) -> Identified:
    """With the fewest kinds of terms that explain the record about as well as all of them.

    Raises:
        ValueError: as `identify`, if nothing can be told.
    """
    equations = _equations(record)
    found, refusals = list[Identified](), list[ValueError]()
    for names in CHOICES:
        try:
            found.append(_estimated(names, *equations))
        except ValueError as error:
            refusals.append(error)
    if not found:
        raise refusals[0]
    least = min(each.residual for each in found)
    return next(e for e in found if e.residual <= max(ENOUGH * least, EXACT * e.torque))


def _estimated(names: tuple[str, ...], columns: Array, torque: Array) -> Identified:
    """Estimates and errors from the equations of a record."""
    regressor = columns[..., [ALL.index(name) for name in names]]
    scale = np.sqrt(np.mean(regressor**2, axis=(0, 1)))
    scaled = regressor / np.where(scale > 0, scale, 1.0)
    values, condition = _solved(scaled, torque)
    if condition > WORST_CONDITION:
        raise CodedError("error.motion_too_regular")
    residual = torque - scaled @ values
    errors = _standard_errors(scaled, residual)
    result = Identified(
        dict(zip(names, (values / scale).tolist(), strict=True)),
        dict(zip(names, (errors / scale).tolist(), strict=True)),
        float(np.sqrt(np.mean(residual**2))),
        float(np.sqrt(np.mean(torque**2))),
        condition,
    )
    return _trusted(result)


def _trusted(result: Identified) -> Identified:
    for name in ("M11", "M22"):
        value, error = result.values[name], result.errors[name]
        if value <= 0 or error > WORST_ERROR * value:
            raise CodedError(
                "error.not_identifiable", name=name, value=f"{value:.3g}", error=f"{error:.2g}"
            )
    return result


def _solved(regressor: Array, torque: Array) -> tuple[Array, float]:
    """Least squares solution and condition number."""
    solution = lstsq(regressor.reshape(-1, regressor.shape[-1]), torque.ravel())
    singular = solution[3]
    assert singular is not None  # LAPACK's default driver gives them
    condition = float(singular[0] / singular[-1]) if singular[-1] > 0 else np.inf
    return solution[0], condition


def _standard_errors(regressor: Array, residual: Array) -> Array:
    """Of the least squares solution, (unknowns,), from residuals that overlapping bumps correlate.

    Noise is taken to be stationary: its covariance is averaged over the record, for each joint,
    and fades with the lag (Bartlett's weights), so that no variance becomes negative.
    """
    k, joints, unknowns = regressor.shape
    flat = regressor.reshape(-1, unknowns)
    inverse = np.linalg.inv(flat.T @ flat)
    middle = np.zeros((unknowns, unknowns))
    for lag in range(min(LAGS, k)):
        early, late = slice(None, k - lag), slice(lag, None)
        covariance = (1 - lag / LAGS) * np.sum(residual[early] * residual[late], axis=0) / k
        part = np.einsum("kji,kjl,j->il", regressor[early], regressor[late], covariance)
        middle += part if lag == 0 else part + part.T
    freedom = joints * k / max(joints * k - OVERLAP * unknowns, 1)
    return np.sqrt(np.maximum(np.diag(inverse @ middle @ inverse), 0.0) * freedom)


def _equations(record: JointRecord) -> tuple[Array, Array]:
    """Regressor (k, 2, len(ALL)) and right side (k, 2), one row for each place of the bump.

    Raises:
        ValueError: the record is too short or too coarse, or a joint hardly moved.
    """
    _check(record)
    weight, rate, second, held = _bump(record.dt)

    def filtered(signal: Array, kernel: Array) -> Array:
        windows = sliding_window_view(signal, len(weight), axis=0)[:: len(held) // OVERLAP]
        return windows[..., : len(kernel)] @ kernel

    q, v = record.q, record.v
    turn = q[:, 1:] - q[:, :1]
    turning = np.sin(turn) * v[:, :1] * v[:, 1:] * np.array([-1.0, 1.0])
    torque = filtered(record.torque, held)
    columns = np.zeros((*torque.shape, len(ALL)))
    diagonal = {
        ("M11", "M22"): filtered(q, second),
        ("b1", "b2"): -filtered(q, rate),
        ("c1", "c2"): filtered(v / np.sqrt(v**2 + DRY_VELOCITY**2), held),
        ("G1", "G2"): filtered(np.cos(q), weight),
    }
    for names, values in diagonal.items():
        for joint, name in enumerate(names):
            columns[:, joint, ALL.index(name)] = values[:, joint]
    coupling = filtered(turning, weight) - filtered(np.cos(turn) * v[:, ::-1], rate)
    columns[..., ALL.index("M12")] = coupling
    return columns, torque


def _check(record: JointRecord) -> None:
    if record.dt > BUMP / FEWEST:
        raise ValueError(f"samples every {record.dt:g} s: at most {BUMP / FEWEST:g} s apart")
    duration = len(record.q) * record.dt
    if duration < SHORTEST:
        raise CodedError("error.record_too_short", duration=f"{duration:.1f}")
    if np.ptp(record.q, axis=0).min() < LEAST_MOTION:
        raise CodedError("error.hardly_moved")


def _bump(dt: float) -> tuple[Array, Array, Array, Array]:
    """Weights w, w' and w'' at the samples, and of w over each step for what is held over it.

    The bump has unit area and vanishes at its ends so smoothly that sums are exact integrals.
    """
    steps, half = round(BUMP / dt), BUMP / 2
    x = np.linspace(-1, 1, steps + 1)
    shape = Polynomial([1, 0, -1]) ** 6
    whole = shape.integ()
    shape, whole = shape / float(whole(1) - whole(-1)), whole / float(whole(1) - whole(-1))
    weight, rate, second = (shape.deriv(order)(x) * dt / half ** (order + 1) for order in range(3))
    return weight, rate, second, np.diff(whole(x))
