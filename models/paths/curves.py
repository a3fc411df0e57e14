"""Curves σ(θ), θ in [-π, π]: closed ones as Fourier series, open ones as Chebyshev series.

Those of many pieces are in models/paths/spline_curves.py; both are a
`Curve`. A series and its first three derivatives have one basis {1, C_1..C_K, S_1..S_K}:

    closed:  C_k = cos kθ,       S_k = sin kθ,
    open:    C_k = T_k(θ / π),   S_k is not used.

The coefficients are inputs of the compiled loop, so that dragging a curve never rebuilds it.
Outside [-π, π] an open curve continues along its end tangents.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass, field, fields
from typing import Any

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray
from typing_extensions import override

from onpath.models.arrays import Array

HARMONICS = 12  # K
TERMS = 2 * HARMONICS + 1  # size of the basis
ORDERS = 4  # the curve and its first three derivatives
TABLE_SHAPE = (2 * ORDERS, TERMS)  # of `Curve.table` of a planar curve, before it is flattened
SPACE_TABLE_SHAPE = (3 * ORDERS, TERMS)  # of that of a space curve
PERIOD = 2 * np.pi  # [rad]
GRID = 256  # of a series, see `Curve.grid`
_ORDER = np.arange(1.0, HARMONICS + 1)


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Curve(ABC):
    """A curve σ(θ), θ in [-π, π] (periodic when closed), in d = 2 or 3 dimensions.

    Attributes:
        closed: whether the curve is closed.
        equation: s = ... in z1 and z2, if the curve consists of the points where s is 0.
        deviation: largest distance between the curve and the straight lines between the points to
            which it was fitted, [m]; 0 if it was not fitted.
        given: these points, thinned if there are very many, shape (n, 2), [m]; those of a closed
            curve end with the first one, and there is a row of NaN between those of two strokes.
            None if it was not fitted.
    """

    closed: bool
    equation: str | None = field(default=None, kw_only=True)
    deviation: float = field(default=0.0, kw_only=True)
    given: Array | None = field(default=None, kw_only=True)

    def __repr__(self) -> str:
        kind, size = "closed" if self.closed else "open", 1e3 * np.ptp(self._seen(), axis=0)
        extent = " x ".join(f"{each:.0f}" for each in size)
        return f"<{kind} path, {1e3 * self.length():.0f} mm long, {extent} mm>"

    def _repr_svg_(self) -> str:
        """A drawing for notebooks: plan view, given points dashed, and a dot where runs begin."""
        strokes = [1e3 * each[:, :2] * (1, -1) for each in self.strokes()]
        z = np.concatenate(strokes)
        (left, top), (width, height) = z.min(0) - 5, np.ptp(z, axis=0) + 10
        x, y = 1e3 * self.at(np.array(self.begin))[:2] * (1, -1)
        given = np.empty((0, 2)) if self.given is None else 1e3 * self.given * (1, -1)
        parts = np.split(given, np.flatnonzero(np.isnan(given[:, 0])))
        lines = [_polyline(each[~np.isnan(each[:, 0])], "2") for each in parts if len(each)]
        lines += [_polyline(each) for each in strokes]
        return (
            f'<svg xmlns="http://www.w3.org/2000/svg" width="{2 * width:.0f}"'
            f' viewBox="{left:.1f} {top:.1f} {width:.1f} {height:.1f}">'
            f"{''.join(lines)}"
            f'<circle cx="{x:.1f}" cy="{y:.1f}" r="2" fill="gray"/></svg>'
        )

    def _repr_html_(self) -> str:
        """The drawing, with its dimensions."""
        return f"{self._repr_svg_()}<p>{repr(self)[1:-1]}</p>"

    def strokes(self) -> list[Array]:
        """The lines where the pen is down, as points close to each other, (n, d) each, [m]."""
        return [self.at(np.linspace(-np.pi, np.pi, self.grid + 1))]

    def _seen(self) -> Array:
        """All points of the strokes, shape (n, d), [m]."""
        return np.concatenate(self.strokes())

    def data(self) -> dict[str, Any]:
        """The curve by the names of its attributes."""
        return {f.name: getattr(self, f.name) for f in fields(self)}

    @property
    @abstractmethod
    def dimension(self) -> int:
        """d: 2 for a curve in the plane of the path, 3 for a space curve (z1, z2, ζ)."""

    @abstractmethod
    def at(self, theta: Array, order: int = 0) -> Array:
        """σ or one of its derivatives at θ, shape (...,) -> (..., d), [m/rad^order].

        An open curve continues along its end tangents: σ(θ) = σ(±π) + (θ ∓ π) σ'(±π), and its
        second and third derivatives are 0 there.

        Args:
            theta: [rad].
            order: 0 for σ, 1 to 3 for a derivative.
        """

    @abstractmethod
    def all_orders(self, theta: Array) -> list[Array]:
        """[σ, σ', σ'', σ'''] at θ, shape (..., n) -> four arrays (..., n, d).

        Equal to four calls of `at`, but evaluates the basis once.
        """

    @abstractmethod
    def table(self) -> Array:
        """The curve's coefficients for the compiled loop, flat; their number depends only on d."""

    @property
    @abstractmethod
    def coefficients(self) -> Array:
        """The numbers which, with `closed`, determine the curve."""

    @property
    @abstractmethod
    def plan(self) -> Curve:
        """The plan view z(θ) of a space curve; a planar curve itself."""

    def draws(self, theta: Array) -> NDArray[np.bool_]:
        """Whether the pen is down at θ, of the same shape."""
        return np.ones(np.shape(theta), dtype=bool)

    @property
    def begin(self) -> float:
        """θ at which runs begin, [rad]."""
        return 0.0

    @property
    def grid(self) -> int:
        """Number of evenly spaced θ that miss no bend and no valley of a distance."""
        return GRID

    def sample(self, count: int | None = None) -> Array:
        """`count` evenly spaced θ, [rad]; a closed curve's end point is omitted.

        Args:
            count: None: `grid`.
        """
        return np.linspace(-np.pi, np.pi, count or self.grid, endpoint=not self.closed)

    def curvature(self, theta: Array) -> Array:
        """Signed curvature κ = (σ'_1 σ''_2 - σ'_2 σ''_1) / |σ'|³, shape (...,) -> (...), [1/m].

        It is positive where the curve turns left. That of a space curve is |σ' × σ''| / |σ'|³.
        """
        first, second = self.at(theta, 1), self.at(theta, 2)
        if self.dimension == 3:
            bend = np.linalg.norm(np.cross(first, second), axis=-1)
            return bend / np.maximum(np.linalg.norm(first, axis=-1), 1e-12) ** 3
        speed = np.maximum(np.hypot(first[..., 0], first[..., 1]), 1e-12)
        return (first[..., 0] * second[..., 1] - first[..., 1] * second[..., 0]) / speed**3

    def turning(self, theta: Array) -> Array:
        """κ |σ'| >= 0, by which the tangent turns per radian of θ, shape (...,) -> (...,)."""
        return np.abs(self.curvature(theta)) * np.linalg.norm(self.at(theta, 1), axis=-1)

    def arc(self, theta: Array) -> Array:
        """Arc length from -π to θ, and on over further turns, shape (...,) -> (...,), [m].

        It is that of straight lines between 4 `grid` points.
        """
        theta = np.asarray(theta, dtype=float)
        even = np.linspace(-np.pi, np.pi, 4 * self.grid + 1)
        steps = np.linalg.norm(np.diff(self.at(even), axis=0), axis=-1)
        s = np.concatenate([[0.0], np.cumsum(steps)])
        if self.closed:
            turns = np.floor((theta + np.pi) / PERIOD)
            return np.interp(theta - PERIOD * turns, even, s) + turns * s[-1]
        ends = np.linalg.norm(self.at(even[[0, -1]], 1), axis=-1)
        speed: Array = np.where(theta > 0, float(ends[1]), float(ends[0]))
        inner: Array = np.clip(theta, -np.pi, np.pi)
        return np.interp(theta, even, s) + (theta - inner) * speed

    def length_between(self, begin: float, end: float) -> float:
        """Arc length between two parameters less than a turn apart, [m].

        It is that of straight lines, as many to a turn as in `arc`, and at least one.
        """
        pieces = int(np.ceil(4 * self.grid * abs(end - begin) / PERIOD)) or 1
        points = self.at(np.linspace(begin, end, pieces + 1))
        return float(np.linalg.norm(np.diff(points, axis=0), axis=-1).sum())

    def length(self) -> float:
        """Arc length ∫ |σ'| dθ over [-π, π], [m], from 4 `grid` samples.

        On a closed curve this is the mean of a periodic function, which converges exponentially.
        """
        theta = self.sample(4 * self.grid)
        speed = np.linalg.norm(self.at(theta, 1), axis=-1)
        if self.closed:
            return float(speed.mean() * PERIOD)
        return float(np.trapezoid(speed, theta))

    def nearest(self, z: Array, samples: int | None = None) -> tuple[Array, Array]:
        """Closest points of the curve, ϖ(z) = argmin |z - σ(θ)|, by global search.

        This search is the reference for tests of all faster projections.

        Args:
            z: points, shape (n, d), [m].
            samples: size of the grid on which the search starts; None: `grid`.

        Returns:
            θ, shape (n,), [rad], and the distances, shape (n,), [m].

        Source: eq. (7).
        """
        return nearest(self.at, self.sample(samples), z)

    def conic(self) -> tuple[Array, Array, float] | None:
        """The level set s(z) of an ellipse, see `SeriesCurve.conic`; None for any other curve."""
        return None


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class SeriesCurve(Curve):
    """A curve as a series: Fourier if it is closed, Chebyshev if it is open.

    Attributes:
        series: coefficients of σ, σ', σ'' and σ''', shape (ORDERS, TERMS, d). For each order: the
            constant, K rows for C_k and K rows for S_k; [m] for σ, [m/rad^i] for its i-th
            derivative.
    """

    series: Array

    @property
    @override
    def dimension(self) -> int:
        return self.series.shape[-1]

    @override
    def at(self, theta: Array, order: int = 0) -> Array:
        theta = np.asarray(theta, dtype=float)
        inner = theta if self.closed else np.clip(theta, -np.pi, np.pi)
        value = _basis(inner, self.closed) @ self.series[order]
        if self.closed:
            return value
        beyond = (theta - inner)[..., None]
        if order == 0:
            return value + beyond * self.at(inner, 1)
        return value if order == 1 else np.where(beyond == 0, value, 0.0)

    @override
    def all_orders(self, theta: Array) -> list[Array]:
        inner = theta if self.closed else np.clip(theta, -np.pi, np.pi)
        basis = _basis(inner, self.closed)
        values = [basis @ self.series[order] for order in range(ORDERS)]
        if not self.closed:
            beyond = (theta - inner)[..., None]
            values[0] = values[0] + beyond * values[1]
            values[2:] = [np.where(beyond == 0, value, 0.0) for value in values[2:]]
        return values

    @override
    def table(self) -> Array:
        """The coefficients for the compiled loop: a (d ORDERS, TERMS) matrix, flat, by columns.

        Its product with the basis at θ is (σ, σ', σ'', σ'''), d rows each. It shares the memory
        of `series` if possible.
        """
        return np.ascontiguousarray(self.series.transpose(1, 0, 2)).ravel()

    @property
    @override
    def coefficients(self) -> Array:
        return self.series

    @property
    @override
    def plan(self) -> SeriesCurve:
        return self if self.dimension == 2 else SeriesCurve(self.closed, self.series[..., :2])

    def terms(self) -> Array:
        """The coefficients of σ alone, shape (TERMS or HARMONICS + 1, d), [m]; see `from_terms`."""
        return self.series[0, : terms_of(self.closed)]

    @override
    def conic(self) -> tuple[Array, Array, float] | None:
        """The level set s(z) of an ellipse; None for any other curve.

        The ellipse σ(θ) = c + A (cos θ, sin θ), with any centre, half-axes and directions, is where

            s(z) = (z - c)ᵀ G (z - c) - r² = 0,   G = r² A⁻ᵀ A⁻¹,   r² = |det A|,

        which makes r² the product of the half-axes, and G = I for a circle.

        Returns:
            (c, g, r²): shapes (2,), (3,) and a number, [m], [1], [m²], with g = (G11, G22, G12).

        Source: eqs. (15), (23).
        """
        if self.dimension != 2:
            return None
        table = self.series[0]
        others = np.delete(table, [0, 1, 1 + HARMONICS], axis=0)
        a11, a21 = table[1]
        a12, a22 = table[1 + HARMONICS]
        determinant = a11 * a22 - a12 * a21
        if not self.closed or determinant == 0 or np.abs(others).max() > 1e-9:
            return None
        weights = np.array([a21**2 + a22**2, a11**2 + a12**2, -(a11 * a21 + a12 * a22)])
        area = abs(float(determinant))
        return table[0], weights / area, area


def _polyline(points: Array, dashes: str = "none") -> str:
    """An element of an SVG drawing."""
    corners = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
    style = f'fill="none" stroke="gray" stroke-dasharray="{dashes}"'
    return f'<polyline points="{corners}" {style}/>'


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
        at_left, at_right = np.split(squared(np.concatenate([left, right], axis=1)), 2, axis=1)
        nearer_left = at_left < at_right
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


def fourier(constant: Array, cosine: Array, sine: Array) -> SeriesCurve:
    """The closed curve σ(θ) = a_0 + Σ_k a_k cos kθ + b_k sin kθ.

    Args:
        constant: a_0, shape (d,), [m].
        cosine, sine: a_k and b_k for k = 1.., shape (up to HARMONICS, d), [m].
    """
    k, d = np.arange(1, HARMONICS + 1)[:, None], len(constant)
    a, b = np.zeros((HARMONICS, d)), np.zeros((HARMONICS, d))
    a[: len(cosine)], b[: len(sine)] = cosine, sine
    orders = [np.vstack([constant, a, b])]
    for _ in range(ORDERS - 1):
        a, b = k * b, -k * a
        orders.append(np.vstack([np.zeros(d), a, b]))
    return SeriesCurve(True, by_terms(orders))


def chebyshev_curve(coefficients: Array) -> SeriesCurve:
    """The open curve σ(θ) = Σ_k c_k T_k(θ / π).

    Args:
        coefficients: c_k for k = 0.., shape (up to HARMONICS + 1, d), [m].
    """
    orders: list[Array] = []
    for order in range(ORDERS):
        table = np.zeros((TERMS, coefficients.shape[1]))
        derived = chebyshev.chebder(coefficients, order) if order else coefficients
        table[: len(derived)] = derived / np.pi**order
        orders.append(table)
    return SeriesCurve(False, by_terms(orders))


def by_terms(orders: list[Array]) -> Array:
    """The series of a curve from its orders, laid out so that `Curve.table` needs no copy."""
    return np.stack(orders, axis=1).transpose(1, 0, 2)


def terms_of(closed: bool) -> int:
    """Number of coefficients that determine a curve: see `Curve.terms`."""
    return TERMS if closed else HARMONICS + 1


def from_terms(closed: bool, terms: Array) -> SeriesCurve:
    """The inverse of `Curve.terms`."""
    if not closed:
        return chebyshev_curve(terms)
    return fourier(terms[0], terms[1 : HARMONICS + 1], terms[HARMONICS + 1 :])


def ellipse(
    half_axes: tuple[float, float],
    centre: tuple[float, float] = (0.0, 0.0),
    angle: float = 0.0,
) -> SeriesCurve:
    """σ(θ) = c + R (a cos θ, b sin θ) with the rotation R by an angle, represented exactly.

    Args:
        half_axes: (a, b), [m].
        centre: c, [m].
        angle: of the first half-axis to the first coordinate, [rad].
    """
    a, b = half_axes
    along = np.array([np.cos(angle), np.sin(angle)])
    across = np.array([0.0 - along[1], along[0]])
    return fourier(np.array(centre), a * along[None], b * across[None])


def circle(radius: float, centre: tuple[float, float] = (0.0, 0.0)) -> SeriesCurve:
    """σ(θ) = c + r (cos θ, sin θ), represented exactly.

    Args:
        radius: r, [m].
        centre: c, [m].

    Source: section III.B, eq. (15).
    """
    return ellipse((radius, radius), centre)


def segment(start: tuple[float, float], end: tuple[float, float]) -> SeriesCurve:
    """The straight segment from `start` (θ = -π) to `end` (θ = π), [m]."""
    a, b = np.array(start), np.array(end)
    return chebyshev_curve(np.stack([(a + b) / 2, (b - a) / 2]))
