"""Curves σ(θ), θ in [-π, π]: closed ones as Fourier series, open ones as Chebyshev series.

A curve and its first three derivatives are series over one basis {1, C_1..C_K, S_1..S_K}:

    closed:  C_k = cos kθ,       S_k = sin kθ,
    open:    C_k = T_k(θ / π),   S_k is not used.

The coefficients are inputs of the compiled loop, so that dragging a curve never rebuilds it.
Outside [-π, π] an open curve continues along its end tangents.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from onpath.models.arrays import Array

HARMONICS = 12  # K
TERMS = 2 * HARMONICS + 1  # size of the basis
ORDERS = 4  # the curve and its first three derivatives
TABLE_SHAPE = (2 * ORDERS, TERMS)  # of `Curve.table`, before it is flattened
PERIOD = 2 * np.pi  # [rad]
_ORDER = np.arange(1.0, HARMONICS + 1)


@dataclass(frozen=True, slots=True, eq=False)
class Curve:
    """A planar curve σ(θ), θ in [-π, π] (periodic when closed).

    Attributes:
        closed: whether the curve is closed.
        series: coefficients of σ, σ', σ'' and σ''', shape (ORDERS, TERMS, 2). For each order: the
            constant, K rows for C_k and K rows for S_k; [m] for σ, [m/rad^i] for its i-th
            derivative.
    """

    closed: bool
    series: Array

    def at(self, theta: Array, order: int = 0) -> Array:
        """σ or one of its derivatives at θ, shape (...,) -> (..., 2), [m/rad^order].

        An open curve continues along its end tangents: σ(θ) = σ(±π) + (θ ∓ π) σ'(±π), and its
        second and third derivatives are 0 there.

        Args:
            theta: [rad].
            order: 0 for σ, 1 to 3 for a derivative.
        """
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
        """[σ, σ', σ'', σ'''] at θ, shape (..., n) -> four arrays (..., n, 2).

        Equal to four calls of `at`, but evaluates the basis once.
        """
        inner = theta if self.closed else np.clip(theta, -np.pi, np.pi)
        basis = _basis(inner, self.closed)
        values = [basis @ self.series[order] for order in range(ORDERS)]
        if not self.closed:
            beyond = (theta - inner)[..., None]
            values[0] = values[0] + beyond * values[1]
            values[2:] = [np.where(beyond == 0, value, 0.0) for value in values[2:]]
        return values

    def table(self) -> Array:
        """The coefficients for the compiled loop: a TABLE_SHAPE matrix, flat, by columns.

        Its product with the basis at θ is (σ, σ', σ'', σ'''), two rows each.
        """
        return np.ascontiguousarray(self.series.transpose(1, 0, 2)).ravel()

    def terms(self) -> Array:
        """The coefficients of σ alone, shape (TERMS or HARMONICS + 1, 2), [m]; see `from_terms`."""
        return self.series[0, : terms_of(self.closed)]

    def sample(self, count: int = 256) -> Array:
        """`count` evenly spaced θ, shape (count,), [rad]; a closed curve's end point is omitted."""
        return np.linspace(-np.pi, np.pi, count, endpoint=not self.closed)

    def curvature(self, theta: Array) -> Array:
        """Signed curvature κ = (σ'_1 σ''_2 - σ'_2 σ''_1) / |σ'|³, shape (...,) -> (...), [1/m].

        It is positive where the curve turns left.
        """
        first, second = self.at(theta, 1), self.at(theta, 2)
        speed = np.maximum(np.hypot(first[..., 0], first[..., 1]), 1e-12)
        return (first[..., 0] * second[..., 1] - first[..., 1] * second[..., 0]) / speed**3

    def length(self) -> float:
        """Arc length ∫ |σ'| dθ over [-π, π], [m], from 1024 samples.

        On a closed curve this is the mean of a periodic function, which converges exponentially.
        """
        theta = self.sample(1024)
        speed = np.linalg.norm(self.at(theta, 1), axis=-1)
        if self.closed:
            return float(speed.mean() * PERIOD)
        return float(np.trapezoid(speed, theta))

    def nearest(self, z: Array, samples: int = 256) -> tuple[Array, Array]:
        """Closest points of the curve, ϖ(z) = argmin |z - σ(θ)|, by global search.

        This search is the reference that all faster projections are tested against.

        Args:
            z: points, shape (n, 2), [m].
            samples: size of the grid that the search starts from.

        Returns:
            θ, shape (n,), [rad], and the distances, shape (n,), [m].

        Source: eq. (7).
        """
        return nearest(self.at, self.sample(samples), z)

    def conic(self) -> tuple[Array, Array, float] | None:
        """The level set s(z) of an axis-parallel ellipse, or None if the curve is none.

            s(z) = g1 (z1 - c1)² + g2 (z2 - c2)² - r²,   g = (b/a, a/b),   r² = a b

        for half-axes a and b, which makes g = (1, 1) for a circle.

        Returns:
            (c, g, r²): shapes (2,), (2,) and a number, [m], [1], [m²].

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
    """Closest points of any curve in R^p: a search over `grid`, then golden-section search.

    The four lowest local minima on the grid are refined, and the best one is returned. 36 golden
    sections shrink the bracket by 3e-8.

    Args:
        curve: θ (...,) -> points (..., p).
        grid: evenly spaced θ, [rad].
        points: shape (n, p).

    Returns:
        θ [rad] and distance, each shape (n,).
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
    """Indices of the lowest local minima of every row, shape (n, k) -> (n, most).

    Several minima are returned because only refinement can tell two valleys of nearly the same
    depth apart. If a row has fewer than `most`, its lowest one is repeated.
    """
    padded = np.pad(values, ((0, 0), (1, 1)), constant_values=np.inf)
    is_lowest = (values <= padded[:, :-2]) & (values <= padded[:, 2:])
    masked = np.where(is_lowest, values, np.inf)
    order: NDArray[np.intp] = masked.argpartition(most, axis=1)[:, :most]
    found = np.isfinite(masked[np.arange(len(values))[:, None], order])
    return np.where(found, order, values.argmin(axis=1)[:, None])


def _basis(theta: Array, closed: bool) -> Array:
    """The basis {1, C_1..C_K, S_1..S_K} at θ, shape (...,) -> (..., TERMS).

    For open curves T_k(x) = cos(k arccos x).
    """
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
    """The closed curve σ(θ) = a_0 + Σ_k a_k cos kθ + b_k sin kθ.

    Args:
        constant: a_0, shape (2,), [m].
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
    """The open curve σ(θ) = Σ_k c_k T_k(θ / π).

    Args:
        coefficients: c_k for k = 0.., shape (up to HARMONICS + 1, 2), [m].
    """
    orders: list[Array] = []
    for order in range(ORDERS):
        table = np.zeros((TERMS, 2))
        derived = chebyshev.chebder(coefficients, order) if order else coefficients
        table[: len(derived)] = derived / np.pi**order
        orders.append(table)
    return Curve(False, np.stack(orders))


def terms_of(closed: bool) -> int:
    """Number of coefficients that determine a curve: see `Curve.terms`."""
    return TERMS if closed else HARMONICS + 1


def from_terms(closed: bool, terms: Array) -> Curve:
    """The inverse of `Curve.terms`."""
    if not closed:
        return chebyshev_curve(terms)
    return fourier(terms[0], terms[1 : HARMONICS + 1], terms[HARMONICS + 1 :])


def ellipse(half_axes: tuple[float, float], centre: tuple[float, float] = (0.0, 0.0)) -> Curve:
    """σ(θ) = c + (a cos θ, b sin θ), represented exactly.

    Args:
        half_axes: (a, b), [m].
        centre: c, [m].
    """
    return fourier(
        np.array(centre), np.array([[half_axes[0], 0.0]]), np.array([[0.0, half_axes[1]]])
    )


def circle(radius: float, centre: tuple[float, float] = (0.0, 0.0)) -> Curve:
    """σ(θ) = c + r (cos θ, sin θ), represented exactly.

    Args:
        radius: r, [m].
        centre: c, [m].

    Source: section III.B, eq. (15).
    """
    return ellipse((radius, radius), centre)


def segment(start: tuple[float, float], end: tuple[float, float]) -> Curve:
    """The straight segment from `start` (θ = -π) to `end` (θ = π), [m]."""
    a, b = np.array(start), np.array(end)
    return chebyshev_curve(np.stack([(a + b) / 2, (b - a) / 2]))


def blend(old: Curve, new: Curve, fraction: float) -> Curve:
    """The curve (1 - fraction) old + fraction new; both are closed, or both open."""
    return Curve(new.closed, (1 - fraction) * old.series + fraction * new.series)


def aligned(curve: Curve, to: Curve) -> Curve:
    """The same curve with its parameter shifted, and reversed if necessary, to match `to`.

    A closed curve becomes σ(±(θ + δ)); sign and δ maximise the correlation of its Fourier
    coefficients with those of `to`. An open curve is reversed if that brings it nearer to `to`.
    Without this, a blend of two curves with opposite directions or starting points would shrink to
    a point or a line half-way.
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
    """The Fourier coefficients a_k and b_k of a closed curve, each (HARMONICS, 2), [m]."""
    return curve.series[0, 1 : HARMONICS + 1], curve.series[0, HARMONICS + 1 :]
