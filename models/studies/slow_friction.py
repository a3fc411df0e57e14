"""The friction of motors that hardly turn, of which nothing is assumed.

At a standstill a motor sticks, breaks loose or creeps, and its friction cannot be told from its
angle. Wherever the rate of a motor is below a bound, or changes its sign, its friction may
therefore differ from the model's by any torque, one for each stretch of about `STRETCH`. With N the
effect of these torques on the equations of a record, both sides of them are multiplied by

    1 - N (N^T N + ε)⁻¹ N^T.

What is then estimated by least squares is what it would be with the torques among the unknowns.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from onpath.models.arrays import Array

if TYPE_CHECKING:
    from scipy.sparse import csr_array

STRETCH = 0.04  # [s]
AROUND = 0.02  # [s], before and after a slow motion, since rates are filtered
NEARLY = 1e-6  # ε, as a share of the largest diagonal element of N^T N


@dataclass(frozen=True, slots=True, eq=False)
class SlowFriction:
    """The unknown torques of slow motors in the equations of a record.

    Attributes:
        effect: N, shape (windows n, torques).
        solve: x -> (N^T N + ε)⁻¹ x.
    """

    effect: csr_array
    solve: Any

    @property
    def torques(self) -> int:
        """The number of unknown torques."""
        return int(self.effect.shape[1])

    def removed(self, values: Array) -> Array:
        """Values of the equations, shape (windows, n, ...), without what the torques explain."""
        if not self.torques:
            return values
        flat = values.reshape(self.effect.shape[0], -1)
        left = flat - self.effect @ self.solve(np.asarray(self.effect.T @ flat))
        return np.asarray(left, dtype=float).reshape(values.shape)


def slow_friction(
    motors: Array, slow: NDArray[np.bool_], dt: float, starts: NDArray[np.int_], held: Array
) -> SlowFriction:
    """The unknown torques in the equations of some windows.

    Args:
        motors: column of B for each motor, (rows, n, m).
        slow: where each motor is slow, (rows, m).
        dt: time step of the record, [s].
        starts: first row of each window.
        held: integrals of a window over its time steps.
    """
    from scipy.sparse import csr_array, eye_array, hstack, vstack  # slow to import
    from scipy.sparse.linalg import factorized

    rows, n, m = motors.shape
    windows, length = len(starts), len(held)
    ends = np.arange(0, (windows + 1) * length, length)
    places = (starts[:, None] + np.arange(length)).ravel()
    integral = csr_array((np.tile(held, windows), places, ends), shape=(windows, rows))
    effects: list[Any] = [csr_array((windows * n, 0))]
    order: NDArray[np.int_] = np.arange(windows * n, dtype=np.int_)
    by_window = order.reshape((n, windows)).T.ravel()
    for k in range(m):
        inside, stretch = _stretches(slow[:, k], dt)
        if inside.size:
            shape = (rows, int(stretch[-1]) + 1)
            parts = [
                integral @ csr_array((motors[inside, i, k], (inside, stretch)), shape=shape)
                for i in range(n)
            ]
            effects.append(csr_array(vstack(parts))[by_window])
    effect = csr_array(hstack(effects))
    effect = effect[:, np.flatnonzero(abs(effect).sum(axis=0))]
    square = (effect.T @ effect).tocsc()
    if not effect.shape[1]:
        return SlowFriction(effect, None)
    small = NEARLY * square.diagonal().max() * eye_array(effect.shape[1], format="csc")
    return SlowFriction(effect, factorized(square + small))


def slow_rows(rates: Array, bounds: Array, dt: float) -> NDArray[np.bool_]:
    """Where motors are slow or turn round, and shortly before and after, shape (rows, m).

    Args:
        rates: of the motors, (rows, m).
        bounds: rate below which each is slow, (m,).
    """
    from scipy.ndimage import binary_dilation  # slow to import

    slow = np.abs(rates) < bounds
    slow[1:] |= rates[1:] * rates[:-1] < 0
    return binary_dilation(
        slow, np.ones((3, 1), dtype=np.int_), iterations=max(1, round(AROUND / dt))
    )


def _stretches(slow: NDArray[np.bool_], dt: float) -> tuple[NDArray[np.int_], NDArray[np.int_]]:
    """The rows at which a motor is slow, and the number of the stretch of each."""
    inside = np.flatnonzero(slow)
    numbers, count = list[NDArray[np.int_]](), 0
    for part in np.split(inside, np.flatnonzero(np.diff(inside) > 1) + 1):
        pieces = max(1, round(len(part) * dt / STRETCH))
        numbers.append(count + np.arange(len(part)) * pieces // max(len(part), 1))
        count += pieces
    return inside, np.concatenate(numbers)
