"""Fits curves to control points.

A cubic spline through the points, or the polyline through many of them, is resampled at equal arc
length. A closed curve is then the Fourier series of the samples, truncated after `HARMONICS`; an
open curve is their Chebyshev series of that degree, fitted by least squares.
"""

from __future__ import annotations

from dataclasses import replace
from math import dist
from typing import TYPE_CHECKING, Literal, TypeVar

import numpy as np
from numpy.polynomial import chebyshev

from onpath.models.arrays import Array
from onpath.models.errors import CodedError, Message
from onpath.models.paths.curves import HARMONICS, Curve, SeriesCurve, chebyshev_curve, fourier

if TYPE_CHECKING:
    from scipy.interpolate import CubicSpline

C = TypeVar("C", bound=Curve)
SAMPLES = 256  # points at equal arc length to which a series is fitted
FINE = 16 * SAMPLES  # straight lines whose lengths are summed
SHORTEST = 0.02  # [m], shortest total length of a path
DENSE = 2048  # points that represent a curve or a line
BETWEEN, DENSEST = 32, 40_000  # points between two given ones, and all of them, of a smooth line
APART = 1e-4  # [m], least distance of consecutive points
FAR = 4e-3  # [m], deviation of a curve above which its user is told


def closed_through(points: Array) -> SeriesCurve:
    """A smooth closed curve near the given points, in their order.

    The curve does not pass exactly through the points, because its series is truncated. With
    samples z_n at θ_n = -π + 2πn/N and their discrete Fourier transform c_k (divided by N), the
    coefficients of cos kθ and sin kθ are

        a_k = 2 (-1)^k Re c_k,    b_k = -2 (-1)^k Im c_k.

    Args:
        points: shape (n, 2) with n >= 3, [m].

    Raises:
        ValueError: points that are not finite, fewer than three distinct points, or a total length
            below `SHORTEST`.
    """
    points = distinct(points, least=3)
    ring = np.vstack([points, points[:1]])
    spline = _spline_through(ring, "periodic")
    return _fourier_of(_equal_arc(spline, endpoint=False))


def fitted(points: Array, closed: bool) -> SeriesCurve:
    """`closed_through` or `open_through`, with the deviation of the curve."""
    curve = closed_through(points) if closed else open_through(points)
    return with_deviation(curve, points)


def with_deviation(curve: C, points: Array) -> C:
    """The curve with the points that it was `given`, and its `deviation` from the lines between.

    It is the larger of two distances: the largest from the curve to the lines, and the largest from
    the lines to the curve, each represented by `DENSE` points. On a path of 0.4 m it is at most 0.1
    mm too large.

    Args:
        points: shape (n, 2), [m]; a closed curve has a line from the last to the first.
    """
    from scipy.spatial import KDTree  # slow to import; see app/server/warm_up.py

    line = np.vstack([points, points[:1]]) if curve.closed else np.asarray(points, dtype=float)
    s = _arc_length(line)
    even = _even(0, s[-1], DENSE)
    corners = line[:: len(line) // DENSE + 1]
    lines = np.vstack([np.stack([np.interp(even, s, line[:, i]) for i in (0, 1)], axis=1), corners])
    seen = curve.at(_even(-np.pi, np.pi, DENSE))
    distances = KDTree(lines).query(seen)[0], KDTree(seen).query(lines)[0]
    given = line[:: len(line) // DENSE + 1]
    return replace(curve, deviation=float(np.concatenate(distances).max()), given=given)


def deviation_remark(curve: Curve) -> Message | None:
    """A remark for the user if a curve is more than `FAR` from the given points; else None."""
    if curve.deviation <= FAR:
        return None
    return Message("say.deviates", {"deviation": f"{1e3 * curve.deviation:.1f}"})


def deviation_of(curve: Curve) -> Message:
    """How far a curve is from the given points, for the user."""
    return Message("say.deviation", {"deviation": f"{1e3 * curve.deviation:.2g}"})


def along(points: Array, closed: bool) -> SeriesCurve:
    """A curve along the straight lines between points, in their order.

    See `closed_through` and `open_through` for the series.

    Args:
        points: shape (n, 2), [m].
        closed: whether the last point is joined to the first.

    Raises:
        ValueError: see `distinct`.
    """
    distinct(points, least=3 if closed else 2)
    line = np.vstack([points, points[:1]]) if closed else points
    s = _arc_length(line)
    even = _even(0, s[-1], SAMPLES, endpoint=not closed)
    samples = np.stack([np.interp(even, s, line[:, i]) for i in (0, 1)], axis=1)
    return _fourier_of(samples) if closed else _chebyshev_of(samples)


def open_through(points: Array) -> SeriesCurve:
    """A smooth open curve near the given points, from the first to the last.

    Two points give the straight segment between them.

    Args:
        points: shape (n, 2) with n >= 2, [m].

    Raises:
        ValueError: points that are not finite, fewer than two distinct points, or a total length
            below `SHORTEST`.
    """
    points = distinct(points, least=2)
    if len(points) == 2:
        return chebyshev_curve(np.stack([points.mean(0), (points[1] - points[0]) / 2]))
    spline = _spline_through(points, "natural")
    return _chebyshev_of(_equal_arc(spline, endpoint=True))


def smooth_through(points: Array, closed: bool) -> Array:
    """Points close to each other on a cubic spline through the given ones, shape (n, 2), [m].

    It begins and ends with them; the last point of a closed one is not its first one again.

    Args:
        points: shape (n, 2), [m].
        closed: whether the last point is joined to the first.

    Raises:
        ValueError: see `distinct`.
    """
    points = distinct(points, least=3 if closed else 2)
    if len(points) == 2:
        return points
    line = np.vstack([points, points[:1]]) if closed else points
    spline = _spline_through(line, "periodic" if closed else "natural")
    each = max(1, min(BETWEEN, DENSEST // len(points)))  # points of an interval
    at = np.interp(np.arange(each * (len(line) - 1) + 1) / each, np.arange(len(line)), spline.x)
    smooth = np.asarray(spline(at), dtype=np.float64)
    return smooth[:-1] if closed else smooth


def control_points(curve: Curve, count: int) -> Array:
    """`count` points on a curve at equal arc length, shape (count, 2), [m].

    The ends of an open curve are included.
    """
    theta = _even(-np.pi, np.pi, 2049)
    points = curve.at(theta)
    s = _arc_length(points)
    even = _even(0, s[-1], count, endpoint=not curve.closed)
    return curve.at(np.interp(even, s, theta))


def distinct(points: Array, least: int) -> Array:
    """The points that are `APART` from the one kept before them, shape (n, 2) -> (k, 2).

    A last point that coincides with the first is dropped.

    Raises:
        ValueError: a wrong shape, points that are not finite, fewer than `least` distinct points,
            or a total length below `SHORTEST`.
    """
    kept = apart(points)
    if len(kept) < least:
        raise CodedError("error.points_coincide", least=least)
    check_length(float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum()))
    if np.linalg.norm(kept[0] - kept[-1]) < APART:
        kept = kept[:-1]
    if len(kept) < least:
        raise CodedError("error.points_coincide", least=least)
    return kept


def apart(points: Array) -> Array:
    """The points that are `APART` from the one kept before them, shape (n, 2) -> (k, 2).

    Raises:
        ValueError: a wrong shape, or points that are not finite.
    """
    points = np.asarray(points, dtype=float)
    if points.ndim != 2 or points.shape[1] != 2 or not np.all(np.isfinite(points)):
        raise ValueError("a path needs finite points, shape (n, 2)")
    kept = list[list[float]]()
    for point in points.tolist():
        if not kept or dist(point, kept[-1]) > APART:
            kept.append(point)
    return np.array(kept).reshape(-1, 2)


def check_length(length: float) -> None:
    """Refuse a path that is shorter than `SHORTEST`, [m].

    Raises:
        CodedError: it is.
    """
    if length < SHORTEST:
        given, shortest = (f"{1e3 * each:.0f}" for each in (length, SHORTEST))
        raise CodedError("error.path_too_short", length=given, least=shortest)


def _arc_length(points: Array) -> Array:
    """Arc length of a polyline up to each of its points, shape (n, 2) -> (n,), [m]."""
    return np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])


def _even(low: float, high: float, count: int, endpoint: bool = True) -> Array:
    """`count` evenly spaced numbers from `low` to `high`, shape (count,)."""
    return np.linspace(float(low), float(high), count, endpoint=endpoint, dtype=np.float64)


def _spline_through(points: Array, ends: Literal["periodic", "natural"]) -> CubicSpline:
    from scipy.interpolate import CubicSpline  # slow to import; see app/server/warm_up.py

    return CubicSpline(_chords(points), points, bc_type=ends)


def _chords(points: Array) -> Array:
    """Centripetal knots t_(i+1) = t_i + sqrt(|z_(i+1) - z_i|), shape (n, 2) -> (n,).

    They keep a spline through unevenly spaced points free of loops.
    """
    gaps = np.sqrt(np.linalg.norm(np.diff(points, axis=0), axis=1))
    return np.concatenate([[0.0], np.cumsum(gaps)])


def _equal_arc(spline: CubicSpline, endpoint: bool) -> Array:
    """`SAMPLES` points of a spline at equal arc length, shape (SAMPLES, 2), [m]."""
    knots = _even(spline.x[0], spline.x[-1], FINE + 1)
    points = np.asarray(spline(knots), dtype=np.float64)
    s = _arc_length(points)
    even = _even(0, s[-1], SAMPLES, endpoint=endpoint)
    return np.asarray(spline(np.interp(even, s, knots)), dtype=np.float64)


def _fourier_of(samples: Array) -> SeriesCurve:
    """The truncated Fourier series of samples at θ_n = -π + 2πn/N, shape (N, d)."""
    spectrum = np.fft.rfft(samples, axis=0) / len(samples)
    harmonics = spectrum[1 : HARMONICS + 1] * _half_turns()[:, None]
    return fourier(spectrum[0].real, 2 * harmonics.real, -2 * harmonics.imag)


def _chebyshev_of(samples: Array) -> SeriesCurve:
    """The Chebyshev series that fits samples at evenly spaced θ best, shape (SAMPLES, 2)."""
    x = _even(-1, 1, SAMPLES)
    coefficients: Array = chebyshev.chebfit(x, samples, HARMONICS).astype(np.float64)
    return chebyshev_curve(coefficients)


def _half_turns() -> Array:
    """The factors (-1)^k, shape (HARMONICS,): θ starts at -π, the Fourier transform at 0."""
    return np.array([(-1.0) ** k for k in range(1, HARMONICS + 1)])
