"""Paths: closed curves as truncated Fourier series, open ones as Chebyshev series.

A curve and its first three derivatives are series over one basis {1, C_1..C_K, S_1..S_K}:
closed, C_k = cos k theta and S_k = sin k theta; open, C_k = T_k(theta / pi) and S is unused.
Their coefficients are run-time parameters of the compiled loop, so that dragging a curve never
rebuilds anything. theta runs over [-pi, pi]; an open curve goes on along its end tangents.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from onpath.models.arrays import Array

HARMONICS = 12
TERMS = 2 * HARMONICS + 1
ORDERS = 4  # the curve and three derivatives
TABLE_SHAPE = (2 * ORDERS, TERMS)
PERIOD = 2 * np.pi
_ORDER = np.arange(1.0, HARMONICS + 1)


@dataclass(frozen=True, slots=True, eq=False)
class Curve:
    """A planar curve sigma(theta), theta in [-pi, pi] (periodic when closed).

    Attributes:
        closed: whether the ends meet.
        series: coefficients of sigma and its derivatives, shape (ORDERS, TERMS, 2); per order a
            constant, K rows of C_k, K rows of S_k, [m] (per rad to the order).
    """

    closed: bool
    series: Array

    def at(self, theta: Array, order: int = 0) -> Array:
        """sigma or a derivative of it at theta, shape (...,) -> (..., 2)."""
        theta = np.asarray(theta, dtype=float)
        inner = theta if self.closed else np.clip(theta, -np.pi, np.pi)
        value = _basis(inner, self.closed) @ self.series[order]
        if self.closed:
            return value
        beyond = (theta - inner)[..., None]
        if order == 0:
            return value + beyond * self.at(inner, 1)
        return value if order == 1 else np.where(beyond == 0, value, 0.0)

    def all_orders(self, theta: Array) -> list[Array]:
        """sigma and its three derivatives at theta on the curve proper, each (n, 2)."""
        inner = theta if self.closed else np.clip(theta, -np.pi, np.pi)
        basis = _basis(inner, self.closed)
        values = [basis @ self.series[order] for order in range(ORDERS)]
        if not self.closed:
            beyond = (theta - inner)[:, None]
            values[0] = values[0] + beyond * values[1]
            values[2:] = [np.where(beyond == 0, value, 0.0) for value in values[2:]]
        return values

    def table(self) -> Array:
        """The coefficients as the compiled loop takes them: TABLE_SHAPE, by columns, flat.

        Rows are the two coordinates of sigma, then of its derivatives; columns the basis.
        """
        return np.ascontiguousarray(self.series.transpose(1, 0, 2)).ravel()

    def terms(self) -> Array:
        """The coefficients that tell it, see `from_terms`; shape (TERMS or HARMONICS + 1, 2)."""
        return self.series[0, : terms_of(self.closed)]

    def sample(self, count: int = 256) -> Array:
        """Evenly spaced theta over the curve, shape (count,); a closed one's end is left out."""
        return np.linspace(-np.pi, np.pi, count, endpoint=not self.closed)

    def curvature(self, theta: Array) -> Array:
        """Signed curvature, positive where the curve turns left, [1/m]."""
        first, second = self.at(theta, 1), self.at(theta, 2)
        speed = np.maximum(np.hypot(first[..., 0], first[..., 1]), 1e-12)
        return (first[..., 0] * second[..., 1] - first[..., 1] * second[..., 0]) / speed**3

    def length(self) -> float:
        """Arc length, [m]."""
        theta = self.sample(1024)
        speed = np.linalg.norm(self.at(theta, 1), axis=-1)
        if self.closed:
            return float(speed.mean() * PERIOD)
        return float(np.trapezoid(speed, theta))

    def nearest(self, z: Array, samples: int = 256) -> tuple[Array, Array]:
        """Closest points by global search, refined; the reference for every other projection.

        Args:
            z: points, shape (n, 2), [m].

        Returns:
            theta, shape (n,), [rad], and the distances, shape (n,), [m].

        Source: eq. (7).
        """
        return nearest(self.at, self.sample(samples), z)

    def conic(self) -> tuple[Array, Array, float] | None:
        """(centre, weights, constant) of s(z) if this is an axis-parallel ellipse, else None.

        s(z) = gx (z1 - cx)^2 + gy (z2 - cy)^2 - r2, scaled so that a circle has weights 1.

        Source: eq. (15).
        """
        table = self.series[0]
        others = np.delete(table, [0, 1, 1 + HARMONICS], axis=0)
        a, b = abs(table[1, 0]), abs(table[1 + HARMONICS, 1])
        skew = abs(table[1, 1]) + abs(table[1 + HARMONICS, 0])
        if not self.closed or a * b == 0 or skew + np.abs(others).max() > 1e-9:
            return None
        return table[0], np.array([b / a, a / b]), float(a * b)


def nearest(curve: Callable[[Array], Array], grid: Array, points: Array) -> tuple[Array, Array]:
    """Closest points of any curve in R^p: global search over `grid`, then golden sections.

    Args:
        curve: theta (...,) -> points (..., p).
        grid: evenly spaced theta.
        points: shape (n, p).

    Returns:
        theta and distance, each shape (n,).
    """
    points = np.atleast_2d(points)
    middle: Array = grid[local_minima(((points[:, None, :] - curve(grid)) ** 2).sum(-1))]
    step = float(grid[1] - grid[0])
    low, high = middle - step, middle + step
    ratio = 0.5 * (5**0.5 - 1)

    def squared(theta: Array) -> Array:
        return ((points[:, None, :] - curve(theta)) ** 2).sum(-1)

    for _ in range(36):
        span = ratio * (high - low)
        left, right = high - span, low + span
        nearer_left = squared(left) < squared(right)
        low, high = np.where(nearer_left, low, left), np.where(nearer_left, right, high)
    theta = (low + high) / 2
    found = squared(theta)
    best = np.arange(len(points)), found.argmin(axis=1)
    return theta[best], np.sqrt(found[best])


def local_minima(values: Array, most: int = 4) -> NDArray[np.intp]:
    """Where each row has its lowest local minima, shape (n, k) -> (n, most).

    Two valleys of nearly the same depth are told apart only by their refined minima. Where a row
    has fewer, its lowest one is repeated.
    """
    padded = np.pad(values, ((0, 0), (1, 1)), constant_values=np.inf)
    is_lowest = (values <= padded[:, :-2]) & (values <= padded[:, 2:])
    masked = np.where(is_lowest, values, np.inf)
    order: NDArray[np.intp] = masked.argpartition(most, axis=1)[:, :most]
    found = np.isfinite(masked[np.arange(len(values))[:, None], order])
    return np.where(found, order, values.argmin(axis=1)[:, None])


def _basis(theta: Array, closed: bool) -> Array:
    values = np.empty((*theta.shape, TERMS))
    angle = (theta if closed else np.arccos(np.clip(theta / np.pi, -1, 1)))[..., None] * _ORDER
    values[..., 0] = 1.0
    np.cos(angle, out=values[..., 1 : HARMONICS + 1])
    if closed:
        np.sin(angle, out=values[..., HARMONICS + 1 :])
    else:
        values[..., HARMONICS + 1 :] = 0.0
    return values


def fourier(constant: Array, cosine: Array, sine: Array) -> Curve:
    """A closed curve from its Fourier coefficients.

    Args:
        constant: a0, shape (2,), [m].
        cosine, sine: a_k and b_k for k = 1.., shape (up to HARMONICS, 2), [m].
    """
    k = np.arange(1, HARMONICS + 1)[:, None]
    a, b = np.zeros((HARMONICS, 2)), np.zeros((HARMONICS, 2))
    a[: len(cosine)], b[: len(sine)] = cosine, sine
    orders = [np.vstack([constant, a, b])]
    for _ in range(ORDERS - 1):
        a, b = k * b, -k * a
        orders.append(np.vstack([np.zeros(2), a, b]))
    return Curve(True, np.stack(orders))


def chebyshev_curve(coefficients: Array) -> Curve:
    """An open curve from Chebyshev coefficients in x = theta / pi, shape (up to K + 1, 2), [m]."""
    orders: list[Array] = []
    for order in range(ORDERS):
        table = np.zeros((TERMS, 2))
        derived = chebyshev.chebder(coefficients, order) if order else coefficients
        table[: len(derived)] = derived / np.pi**order
        orders.append(table)
    return Curve(False, np.stack(orders))


def terms_of(closed: bool) -> int:
    """How many coefficients tell a curve."""
    return TERMS if closed else HARMONICS + 1


def from_terms(closed: bool, terms: Array) -> Curve:
    """The inverse of `Curve.terms`."""
    if not closed:
        return chebyshev_curve(terms)
    return fourier(terms[0], terms[1 : HARMONICS + 1], terms[HARMONICS + 1 :])


def ellipse(half_axes: tuple[float, float], centre: tuple[float, float] = (0.0, 0.0)) -> Curve:
    """An axis-parallel ellipse, exact; theta is its eccentric anomaly. [m]"""
    return fourier(
        np.array(centre), np.array([[half_axes[0], 0.0]]), np.array([[0.0, half_axes[1]]])
    )


def circle(radius: float, centre: tuple[float, float] = (0.0, 0.0)) -> Curve:
    """A circle, exact; theta is the angle. [m]. Source: eq. (15)."""
    return ellipse((radius, radius), centre)


def segment(start: tuple[float, float], end: tuple[float, float]) -> Curve:
    """A straight segment from start to end, [m]."""
    a, b = np.array(start), np.array(end)
    return chebyshev_curve(np.stack([(a + b) / 2, (b - a) / 2]))


def blend(old: Curve, new: Curve, fraction: float) -> Curve:
    """Between two curves of the same kind: `old` at 0, `new` at 1."""
    return Curve(new.closed, (1 - fraction) * old.series + fraction * new.series)


def aligned(curve: Curve, to: Curve) -> Curve:
    """The same curve, begun and run through as `to` is, a curve of the same kind.

    Between curves that run against each other, or begin on opposite sides, a blend would shrink
    to a point or a line on its way.
    """
    if not curve.closed:
        theta = to.sample(64)
        ahead, back = (((curve.at(s * theta) - to.at(theta)) ** 2).sum() for s in (1, -1))
        signs = np.ones(HARMONICS + 1) if ahead <= back else (-1.0) ** np.arange(HARMONICS + 1)
        return chebyshev_curve(signs[:, None] * curve.series[0, : HARMONICS + 1])
    (a, b), (to_a, to_b) = _harmonics(curve), _harmonics(to)
    shift = curve.sample(360)[:, None] * _ORDER
    best = -np.inf, 0.0, 1
    for sense in (1, -1):
        alike = (a * to_a + sense * b * to_b).sum(-1)
        turned = (sense * b * to_a - a * to_b).sum(-1)
        overlap = np.cos(shift) @ alike + np.sin(shift) @ turned
        best = max(best, (overlap.max(), shift[overlap.argmax(), 0], sense))
    cosine, sine = np.cos(best[1] * _ORDER)[:, None], np.sin(best[1] * _ORDER)[:, None]
    b = best[2] * b
    return fourier(curve.series[0, 0], cosine * a + sine * b, cosine * b - sine * a)


def _harmonics(curve: Curve) -> tuple[Array, Array]:
    """a_k and b_k of a closed curve, each (HARMONICS, 2)."""
    return curve.series[0, 1 : HARMONICS + 1], curve.series[0, HARMONICS + 1 :]
