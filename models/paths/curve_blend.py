"""A blend of two curves, and the shift of the parameter that it needs."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from onpath.models.arrays import Array
from onpath.models.paths.curves import HARMONICS, Curve, SeriesCurve, chebyshev_curve, fourier
from onpath.models.paths.space_curves import in_space
from onpath.models.paths.spline_curves import SplineCurve

_ORDER = np.arange(1.0, HARMONICS + 1)


def blend(old: Curve, new: Curve, fraction: float) -> Curve:
    """The curve (1 - fraction) old + fraction new, which must be of a kind, see `mixes`.

    If one of them is a space curve, the other is taken at height 0.
    """
    d = max(old.dimension, new.dimension)
    old, new = (curve if curve.dimension == d else in_space(curve) for curve in (old, new))
    mixed = (1 - fraction) * old.coefficients + fraction * new.coefficients
    if isinstance(new, SplineCurve):
        return replace(new, points=mixed, given=None, deviation=0.0)
    return SeriesCurve(new.closed, mixed)


def mixes(old: Curve, new: Curve) -> bool:
    """Whether two curves can be blended.

    Both are closed or open, and both series, or the same drawing with other control points.
    """
    if old.closed != new.closed or type(old) is not type(new):
        return False
    if isinstance(old, SplineCurve) and isinstance(new, SplineCurve):
        same = old.pieces, old.raised, old.duration
        return same == (new.pieces, new.raised, new.duration)
    return True


def aligned(curve: SeriesCurve, to: SeriesCurve) -> SeriesCurve:
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


def _harmonics(curve: SeriesCurve) -> tuple[Array, Array]:
    """The Fourier coefficients a_k and b_k of a closed curve, each (HARMONICS, 2), [m]."""
    return curve.series[0, 1 : HARMONICS + 1], curve.series[0, HARMONICS + 1 :]
