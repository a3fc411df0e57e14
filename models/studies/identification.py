"""Identification of the five-bar's inertia and friction by linear least squares.

The equations of motion are linear in their parameters. Differentiating measured angles twice would
amplify their noise. Instead, both sides are multiplied by a smooth window w of finite length and
integrated; integration by parts moves the derivatives onto w:

    M11 <w'', q1> - b1 <w', q1> = <w, u1 + (J^T F)_1>,    <w, x> = ∫ w(t) x(t) dt.

Every position of the window along the record gives one equation per joint. The terms that a
balanced linkage without dry friction does not have are treated in the same way:

    coupling (joint 1)   M12 (cos(q2 - q1) q2'' - sin(q2 - q1) q2'²)
    coupling (joint 2)   M12 (cos(q2 - q1) q1'' + sin(q2 - q1) q1'²)
    gravity              G_i cos q_i
    dry friction         c_i q_i' / sqrt(q_i'² + ε²)
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.polynomial import Polynomial

from onpath.models.arrays import Array
from onpath.models.errors import CodedError
from onpath.models.systems.forces import DRY_VELOCITY

INERTIA = ("M11", "M22", "b1", "b2")  # the parameters of eq. (12), [kg m²] and [N m s]
DRY = ("c1", "c2")  # dry friction of the joints, [N m]
BALANCE = ("M12", "G1", "G2")  # coupling [kg m²] and gravity [N m] of an unbalanced linkage
ALL = INERTIA + DRY + BALANCE
CHOICES = (INERTIA, INERTIA + DRY, INERTIA + BALANCE, ALL)

BUMP = 0.25  # [s], length of the window w
OVERLAP = 5  # windows that contain any one instant
LAGS = 2 * OVERLAP  # windows over which residuals may be correlated
FEWEST = 20  # least number of samples in a window
SMOOTHING = 0.04  # [s], length of the Savitzky-Golay filter of degree 4
FEWEST_SMOOTHED = 7  # its least number of samples
SHORTEST = 1.0  # [s], shortest record
LEAST_MOTION = 0.02  # [rad], least peak-to-peak motion of each joint
WORST_CONDITION = 200.0  # largest condition number of the scaled regressor
WORST_ERROR = 0.1  # largest relative standard error of an inertia
ENOUGH = 1.25  # largest residual of a simpler model, in units of the smallest residual
EXACT = 1e-3  # residual, as a fraction of the torque, at which no further terms are needed


@dataclass(frozen=True, slots=True, eq=False)
class JointRecord:
    """Measured motion and torque at uniform time steps.

    Attributes:
        dt: time step, [s].
        q: joint angles, shape (n, 2), [rad].
        v: joint velocities, used for dry friction and coupling only, shape (n, 2), [rad/s].
        torque: u + J^T F of the motors and the external force, constant over each step, shape (n,
            2), [N m].
    """

    dt: float
    q: Array
    v: Array
    torque: Array


@dataclass(frozen=True, slots=True)
class Identified:
    """The result of an identification.

    Attributes:
        values: estimates by name (SI).
        errors: their standard errors.
        residual: rms of the filtered torque that the model does not explain, [N m].
        torque: rms of the filtered torque, [N m].
        condition: condition number of the regressor with columns scaled to equal length.
    """

    values: dict[str, float]
    errors: dict[str, float]
    residual: float
    torque: float
    condition: float

    @property
    def unexplained(self) -> float:
        """residual / torque."""
        return self.residual / self.torque if self.torque else 0.0


def joint_torques(q: Array, force: Array, l1: float, l4: float) -> Array:
    """Joint torques J^T F of a force at the end-point, [N m].

        τ1 = l1 (cos q1 F2 - sin q1 F1),   τ2 = -l4 (cos q2 F2 - sin q2 F1)

    Args:
        q: joint angles, shape (n, 2), [rad].
        force: F, shape (n, 2), [N].
        l1, l4: link lengths, [m].

    Returns:
        Shape (n, 2).

    Source: the Jacobian of eq. (13).
    """
    across = np.cos(q) * force[:, 1:] - np.sin(q) * force[:, :1]
    return across * np.array([l1, -l4])


def smooth_velocities(q: Array, dt: float) -> Array:
    """Joint velocities from measured angles by a Savitzky-Golay filter, (n, 2) -> (n, 2), [rad/s].

    The filter is symmetric and therefore has no delay. Its degree is 4, so that the velocities of
    quick motions are not too small.

    Raises:
        ValueError: fewer samples than the filter has.
    """
    from scipy.signal import savgol_filter  # slow to import; see app/server/warm_up.py

    samples = max(2 * round(SMOOTHING / dt / 2) + 1, FEWEST_SMOOTHED)
    if len(q) < samples:
        raise CodedError("error.hardly_any_data")
    return np.asarray(savgol_filter(q, samples, 4, deriv=1, delta=dt, axis=0), dtype=float)


def identify(record: JointRecord, names: tuple[str, ...] = INERTIA) -> Identified:
    """Least-squares estimates of the parameters in `names`; all others are taken to be zero.

    Raises:
        ValueError: the record is too short or too coarse, or the motion does not determine the
            parameters.

    Source: eq. (12); Spong and Vidyasagar 6.4.1 for coupling and gravity.
    """
    columns, torque = _equations(record)
    return _estimated(names, columns, torque)


def simplest(record: JointRecord) -> Identified:
    """The estimate with the fewest terms that explains the record about as well as the best one.

    The models are tried in the order of `CHOICES`; the first one whose residual is at most `ENOUGH`
    times the smallest, or `EXACT` times the torque, is taken.

    Raises:
        ValueError: as `identify`, if no model can be estimated.
    """
    columns, torque = _equations(record)
    found, refusals = list[Identified](), list[ValueError]()
    for names in CHOICES:
        try:
            found.append(_estimated(names, columns, torque))
        except ValueError as error:
            refusals.append(error)
    if not found:
        raise refusals[0]
    least = min(each.residual for each in found)
    return next(e for e in found if e.residual <= max(ENOUGH * least, EXACT * e.torque))


def _estimated(names: tuple[str, ...], columns: Array, torque: Array) -> Identified:
    """Estimates and standard errors from the equations of a record.

    The columns of the regressor are scaled to unit rms before solving.

    Raises:
        ValueError: the motion does not determine the parameters.
    """
    regressor = columns[..., [ALL.index(name) for name in names]]
    scale = np.sqrt(np.mean(regressor**2, axis=(0, 1)))
    scaled = regressor / np.where(scale > 0, scale, 1.0)
    values, condition = least_squares(scaled, torque)
    if condition > WORST_CONDITION:
        raise CodedError("error.motion_too_regular")
    residual = torque - scaled @ values
    errors = standard_errors(scaled, residual)
    result = Identified(
        values=dict(zip(names, (values / scale).tolist(), strict=True)),
        errors=dict(zip(names, (errors / scale).tolist(), strict=True)),
        residual=float(np.sqrt(np.mean(residual**2))),
        torque=float(np.sqrt(np.mean(torque**2))),
        condition=condition,
    )
    return _trusted(result)


def _trusted(result: Identified) -> Identified:
    """The result, if all inertias are positive with standard errors of at most `WORST_ERROR`.

    Raises:
        ValueError: they are not.
    """
    for name in ("M11", "M22"):
        value, error = result.values[name], result.errors[name]
        if value <= 0 or error > WORST_ERROR * value:
            raise CodedError(
                "error.not_identifiable", name=name, value=f"{value:.3g}", error=f"{error:.2g}"
            )
    return result


def least_squares(regressor: Array, torque: Array) -> tuple[Array, float]:
    """Least-squares solution (unknowns,) and condition number of the regressor."""
    flat = regressor.reshape(-1, regressor.shape[-1])
    solution, _, _, singular = np.linalg.lstsq(flat, torque.ravel())
    condition = float(singular[0] / singular[-1]) if singular[-1] > 0 else np.inf
    return np.asarray(solution, dtype=float), condition


def standard_errors(regressor: Array, residual: Array) -> Array:
    """Standard errors of the least-squares estimates, shape (unknowns,).

    Neighbouring windows overlap, so their residuals are correlated. The covariance of the estimates
    is therefore the sandwich A⁻¹ S A⁻¹ with A = X^T X and S from the residuals' covariances
    within and between the joints, assumed stationary and tapered linearly with the lag (Bartlett's
    weights, as in Newey and West), which keeps all variances non-negative.

    Args:
        regressor: X, shape (k, 2, unknowns).
        residual: shape (k, 2).
    """
    k, joints, unknowns = regressor.shape
    flat = regressor.reshape(-1, unknowns)
    inverse = np.linalg.inv(flat.T @ flat)
    middle = np.zeros((unknowns, unknowns))
    for lag in range(min(LAGS, k)):
        early, late = slice(None, k - lag), slice(lag, None)
        covariance = (1 - lag / LAGS) * (residual[early].T @ residual[late]) / k
        part = np.einsum("kai,ab,kbl->il", regressor[early], covariance, regressor[late])
        middle += part if lag == 0 else part + part.T
    freedom = joints * k / max(joints * k - OVERLAP * unknowns, 1)
    return np.sqrt(np.maximum(np.diag(inverse @ middle @ inverse), 0.0) * freedom)


def step_means(ends: Array, values: Array, edges: Array) -> Array:
    """Means over other steps of a signal whose means over steps are known, (k, columns).

    They are the differences of a cubic spline through the integral of the signal.

    Args:
        ends: ends of the steps, shape (rows + 1,).
        values: means, shape (rows, columns).
        edges: ends of the other steps, shape (k + 1,).
    """
    from scipy.interpolate import CubicSpline  # slow to import

    parts = np.cumsum(values * np.diff(ends)[:, None], axis=0)
    whole = CubicSpline(ends, np.concatenate([np.zeros((1, values.shape[1])), parts]))(edges)
    return np.asarray(np.diff(whole, axis=0) / np.diff(edges)[:, None], dtype=float)


def _equations(record: JointRecord) -> tuple[Array, Array]:
    """Regressor, shape (k, 2, len(ALL)), and right-hand side, shape (k, 2), for k window positions.

    Raises:
        ValueError: the record is too short or too coarse, or a joint hardly moved.
    """
    _check(record)
    weight, rate, second, held = bump(record.dt)

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
    """Raise ValueError if the record is too coarse, too short, or has too little motion."""
    if record.dt > BUMP / FEWEST:
        raise ValueError(f"samples every {record.dt:g} s: at most {BUMP / FEWEST:g} s apart")
    duration = len(record.q) * record.dt
    if duration < SHORTEST:
        raise CodedError("error.record_too_short", duration=f"{duration:.1f}")
    if np.ptp(record.q, axis=0).min() < LEAST_MOTION:
        raise CodedError("error.hardly_moved")


def bump(dt: float) -> tuple[Array, Array, Array, Array]:
    """Samples of the window w, of w' and w'', times dt, and integrals of w over each time step.

    The window is w(t) ∝ (1 - x²)⁶ with x in [-1, 1], of unit area and as long as the whole number
    of steps nearest to `BUMP`. It vanishes at its ends to such an order that sums over samples
    equal the integrals to rounding. The integrals over steps are for signals that are constant
    over each step, such as the torque.
    """
    steps = round(BUMP / dt)
    half = steps * dt / 2
    x = np.linspace(-1, 1, steps + 1)
    shape = Polynomial([1, 0, -1]) ** 6
    whole = shape.integ()
    shape, whole = shape / float(whole(1) - whole(-1)), whole / float(whole(1) - whole(-1))
    weight, rate, second = (shape.deriv(order)(x) * dt / half ** (order + 1) for order in range(3))
    return weight, rate, second, np.diff(whole(x))
