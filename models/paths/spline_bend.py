"""Bends a drawing at handles: the curve near one follows the hand, the rest stays as it is.

A handle is a θ. If it is moved by Δ, the control points p_j become p_j + w_j Δ, with

    w_j = (1 - s_j²)^4 / Σ_k b_k (1 - s_k²)^4,    s_j = min(|x_j - x| / r, 1),

where x is the place of the handle in pieces, x_j that of the control point, r the distance to the
next handle, and b_k the functions of models/paths/spline_curves.py at x: the curve moves by Δ
there. The map is linear, and it is the same in the lab and in pages without a server.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from onpath.models.arrays import Array
from onpath.models.paths.curves import PERIOD
from onpath.models.paths.spline_curves import DEGREE, WINDOW, SplineCurve, piece_basis

LEAST_APART = 4  # pieces for each handle: moving one leaves its neighbours where they are
MIDDLE = (DEGREE - 1) / 2  # x_j = j - MIDDLE


def handles(curve: SplineCurve, count: int) -> Array:
    """θ of up to `count` handles at equal arc length where the pen is down, shape (k,), [rad].

    The ends of an open curve are included.
    """
    theta = np.linspace(-np.pi, np.pi, 4 * curve.grid + 1)
    steps = np.linalg.norm(np.diff(curve.at(theta), axis=0), axis=1)
    drawn = curve.draws((theta[1:] + theta[:-1]) / 2)
    s = np.concatenate([[0.0], np.cumsum(steps * drawn)])
    count = max(min(count, curve.pieces // LEAST_APART), 3 if curve.closed else 2)
    even: Array = np.linspace(0.0, float(s[-1]), count, endpoint=not curve.closed)
    last = np.searchsorted(s, even)  # the first θ with this length
    return np.where(s[last] == even, theta[last], np.interp(even, s, theta))


def pull(curve: SplineCurve, places: Array, index: int) -> Array:
    """w, by which the control points follow a handle, shape (pieces + DEGREE,).

    Args:
        places: θ of the handles, shape (k,), [rad].
        index: of the handle.
    """
    n = curve.pieces
    x = (places + np.pi) * n / PERIOD
    others = np.delete(_apart(curve, x - x[index]), index)
    reach = max(float(others.min(initial=n)), 1.0)
    offsets = _apart(curve, np.arange(n + DEGREE) - MIDDLE - x[index])
    share = np.minimum(offsets / reach, 1.0)
    weights = (1 - share**2) ** 4
    if curve.closed:
        weights[n:] = np.resize(weights[:n], DEGREE)
    piece = int(np.clip(np.floor(x[index]), 0, n - 1))
    basis = np.array(piece_basis(x[index] - piece, n / PERIOD)[0])
    return weights / float(basis @ weights[piece : piece + WINDOW])


def pulled(curve: SplineCurve, weights: Array, by: Array) -> SplineCurve:
    """The curve with a handle moved.

    Args:
        weights: those of `pull`.
        by: Δ, shape (d,), [m].
    """
    points = curve.points + weights[:, None] * by
    return replace(curve, points=points, given=None, deviation=0.0)


def _apart(curve: SplineCurve, offsets: Array) -> Array:
    """Distances in pieces, the shorter way round on a closed curve."""
    away = np.abs(offsets)
    return np.minimum(away % curve.pieces, -away % curve.pieces) if curve.closed else away
