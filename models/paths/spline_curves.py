"""Curves of many pieces, as drawings are: uniform quintic B-splines σ(θ), θ in [-π, π].

With n pieces of the width h = 2π / n, the piece i and the place u = (θ + π) / h - i in it,

    σ(θ) = Σ_j b_j(u) p_(i + j),   j = 0..DEGREE,   0 <= u <= 1,

with the same functions b_j for all pieces. A tick of a closed loop needs the `WINDOW` control
points of one piece, which it selects by its number. The degree is 5 because σ''' acts on the torque
beside the path and must be continuous there.

Source: C. de Boor, A Practical Guide to Splines, Springer, 2001, chapter X.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray
from typing_extensions import override

from onpath.models.arrays import Array
from onpath.models.paths.curves import GRID, ORDERS, PERIOD, Curve

DEGREE = 5
WINDOW = DEGREE + 1  # control points that act on one piece
MOST_PIECES = 512
TABLE_POINTS = MOST_PIECES + DEGREE  # columns of `SplineCurve.table`
PER_PIECE = 4  # points of a grid on each piece
GRAIN = 1e-6  # [m], of the control points of drawings, so that they can be told in whole numbers
_GAUSS = np.polynomial.legendre.leggauss(8)  # places in [-1, 1] and weights


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class SplineCurve(Curve):
    """A curve of many pieces of equal width in θ; θ is the time of a drawing's speed profile.

    Attributes:
        points: control points, shape (pieces + DEGREE, d), [m]. The last `DEGREE` points of a
            closed curve are its first ones.
        raised: the links between strokes, where the pen is up: (θ from, θ to), [rad].
        duration: time of a pass at the usual speed, at which one of a series takes 1 s, [s].

    Raises:
        ValueError: there are no pieces or more than `MOST_PIECES`, the points are not finite, or a
            closed curve does not end as it begins.
    """

    points: Array
    raised: tuple[tuple[float, float], ...] = ()
    duration: float = 1.0

    def __post_init__(self) -> None:
        if self.points.ndim != 2 or not np.isfinite(self.points).all():
            raise ValueError("points: must be finite, of shape (pieces + 5, 2 or 3)")
        if not 1 <= self.pieces <= MOST_PIECES:
            raise ValueError(f"points: must be for 1 to {MOST_PIECES} pieces")
        if self.closed and not np.array_equal(self.points[:DEGREE], self.points[-DEGREE:]):
            raise ValueError("points: the last five of a closed curve must be its first five")

    @property
    def pieces(self) -> int:
        """n, the number of pieces."""
        return len(self.points) - DEGREE

    @property
    @override
    def dimension(self) -> int:
        return self.points.shape[-1]

    @property
    @override
    def begin(self) -> float:
        """Where the drawing begins."""
        return -np.pi

    @property
    @override
    def grid(self) -> int:
        return max(GRID, PER_PIECE * self.pieces)

    @override
    def at(self, theta: Array, order: int = 0) -> Array:
        return self.all_orders(theta)[order]

    @override
    def all_orders(self, theta: Array) -> list[Array]:
        theta = np.asarray(theta, dtype=float)
        inner = self._inner(theta)
        per_radian = self.pieces / PERIOD
        place = (inner + np.pi) * per_radian
        piece = np.clip(np.nan_to_num(np.floor(place)), 0, self.pieces - 1).astype(int)
        window = self.points[piece[..., None] + np.arange(WINDOW)]
        basis = [np.stack(row, axis=-1) for row in piece_basis(place - piece, per_radian)]
        values = [np.einsum("...j,...jd->...d", each, window) for each in basis]
        if not self.closed:
            beyond = (theta - inner)[..., None]
            values[0] = values[0] + beyond * values[1]
            values[2:] = [np.where(beyond == 0, value, 0.0) for value in values[2:]]
        return values

    @override
    def draws(self, theta: Array) -> NDArray[np.bool_]:
        inner = self._inner(theta)
        down = np.ones(np.shape(theta), dtype=bool)
        for begin, end in self.raised:
            down &= (inner <= begin) | (inner >= end)
        return down

    @override
    def strokes(self) -> list[Array]:
        ends = np.array([-np.pi, *(end for link in self.raised for end in link), np.pi])
        found = list[Array]()
        for begin, end in ends.reshape(-1, 2):
            if begin < end:
                count = 2 + int((end - begin) / PERIOD * 2 * self.grid)
                theta: Array = np.linspace(float(begin), float(end), count)
                found.append(self.at(theta))
        return found

    def _inner(self, theta: Array) -> Array:
        """The place in [-π, π] at which the pieces are to be evaluated for θ."""
        if self.closed:
            return theta - PERIOD * np.floor(theta / PERIOD + 0.5)
        return np.clip(theta, -np.pi, np.pi)

    @override
    def table(self) -> Array:
        """The control points, with zeros up to the most pieces: a (d, TABLE_POINTS) matrix, flat,
        by columns."""
        padded = np.zeros((TABLE_POINTS, self.dimension))
        padded[: len(self.points)] = self.points
        return padded.ravel()

    @property
    @override
    def coefficients(self) -> Array:
        return self.points

    @property
    @override
    def plan(self) -> SplineCurve:
        return replace(self, points=self.points[:, :2], given=None, deviation=0.0)

    @override
    def length(self) -> float:
        """Arc length ∫ |σ'| dθ where the pen is down, [m], by 8 Gauss points on each piece."""
        places, weights = _GAUSS
        width = PERIOD / self.pieces
        theta = -np.pi + width * (np.arange(self.pieces)[:, None] + (1 + places) / 2)
        all_of_it = (np.linalg.norm(self.at(theta, 1), axis=-1) @ weights).sum() * width / 2
        return float(all_of_it - np.diff(self.arc(np.array(self.raised).reshape(-1, 2))).sum())


def grained(points: Array) -> Array:
    """The points in whole multiples of `GRAIN`, [m]."""
    return GRAIN * np.rint(points / GRAIN) + 0.0  # no -0


def piece_basis(u: Any, per_radian: Any) -> list[list[Any]]:
    """b_j and its derivatives with respect to θ: `ORDERS` lists of `WINDOW`, of symbols or arrays.

    By the recurrence of B-splines on knots of distance 1. A derivative is a difference of the
    functions of the next lower degree.

    Args:
        u: place in the piece, 0 to 1.
        per_radian: 1 / h, [1/rad].
    """
    degrees: list[list[Any]] = [[u * 0 + 1]]
    for p in range(1, DEGREE + 1):
        below = degrees[-1]
        falling = [(j + 1 - u) * each for j, each in enumerate(below)]
        rising = [(u + (p - 1 - j)) * each for j, each in enumerate(below)]
        inside = [a + b for a, b in zip(falling[1:], rising[:-1], strict=True)]
        degrees.append([each / p for each in (falling[0], *inside, rising[-1])])
    orders, factor = list[list[Any]](), 1
    for order in range(ORDERS):
        row = degrees[DEGREE - order]
        for _ in range(order):
            row = [-row[0], *(a - b for a, b in pairwise(row)), row[-1]]
        orders.append([factor * each for each in row] if order else row)
        factor = factor * per_radian
    return orders
