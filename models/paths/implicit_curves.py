"""Paths given by an equation s(z) = 0, traced and approximated by a closed Fourier curve.

The zero set is found by marching squares on a grid, and each of its points is moved onto it by
Newton's method along the gradient:

    z ← z - s(z) ∇s(z) / |∇s(z)|²

Such paths are followed by their distance, or by s itself, see models/control/implicit_level.py.
"""

from __future__ import annotations

import casadi as ca
import numpy as np
from contourpy import contour_generator

from onpath.models.arrays import Array
from onpath.models.errors import CodedError
from onpath.models.paths.curve_fit import closed_through
from onpath.models.paths.curves import Curve

REGION = 0.25  # [m]; the zero set is looked for in [-REGION, REGION]²
CELLS = 300  # of the grid, along each axis
NEWTON_STEPS = 8
MOST_APART = 2e-4  # [m], largest distance of the curve from the zero set


def implicit_curve(s: ca.Function) -> Curve:
    """The closed curve on which a function s vanishes.

    Args:
        s: z -> s(z), (2, 1) -> (1, 1), with z in [m].

    Raises:
        ValueError: s does not vanish on exactly one closed line within `REGION`, or a Fourier
            series of `HARMONICS` terms does not come close enough to it.
    """
    z = ca.SX.sym("z", 2)
    with_gradient = ca.Function("s", [z], [s(z), ca.gradient(s(z), z)])
    side = np.linspace(-REGION, REGION, CELLS + 1)
    first, second = np.meshgrid(side, side)
    values, _ = _evaluated(with_gradient, np.stack([first.ravel(), second.ravel()], axis=1))
    grid = np.ma.masked_invalid(values.reshape(first.shape))
    lines = [
        np.asarray(line, dtype=np.float64)
        for line in contour_generator(side, side, grid).lines(0.0)
    ]
    if len(lines) != 1 or not np.array_equal(lines[0][0], lines[0][-1]):
        raise CodedError("error.implicit_lines", count=len(lines), region=round(1e3 * REGION))
    points = _onto(with_gradient, lines[0][:-1])
    curve = closed_through(points)
    apart = float(curve.nearest(points)[1].max())
    if not apart < MOST_APART:
        raise CodedError("error.implicit_shape", apart=f"{1e3 * apart:.1f}")
    return curve


def _evaluated(function: ca.Function, points: Array) -> tuple[Array, Array]:
    """s, (n,), and its gradient, (n, 2), at points, (n, 2)."""
    s, gradient = function(points.T)
    return np.asarray(s, dtype=np.float64)[0], np.asarray(gradient, dtype=np.float64).T


def _onto(function: ca.Function, points: Array) -> Array:
    """The points, moved onto the zero set."""
    for _ in range(NEWTON_STEPS):
        s, gradient = _evaluated(function, points)
        points = points - (s / (gradient**2).sum(1))[:, None] * gradient
    return points
