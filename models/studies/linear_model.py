"""The equations that a recorded motion gives for a robot whose model is linear in parameters π.

With the momentum p = M(q) v, M v' + c = dp/dt + r with r = c - (dM/dt) v. Both p = P(q, v) π + p_0
and r = R(q, v) π + r_0 are linear in π, and P and R follow by differentiation. Multiplied by a
window w of finite length and integrated by parts, so that no acceleration is needed,

    (-<w', P> + <w, R>) π = <w, B u + J_h^T F> + <w', p_0> - <w, r_0>,   <w, x> = ∫ w(t) x(t) dt.

Dry friction is c sign(r) with the rate r of a motor; where that is slow, nothing is assumed of it
(see slow_friction.py), nor of a motor that hardly turns at all.

Source: Khalil and Dombre, Modeling, Identification and Control of Robots, 12.3 and 12.4.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import casadi as ca
import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from onpath.models.arrays import Array
from onpath.models.studies.identification import (
    BUMP,
    FEWEST,
    LEAST_MOTION,
    OVERLAP,
    SHORTEST,
    bump,
    step_means,
)
from onpath.models.studies.slow_friction import SlowFriction, slow_friction, slow_rows
from onpath.models.systems.system import MechanicalSystem

SLOW, SLOW_SHARE = 0.2, 0.25  # [rad/s] or [m/s], and share of a motor's largest rate
TURNED = 0.02  # [rad/s] or [m/s], width of the smooth sign of dry friction
WIDTHS = (0.0, 0.05)  # likewise, narrowest and widest that it may have
LATEST = 0.1  # [s], largest delay or lead of logged torques


@dataclass(frozen=True, slots=True, eq=False)
class MotionRecord:
    """Measured motion, torque and force at uniform time steps.

    Attributes:
        dt: time step, [s].
        q, v: coordinates and their rates, shape (rows, n).
        u: torque of the motors, constant over each step, (rows, m), [N m].
        force: at the end-point, (rows, p), [N].
        measured: whether the joint angles are sensor readings, with rates from a filter.
        noise: random errors as large as those of the coordinates, and of their rates, two arrays of
            shape (rows, n); None: they are exact.
        start: time since the rows of its part of the file began, [s]; 0 unless there was a gap.
    """

    dt: float
    q: Array
    v: Array
    u: Array
    force: Array
    measured: bool = False
    noise: tuple[Array, Array] | None = None
    start: float = 0.0


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


@dataclass(frozen=True, slots=True, eq=False)
class RecordEquations:
    """The equations that a record gives, one for each coordinate and window.

    Attributes:
        dt: time step of the record, [s].
        columns: regressor, shape (windows, n, k + m); the last m are for dry friction.
        known: what the right-hand side has besides the motors' torques, (windows, n).
        other_dry: the last m columns with each of `WIDTHS`, (len(WIDTHS), windows, n, m).
        motors: column of B for each motor, (rows, n, m).
        u: logged torques, (rows, m).
        starts: first row of each window. All torques are known there, however late they are.
        slow: the unknown friction of slow motors, or None if there is none.
    """

    dt: float
    columns: Array
    known: Array
    other_dry: Array
    motors: Array
    u: Array
    starts: NDArray[np.int_]
    slow: SlowFriction | None

    def torque(self, late: float, *, held: bool = False) -> Array:
        """Right-hand side if the torques were logged `late` seconds after they acted.

        Logged torques are means over the steps. With their integral U, <w, u> = -<w', U>, whose
        samples suffice for a smooth torque. One that is constant over each step acts in a frequency
        ω by a share (ω dt)²/12 more.

        Args:
            held: whether they are constant over each step.
        """
        edges = np.arange(len(self.u) + 1.0)
        moved = step_means(edges, self.u, edges + late / self.dt)
        _, rate, _, constant = bump(self.dt)
        kernel = constant if held else self.dt * np.cumsum(rate)[:-1]
        acting = _filtered(np.einsum("rnm,rm->rn", self.motors, moved), kernel, self.dt)
        return acting[self.starts // _stride(self.dt)] + self.known

    def middles(self) -> Array:
        """Middle of each window, from the beginning of the record, [s]."""
        half = len(bump(self.dt)[3]) / 2
        return np.asarray(self.dt * (self.starts + half), dtype=float)


def record_equations(
    system: MechanicalSystem, model: LinearModel, record: MotionRecord, geometry: Array
) -> RecordEquations:
    """The equations that a record gives.

    Args:
        geometry: the system's parameters; only those on which h and B depend are used.

    Raises:
        ValueError: the record is too short, too coarse, or without motion.
    """
    _check(record)
    dt, rows, n, size = record.dt, len(record.q), system.n, len(model.names)
    weight, rate, _, held = bump(dt)
    terms, offset = model.terms.map(rows)(record.q.T, record.v.T)
    slopes = terms.full().reshape(n, rows, 2 * size).swapaxes(0, 1)
    offsets = offset.full().reshape(n, rows, 2).swapaxes(0, 1)
    plant, none = np.tile(geometry[:, None], rows), 0 * record.force.T
    middle = _middles(record.q)  # torques and forces are constant over each step

    def effort(u: Array, force: Array) -> Array:
        return np.asarray(model.effort.map(rows)(middle.T, u, force, plant).full().T, dtype=float)

    columns = _filtered(slopes[..., size:], weight, dt) - _filtered(slopes[..., :size], rate, dt)
    known = _filtered(effort(0 * record.u.T, record.force.T), held, dt)
    known += _filtered(offsets[..., 0], rate, dt) - _filtered(offsets[..., 1], weight, dt)
    motors = np.stack([effort(np.tile(u[:, None], rows), none) for u in np.eye(system.m)], axis=2)
    rates = np.einsum("rnm,rn->rm", motors, _middles(record.v))
    dry, *others = (
        _filtered(motors * _smooth_sign(rates, width)[:, None], held, dt)
        for width in (TURNED, *WIDTHS)
    )
    columns = np.concatenate([columns, dry], axis=2)
    starts = np.arange(len(columns)) * _stride(dt)
    reach = (LATEST + BUMP / FEWEST) / dt
    kept = (starts >= reach) & (starts + len(held) + reach <= rows)
    bounds = np.minimum(SLOW, SLOW_SHARE * np.abs(rates).max(axis=0))
    slow = slow_rows(rates, bounds, dt)
    slow[:, np.ptp(dt * np.cumsum(rates, axis=0), axis=0) < LEAST_MOTION] = True  # it rests
    return RecordEquations(
        dt=dt,
        columns=columns[kept],
        known=known[kept],
        other_dry=np.stack(others)[:, kept],
        motors=motors,
        u=record.u,
        starts=starts[kept],
        slow=slow_friction(motors, slow, dt, starts[kept], held),
    )


def columns_of(parts: list[RecordEquations]) -> Array:
    """Regressor of all records, (windows, n, k + m)."""
    return np.concatenate([part.columns for part in parts])


def dry_columns_of(parts: list[RecordEquations]) -> Array:
    """`RecordEquations.other_dry` of all records, (len(WIDTHS), windows, n, m)."""
    return np.concatenate([part.other_dry for part in parts], axis=1)


def torque_of(parts: list[RecordEquations], late: float, *, held: bool = False) -> Array:
    """Right-hand side of all records, (windows, n); see `RecordEquations.torque`."""
    return np.concatenate([part.torque(late, held=held) for part in parts])


def without_slow(parts: list[RecordEquations], values: Array) -> Array:
    """Values of all records, (windows, n, ...), without what friction of slow motors explains."""
    each = np.split(values, np.cumsum([len(part.starts) for part in parts])[:-1])
    return np.concatenate(
        [part.slow.removed(x) if part.slow else x for part, x in zip(parts, each, strict=True)]
    )


def _middles(values: Array) -> Array:
    """Values in the middle of each time step; the last ones are those of the last row."""
    return np.concatenate([(values[1:] + values[:-1]) / 2, values[-1:]])


def _smooth_sign(rates: Array, width: float) -> Array:
    """r / sqrt(r² + width²), and 0 at 0."""
    size = np.hypot(rates, width)
    return np.divide(rates, size, out=np.zeros_like(rates), where=size > 0)


def _filtered(signal: Array, kernel: Array, dt: float) -> Array:
    """<kernel, signal> for all windows, whose first axis replaces that of the rows."""
    weight = bump(dt)[0]
    windows = sliding_window_view(signal, len(weight), axis=0)[:: _stride(dt)]
    return np.asarray(windows[..., : len(kernel)] @ kernel, dtype=float)


def _stride(dt: float) -> int:
    """Rows from one window to the next."""
    return len(bump(dt)[3]) // OVERLAP


def _check(record: MotionRecord) -> None:
    if not 0 < record.dt <= BUMP / FEWEST:
        raise ValueError(f"samples every {record.dt:g} s: at most {BUMP / FEWEST:g} s apart")
    seconds = len(record.q) * record.dt
    if seconds < SHORTEST:
        raise ValueError(f"{seconds:.2g} s of motion: at least {SHORTEST:g} s are needed")
    if np.ptp(record.q, axis=0).max() < LEAST_MOTION:
        raise ValueError("the robot hardly moves")
