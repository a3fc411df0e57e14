"""Random drawings: splines of many bends whose parameter is the time of a profile."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import BSpline, CubicSpline

from onpath.models.arrays import Array
from onpath.models.paths.spline_curves import DEGREE, SplineCurve
from onpath.models.paths.spline_fit import spline_through


def random_drawing(
    seed: int, pieces: int = 120, size: float = 0.05, closed: bool = False
) -> SplineCurve:
    """A scrawl through random points within ±size [m], slower in bends: κv <= 20 / s at 0.1 m/s."""
    corners = size * np.random.default_rng(seed).uniform(-1, 1, (max(4, pieces // 12), 2))
    if closed:
        corners = np.vstack([corners, corners[:1]])
    line = CubicSpline(
        np.arange(len(corners)), corners, bc_type="periodic" if closed else "natural"
    )
    u = np.linspace(0, len(corners) - 1, 30 * pieces + 1)
    first, second = line(u, 1), line(u, 2)
    speed = np.linalg.norm(first, axis=1)
    bend = np.abs(first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]) / speed**2
    slowness = np.maximum(speed / 0.1, bend / 20)
    weights = np.hanning(31) / np.hanning(31).sum()
    slowness = np.convolve(
        np.pad(slowness, 15, mode="wrap" if closed else "edge"), weights, "valid"
    )
    time = np.concatenate([[0.0], np.cumsum((slowness[1:] + slowness[:-1]) / 2)])
    return through(time / time[-1], line(u), pieces, closed)


def scrawl(seed: int) -> SplineCurve:
    """A random line of some 400 mm as the product fits it, for robots that can follow it."""
    corners = 0.05 * np.random.default_rng(seed).uniform(-1, 1, (9, 2))
    line = CubicSpline(np.arange(9), corners)(np.linspace(0, 8, 800))
    return spline_through([line], False)


def signature(seed: int, size: float = 0.12) -> Array:
    """A stroke like a name, as a mouse, a finger or a pen gives it (0, 1, 2 modulo 3), [m].

    Loops of random height go on to the right; a third of them has a flourish back below the name.
    """
    rng, hand = np.random.default_rng(seed), seed % 3
    n = int(rng.integers(4, 9))
    t = np.linspace(0, n, 1200)
    high = np.interp(t, np.arange(n + 1), rng.uniform(0.25, 1.0, n + 1))
    wide = rng.uniform(0.5, 0.9) * np.interp(t, np.arange(n + 1), rng.uniform(0.3, 1, n + 1))
    x = 0.8 * t + wide * np.cos(2 * np.pi * t + rng.uniform(0, 6))
    y = high * np.sin(2 * np.pi * t) + 0.25 * rng.normal() * np.sin(np.pi * t / n)
    x += 0.3 * high * np.sin(2 * np.pi * t) * rng.uniform(0, 1)
    if hand == 0:
        u = np.linspace(0, 1, 300)
        down = (-1.5 - y[-1]) * np.sin(np.pi / 2 * u) + 0.2 * np.sin(9 * u)
        x = np.r_[x, x[-1] - u * (x[-1] - x[0]) * rng.uniform(0.6, 1.1)]
        y = np.r_[y, y[-1] + down]
    rate = (60, 90, 200)[hand]  # [Hz]
    z = np.column_stack([x, y])[:: max(1, int(1500 / (rate * n / 3)))]
    z = (z - (z.max(0) + z.min(0)) / 2) / np.ptp(z, axis=0).max() * size
    if hand == 0:
        return np.round(z / (size / 400)) * (size / 400)
    return z + rng.normal(0, size * 0.002, z.shape) if hand == 1 else z


def letters() -> SplineCurve:
    """An A and an L in three strokes, 60 mm wide."""
    strokes = (
        [(-0.05, -0.02), (-0.04, 0.02), (-0.03, -0.02)],
        [(-0.045, -0.005), (-0.035, -0.005)],
        [(-0.01, 0.02), (-0.01, -0.02), (0.01, -0.02)],
    )
    return spline_through([np.array(stroke) for stroke in strokes], False)


def star() -> SplineCurve:
    """A star of five tips, 95 mm wide."""
    turn = np.pi / 5 * np.arange(10)
    radius = np.where(np.arange(10) % 2, 0.02, 0.05)
    return spline_through([radius[:, None] * np.column_stack([np.sin(turn), np.cos(turn)])], True)


def through(time: Array, z: Array, pieces: int, closed: bool) -> SplineCurve:
    """The spline of least squares through points at times from 0 to 1."""
    place = np.clip(time * pieces, 0, pieces * (1 - 1e-12))
    knots = np.arange(-DEGREE, pieces + DEGREE + 1, dtype=float)
    design = BSpline.design_matrix(place, knots, DEGREE)
    squares, products = (design.T @ design).toarray(), np.asarray(design.T @ z)
    if closed:
        same = np.eye(pieces)[np.arange(pieces + DEGREE) % pieces]
        squares, products = same.T @ squares @ same, same.T @ products
    points: Array = np.linalg.solve(squares, products).astype(np.float64)
    return SplineCurve(closed, np.vstack([points, points[:DEGREE]]) if closed else points)
