"""The tube around a path in which the closest point is unique, and the coordinates in it.

With the unit tangent T and unit normals of σ, a ball that touches the curve at σ(a) on its side N
and reaches σ(b) has the radius |d|² / (2 N · d), d = σ(b) - σ(a). Along the normal N the closest
point is σ(a) up to the smallest of these radii. As b approaches a, the radius becomes that of
curvature. The smallest one on any side is the width of the tube, in which the closest point is
unique everywhere:

    W = min over a, b of |d|² / (2 |d - (T · d) T|).

Source: Federer, Curvature measures, Transactions of the AMS 93 (1959), theorem 4.18, where W is
called the reach; section II.D of the paper, which needs such a neighbourhood of the path.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from onpath.models.arrays import Array
from onpath.models.paths.curve_faults import ambiguities
from onpath.models.paths.curves import Curve
from onpath.models.paths.spline_curves import SplineCurve

SAMPLES = 240
"""Points of a series that are compared with each other; a drawing has `Curve.grid` of them."""
ROWS = 256
"""Points that are compared with all others in one operation."""
PER_PIECE = 8
"""Places on a piece of a drawing at which its bend is taken."""
BEYOND = 0.5
"""The part of an open curve's continuation that is considered, as a share of its range of θ."""
TINY = 1e-12
STRAIGHT = 1e3
"""Radius above which a curve counts as straight, because numbers are rounded, [m]."""


@dataclass(frozen=True, slots=True, eq=False)
class CurveFrames:
    """Points of a curve and the normals there.

    Attributes:
        theta: shape (n,), [rad].
        sigma: σ(θ), shape (n, d), [m].
        normals: unit normals, shape (n, d - 1, d): to the left; in space, to the left in the plan
            view and up, as for ξ (see models/control/space_output.py).
    """

    theta: Array
    sigma: Array
    normals: Array


def tube_width(curve: Curve) -> float:
    """W, the radius of the largest tube with a unique closest point, [m]; infinite for a line.

    It is 0 for a path that crosses itself. Where the pen is up, a drawing does not count.
    """
    if any(each.check == "crosses" for each in ambiguities(curve)):
        return 0.0
    theta = _compared(curve)
    points, tangents = curve.at(theta), _tangents(curve, theta)
    width = np.inf
    for begin in range(0, len(points), ROWS):
        some = slice(begin, begin + ROWS)
        gaps, along = points - points[some, None], tangents[some, None]
        across = gaps - (gaps * along).sum(-1, keepdims=True) * along
        width = min(width, float(_radii(gaps, np.linalg.norm(across, axis=-1)).min()))
    if isinstance(curve, SplineCurve):
        theta = curve.sample(PER_PIECE * curve.pieces)
        theta = theta[curve.draws(theta)]
    curvature = np.abs(curve.curvature(theta)).max()
    width = min(width, 1 / max(float(curvature), TINY))
    return width if width < STRAIGHT else np.inf


def curve_frames(curve: Curve, theta: Array) -> CurveFrames:
    """Points and normals of a curve at θ, shape (n,)."""
    return CurveFrames(theta, curve.at(theta), _normals(_tangents(curve, theta)))


def offset(frames: CurveFrames, xi: Array) -> Array:
    """The points with these coordinates across the curve: σ(θ) + Σ ξ_i N_i.

    Args:
        xi: shape (..., n, d - 1), or one that broadcasts to it, [m].

    Returns:
        Shape (..., n, d), [m].
    """
    return frames.sigma + (xi[..., None] * frames.normals).sum(-2)


def _compared(curve: Curve) -> Array:
    """θ of the points that are compared, on an open curve also beyond its ends, (k,), [rad]."""
    count = curve.grid if isinstance(curve, SplineCurve) else SAMPLES
    if curve.closed:
        theta = curve.sample(count)
    else:
        theta = np.linspace(-(1 + BEYOND) * np.pi, (1 + BEYOND) * np.pi, count)
    return theta[curve.draws(theta)]


def _tangents(curve: Curve, theta: Array) -> Array:
    """Unit tangents, (n,) -> (n, d)."""
    first = curve.at(theta, 1)
    return first / np.maximum(np.linalg.norm(first, axis=-1, keepdims=True), TINY)


def _normals(tangents: Array) -> Array:
    """Unit normals, (n, d) -> (n, d - 1, d); see `CurveFrames`."""
    if tangents.shape[-1] == 2:
        return np.stack([-tangents[:, 1], tangents[:, 0]], axis=-1)[:, None]
    plan = np.stack([-tangents[:, 1], tangents[:, 0], 0 * tangents[:, 0]], axis=-1)
    left = plan / np.maximum(np.linalg.norm(plan, axis=-1, keepdims=True), TINY)
    up = np.asarray(np.cross(tangents, left), dtype=float)
    return np.stack([left, up], axis=1)


def _radii(gaps: Array, side: Array) -> Array:
    """|d|² / (2 side) where side > 0 and the points are apart, else infinity, (n, k)."""
    squared = (gaps**2).sum(-1)
    counts = (side > TINY) & (squared > TINY)
    return np.where(counts, squared / (2 * np.where(counts, side, 1.0)), np.inf)
