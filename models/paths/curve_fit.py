"""Curves from what a hand gives: control points or a freehand stroke.

Periodic resampling at equal arc length, then FFT, low-passed (closed), or a Chebyshev fit (open).
"""

from __future__ import annotations

import numpy as np
from numpy.polynomial import chebyshev
from scipy.interpolate import CubicSpline

from onpath.models.arrays import Array
from onpath.models.errors import CodedError
from onpath.models.paths.curves import HARMONICS, Curve, chebyshev_curve, fourier

SAMPLES = 256
SHORTEST = 0.02  # [m], total length below which a stroke is no path


def closed_through(points: Array) -> Curve:
    """A smooth closed curve through (nearly: it is low-passed) the points, in their order.

    Args:
        points: shape (n, 2) with n >= 3, [m].

    Raises:
        ValueError: too few points, or all of them in one place.
    """
    points = _distinct(points, least=3)
    ring = np.vstack([points, points[:1]])
    spline = CubicSpline(_chords(ring), ring, bc_type="periodic")
    samples = _equal_arc(spline, endpoint=False)
    spectrum = np.fft.rfft(samples, axis=0) / SAMPLES
    harmonics = spectrum[1 : HARMONICS + 1] * _half_turns()[:, None]
    return fourier(spectrum[0].real, 2 * harmonics.real, -2 * harmonics.imag)


def open_through(points: Array) -> Curve:
    """A smooth open curve near the points, from the first to the last; two give a segment.

    Raises:
        ValueError: too few points, or all of them in one place.
    """
    points = _distinct(points, least=2)
    if len(points) == 2:
        return chebyshev_curve(np.stack([points.mean(0), (points[1] - points[0]) / 2]))
    spline = CubicSpline(_chords(points), points, bc_type="natural")
    samples = _equal_arc(spline, endpoint=True)
    x = _even(-1, 1, SAMPLES)
    coefficients: Array = chebyshev.chebfit(x, samples, HARMONICS).astype(np.float64)
    return chebyshev_curve(coefficients)


def from_stroke(points: Array, closed: bool, passes: int = 40) -> Curve:
    """A curve from a freehand stroke: evened out, smoothed, then fitted.

    Args:
        points: the stroke as it was drawn, shape (n, 2), [m].
        closed: whether to join the ends.
        passes: rounds of smoothing of 96 evenly spaced points; takes the tremor out.

    Raises:
        ValueError: the stroke is too short.
    """
    points = _distinct(points, least=3)
    if closed:
        points = np.vstack([points, points[:1]])
    s = _arc_length(points)
    even = _even(0, s[-1], 96, endpoint=not closed)
    line = np.column_stack([np.interp(even, s, points[:, 0]), np.interp(even, s, points[:, 1])])
    smooth = _smoothed(line, closed, passes)
    smooth = smooth + _smoothed(line - smooth, closed, passes)  # undoes most of the shrinking
    return closed_through(smooth) if closed else open_through(smooth)


def _smoothed(line: Array, closed: bool, passes: int) -> Array:
    for _ in range(passes):
        padded = np.vstack([line[-1:], line, line[:1]] if closed else [line[:1], line, line[-1:]])
        between = (padded[:-2] + 2 * line + padded[2:]) / 4
        line = between if closed else np.vstack([line[:1], between[1:-1], line[-1:]])
    return line


def control_points(curve: Curve, count: int) -> Array:
    """`count` points on the curve, evenly spaced by arc length, shape (count, 2), [m]."""
    theta = _even(-np.pi, np.pi, 2049)
    points = curve.at(theta)
    s = _arc_length(points)
    even = _even(0, s[-1], count, endpoint=not curve.closed)
    return curve.at(np.interp(even, s, theta))


def _distinct(points: Array, least: int) -> Array:
    points = np.asarray(points, dtype=float)
    if points.ndim != 2 or points.shape[1] != 2 or not np.all(np.isfinite(points)):
        raise ValueError("a path needs finite points, shape (n, 2)")
    gaps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    points = points[np.concatenate([[True], gaps > 1e-4])]
    if len(points) < least:
        raise CodedError("error.points_coincide", least=least)
    if gaps.sum() < SHORTEST:
        length, shortest = (f"{1e3 * each:.0f}" for each in (gaps.sum(), SHORTEST))
        raise CodedError("error.path_too_short", length=length, least=shortest)
    if np.linalg.norm(points[0] - points[-1]) < 1e-4:
        points = points[:-1]
    if len(points) < least:
        raise CodedError("error.points_coincide", least=least)
    return points


def _arc_length(points: Array) -> Array:
    """Of a polyline up to each of its points, shape (n,), [m]."""
    return np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])


def _even(low: float, high: float, count: int, endpoint: bool = True) -> Array:
    return np.linspace(float(low), float(high), count, endpoint=endpoint, dtype=np.float64)


def _chords(points: Array) -> Array:
    """Centripetal knots: no loops between unevenly spaced points."""
    gaps = np.sqrt(np.linalg.norm(np.diff(points, axis=0), axis=1))
    return np.concatenate([[0.0], np.cumsum(gaps)])


def _equal_arc(spline: CubicSpline, endpoint: bool) -> Array:
    knots = _even(spline.x[0], spline.x[-1], 16 * SAMPLES + 1)
    points = np.asarray(spline(knots), dtype=np.float64)
    s = _arc_length(points)
    even = _even(0, s[-1], SAMPLES, endpoint=endpoint)
    return np.asarray(spline(np.interp(even, s, knots)), dtype=np.float64)


def _half_turns() -> Array:
    """theta starts at -pi, the FFT at 0."""
    return np.array([(-1.0) ** k for k in range(1, HARMONICS + 1)])
