"""Euclidean distance from points of the output space to the path, without any control law."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from onpath.models.arrays import Array
from onpath.models.paths.curves import PERIOD, Curve, SeriesCurve, local_minima, nearest
from onpath.models.paths.frames import Frame, Plane
from onpath.models.paths.spline_curves import SplineCurve

CHUNK = 1024  # points per array operation, which stay in the processor's cache
MOST = 4  # local minima of a distance that are refined
STILL = 1e-7  # [rad]; Newton's next step from a smaller one is lost in rounding
NEAR = 0.1  # [rad], largest correction of a guess for which its Taylor polynomial is trusted
NEAR_PIECES = 1.5  # the same on a drawing


def path_distance(frame: Frame, curve: Curve, y: Array, samples: int | None = None) -> Array:
    """Distance min over θ of |y - σ(θ)|, by global search, shape (n, p) -> (n,), [m].

    The lowest local minima over a grid are refined by Newton steps on the curve's Taylor
    polynomial. An open curve includes the continuation along its end tangents.

    Args:
        frame: how the curve's plane lies in the output space.
        curve: σ, in coordinates of that plane.
        y: points, shape (n, p), [m].
        samples: size of the grid; None: `Curve.grid`.
    """
    distances = np.empty(len(y))
    for begin in range(0, len(y), CHUNK):
        some = y[begin : begin + CHUNK]
        row, _, found = _minima(frame, curve, some, samples)
        first = np.searchsorted(row, np.arange(len(some)))
        distances[begin : begin + CHUNK] = np.minimum.reduceat(found, first)
    return distances if curve.closed else np.minimum(distances, _beyond_the_ends(frame, curve, y))


def drawn_distance(frame: Frame, curve: Curve, y: Array, theta: Array) -> Array:
    """`path_distance` where the pen is down, and 0 where it is raised: nothing is drawn there.

    Args:
        theta: where on the path the points belong, shape (n,), [rad].
    """
    return np.where(curve.draws(theta), path_distance(frame, curve, y), 0.0)


def _minima(
    frame: Frame, curve: Curve, y: Array, samples: int | None
) -> tuple[NDArray[np.intp], Array, Array]:
    """The lowest local minima of the distance from every y to the path, row by row.

    Returns:
        Row of y, θ [rad] and distance [m], each shape (m,).
    """
    grid = curve.sample(samples)
    step = float(grid[1] - grid[0])
    row, column = _candidates(_squared(y, frame.lift(curve.at(grid))), curve.closed)
    each, theta = y[row], grid[column]
    theta, distance = _refined(frame, curve, each, theta, step)
    moving = np.arange(len(theta))
    for _ in range(2):
        found, distance[moving] = _refined(frame, curve, each[moving], theta[moving], step)
        moved = np.abs(found - theta[moving]) > STILL
        theta[moving] = found
        moving = moving[moved]
    gap = frame.lift(curve.at(theta[moving])) - each[moving]
    distance[moving] = np.sqrt(_dot(gap, gap))
    return row, theta, distance


def _candidates(squared: Array, closed: bool) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Rows and columns of each row's local minima, row by row, (n, k) -> two of shape (m,)."""
    rises = squared[:, :-1] <= squared[:, 1:]
    ends = (squared[:, -1:] <= squared[:, :1]) if closed else np.ones((len(squared), 1), bool)
    after, before = np.hstack([rises, ends]), np.hstack([~ends if closed else ends, ~rises])
    is_lowest = after & before
    count = is_lowest.sum(axis=1)
    if count.min() > 0 and count.max() <= MOST:
        row, column = np.nonzero(is_lowest)
        return row, column
    column = local_minima(squared, MOST)
    return np.arange(len(squared)).repeat(MOST), column.ravel()


def _squared(y: Array, points: Array) -> Array:
    """Squared distances of all y, (n, p), to all points, (k, p), less |y|²: (n, k)."""
    sizes = (points**2).sum(axis=1)
    return np.column_stack([np.ones(len(y)), -2.0 * y]) @ np.vstack([sizes, points.T])


def _beyond_the_ends(frame: Frame, curve: Curve, y: Array) -> Array:
    """Distance to the half-lines by which an open curve continues, shape (n, p) -> (n,), [m]."""
    ends = np.array([-np.pi, np.pi])
    points = frame.lift(curve.at(ends))
    tangents = frame.lift(curve.at(ends, 1)) - frame.lift(np.zeros(2))
    away = tangents * np.sign(ends)[:, None]
    gaps = y[:, None, :] - points
    along = np.maximum((gaps * away).sum(-1), 0.0) / (away**2).sum(-1)
    return np.linalg.norm(gaps - along[..., None] * away, axis=-1).min(axis=1)


def closest_parameter(frame: Frame, curve: Curve, y: Array) -> float:
    """θ of the closest point, by global search, [rad]: ϖ(z) of (7), or in space ϖ(y).

    Args:
        y: shape (p,), [m].
    """
    given = curve.coefficients
    return _closest(frame, type(curve), curve.closed, given.shape, given.tobytes(), y.tobytes())


@lru_cache(maxsize=256)
def _closest(
    frame: Frame,
    made: type[Curve],
    closed: bool,
    shape: tuple[int, ...],
    coefficients: bytes,
    y: bytes,
) -> float:
    """`closest_parameter` by content: all labs of a class begin at the same places."""
    numbers, point = np.frombuffer(coefficients).reshape(shape), np.frombuffer(y)[None]
    curve = SplineCurve(closed, numbers) if made is SplineCurve else SeriesCurve(closed, numbers)
    if curve.dimension == 2:
        return float(curve.nearest(frame.planar(point))[0][0])
    found = nearest(lambda theta: frame.lift(curve.at(theta)), curve.sample(), point)
    return float(found[0][0])


def closest_parameters(frame: Frame, curve: Curve, y: Array) -> Array:
    """`closest_parameter` of several y, (n, p) -> (n,), [rad], by the method of `path_distance`.

    On an open curve, θ is between its ends.
    """
    if curve.dimension == 2:
        frame, y = Plane(), frame.planar(y)
    row, theta, distance = _minima(frame, curve, y, None)
    rows = [np.flatnonzero(row == number) for number in range(len(y))]
    found = np.array([theta[each[distance[each].argmin()]] for each in rows])
    return found if curve.closed else np.clip(found, -np.pi, np.pi)


def near_distance(frame: Frame, curve: Curve, y: Array, theta: Array) -> Array:
    """`path_distance` from guesses of the closest points: faster, for live display.

    Where Newton's method moves a guess by more than `NEAR`, or by more than `NEAR_PIECES` of a
    drawing, or makes it worse, the search is global.

    Args:
        y: points, shape (n, p), [m].
        theta: guesses, shape (n,), [rad].

    Returns:
        Shape (n,), [m].
    """
    return near_distances(frame, [curve], y[None], theta[None])[0]


def near_distances(frame: Frame, curves: Sequence[Curve], y: Array, theta: Array) -> Array:
    """`near_distance` to several curves at once, bit by bit the same as one by one.

    Args:
        curves: all closed, or all open; all planar, or all in space.
        y: points, shape (curves, n, p), [m].
        theta: guesses, shape (curves, n), [rad].

    Returns:
        Shape (curves, n), [m].
    """
    every = _stacked(curves)
    if every is None:
        each = zip(curves, y, theta, strict=True)
        return np.stack([near_distance(frame, *given) for given in each])
    better, distances = _refined(frame, every, y, theta)
    guessed = np.sqrt(((frame.lift(every.at(theta)) - y) ** 2).sum(-1))
    first = curves[0]
    is_drawing = isinstance(first, SplineCurve)
    near = NEAR_PIECES * PERIOD / first.pieces if is_drawing else NEAR
    astray = ~((np.abs(better - theta) < near) & (distances <= guessed + 1e-12))
    for i in np.flatnonzero(astray.any(axis=1)).tolist():
        failed, samples = astray[i], None if is_drawing else curves[i].grid // 4
        distances[i, failed] = path_distance(frame, curves[i], y[i, failed], samples)
    return distances


def _stacked(curves: Sequence[Curve]) -> Curve | None:
    """Several curves as one, which maps θ of shape (curves, n) to points (curves, n, d).

    Bit by bit the same as curve by curve. None if there are several and not all are series.

    Args:
        curves: all closed, or all open; all planar, or all in space.
    """
    if len(curves) == 1:
        return curves[0]
    series = [curve.series for curve in curves if isinstance(curve, SeriesCurve)]
    if len(series) < len(curves):
        return None
    return SeriesCurve(curves[0].closed, np.stack(series, axis=1))


def _refined(
    frame: Frame, curve: Curve, y: Array, theta: Array, reach: float = np.inf
) -> tuple[Array, Array]:
    """Improved θ and the distance there, by two Newton steps.

    With the curve's cubic Taylor polynomial P(δ) about θ, Newton's method solves (P(δ) - y) · P'(δ)
    = 0. The derivative |P'|² + (P - y) · P'' is bounded from below by a fraction of |P'|², because
    it vanishes near the centre of curvature.

    Args:
        reach: largest |δ|, [rad]. With a finite bound the derivative may become much smaller, so
            that steps can be long where nearly all of the curve is equally far away.

    Returns:
        θ + δ [rad] and |P(δ) - y| [m], each of the shape of θ.
    """
    origin = frame.lift(np.zeros(2))
    sigma, *derivatives = curve.all_orders(theta)
    point = frame.lift(sigma)
    first, second, third = (frame.lift(derivative) - origin for derivative in derivatives)
    step = np.zeros((*theta.shape, 1))
    least = 0.2 if reach == np.inf else 1e-4  # smallest derivative, in units of |P'|²
    for _ in range(2):
        gap = point + step * (first + step / 2 * (second + step / 3 * third)) - y
        tangent = first + step * (second + step / 2 * third)
        squared = _dot(tangent, tangent)
        slope = np.maximum(squared + _dot(gap, second + step * third), least * squared)
        step = np.clip(step - (_dot(gap, tangent) / slope)[..., None], -reach, reach)
    gap = point + step * (first + step / 2 * (second + step / 3 * third)) - y
    return theta + step[..., 0], np.sqrt(_dot(gap, gap))


def _dot(a: Array, b: Array) -> Array:
    """Products of vectors, (..., p) -> (...); much faster than `sum` along so short an axis."""
    products = a[..., 0] * b[..., 0]
    for axis in range(1, a.shape[-1]):
        products += a[..., axis] * b[..., axis]
    return products
