"""Space curves over planar curves, with any height or as a saddle."""

from __future__ import annotations

import numpy as np

from onpath.models.paths.curves import Curve, chebyshev_curve, fourier


def in_space(curve: Curve, height: Curve | None = None) -> Curve:
    """The space curve (z(θ), ζ(θ)) with this planar curve as its plan view.

    Args:
        curve: z, in the plane of the path.
        height: ζ as the first coordinate of a curve, closed or open as z is; None: 0.
    """
    zeta = np.zeros_like(curve.series[..., :1]) if height is None else height.series[..., :1]
    return Curve(curve.closed, np.concatenate([curve.series, zeta], axis=-1))


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
    if curve.closed:
        none = np.zeros((2, 1))
        return in_space(curve, fourier(np.zeros(1), np.array([[0.0], [rise]]), none))
    return in_space(curve, chebyshev_curve(np.array([[0.0], [0.0], [rise]])))
