"""Space curves over planar curves, with any height or as a saddle."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from onpath.models.paths.curves import PERIOD, Curve, SeriesCurve, chebyshev_curve, fourier
from onpath.models.paths.spline_curves import DEGREE, SplineCurve


def in_space(curve: Curve, height: Curve | None = None) -> Curve:
    """The space curve (z(θ), ζ(θ)) with this planar curve as its plan view.

    Args:
        curve: z, in the plane of the path.
        height: ζ as the first coordinate of a curve, of the kind of z and closed or open as it is,
            with as many pieces; None: 0.
    """
    plan = curve.coefficients
    zeta = np.zeros_like(plan[..., :1]) if height is None else height.coefficients[..., :1]
    both = np.concatenate([plan, zeta], axis=-1)
    if isinstance(curve, SplineCurve):
        return replace(curve, points=both, given=None, deviation=0.0)
    return SeriesCurve(curve.closed, both)


def saddle(curve: Curve, rise: float) -> Curve:
    """The space curve over a planar one with the height ζ = rise cos 2θ; planar if rise is 0.

    Over a circle it lies on the hyperbolic paraboloid ζ = rise (z1² - z2²) / r². On an open curve
    the height is rise T_2(θ/π): up at both ends, down in the middle.

    Args:
        rise: [m].

    Raises:
        ValueError: the curve is a space curve already.
    """
    if not rise:
        return curve
    if curve.dimension == 3:
        raise ValueError("rise: the path is a space curve, and has a height already")
    if isinstance(curve, SplineCurve):
        return in_space(curve, _risen(curve, rise))
    if curve.closed:
        none = np.zeros((2, 1))
        return in_space(curve, fourier(np.zeros(1), np.array([[0.0], [rise]]), none))
    return in_space(curve, chebyshev_curve(np.array([[0.0], [0.0], [rise]])))


def _risen(curve: SplineCurve, rise: float) -> SplineCurve:
    """The height of `saddle` as a spline with the pieces of a curve.

    The control points are the height at the centres θ_j of the B-splines, corrected by what their
    sum makes of it: it is cos 2θ times w_0 + 2 Σ_k w_k cos 2kh at the knots, with the values w of a
    quintic B-spline there, and θ² + h² / 2 in place of θ².
    """
    h = PERIOD / curve.pieces
    centre = -np.pi + h * (np.arange(len(curve.points)) - (DEGREE - 1) / 2)
    if curve.closed:
        damping = (66 + 52 * np.cos(2 * h) + 2 * np.cos(4 * h)) / 120
        height = rise / damping * np.cos(2 * centre)
        height = height[np.arange(len(height)) % curve.pieces]
    else:
        height = rise * (2 * (centre**2 - h**2 / 2) / np.pi**2 - 1)
    return SplineCurve(curve.closed, height[:, None].astype(np.float64))
