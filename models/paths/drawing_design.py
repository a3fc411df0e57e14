"""Drawings as users edit them: a curve of many pieces with handles on it.

A handle is dragged by s. The control point that acts most at the distance ξ_j from it, [rad], is
moved by w_j s, divided by what makes the curve move by s at the handle. From 1 at the handle, w
falls to 0 at each of its neighbours: with the stretches [a_k, b_k] between them that have no tight
bend, and their lengths l_k,

    w_j = 1 - Σ_k l_k² / (Σ_i l_i²) f((ξ_j - a_k) / (b_k - a_k)),
    f = 35 t⁴ - 84 t⁵ + 70 t⁶ - 20 t⁷ for t in [0, 1], 0 before and 1 after it.

f has three derivatives that are 0 at both ends. So a drawing is bent between the neighbours of a
handle only, all stretches about as sharply, and a corner is carried along as it is.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from typing_extensions import override

from onpath.models.arrays import Array
from onpath.models.errors import CodedError
from onpath.models.paths.curve_blend import aligned
from onpath.models.paths.curve_fit import control_points, distinct
from onpath.models.paths.curves import PERIOD, Curve, SeriesCurve, circle, segment
from onpath.models.paths.path_design import MOST_POINTS, REACH, PathDesign
from onpath.models.paths.spline_curves import (
    DEGREE,
    PER_PIECE,
    WINDOW,
    SplineCurve,
    grained,
    piece_basis,
)
from onpath.models.paths.spline_fit import compared, spline_through, steadied

APART = 0.04  # [m], least usual distance of handles along a drawing
FEWEST, USUAL = 6, 12  # handles of a short drawing and of a long one; more would hide it
NARROWEST = 3  # pieces between a handle and the end of its bump
TIGHT = 3e-3  # [m], radius below which a bend is carried along as it is


@dataclass(frozen=True, slots=True, eq=False)
class DrawingDesign(PathDesign):
    """A drawing with handles, which are `points`.

    Attributes:
        theta: places of the handles, rising, shape (k,), [rad].
        first: the drawing before handles were dragged, which decides what they bend.
    """

    theta: Array
    first: SplineCurve

    @override
    def moved(self, index: int, z: Array) -> PathDesign:
        self.check_index(index)
        if not np.all(np.isfinite(z)):
            raise CodedError("error.point_not_finite")
        curve = self._curve
        shift = np.clip(z, -REACH, REACH) - curve.at(self.theta[index])
        points = grained(curve.points + self.weights(index)[:, None] * shift)
        bent = replace(curve, points=points, given=None, deviation=0.0)
        return replace(self, name="edited", curve=bent, points=bent.at(self.theta))

    @override
    def added(self, index: int) -> PathDesign:
        """The design with a new handle half-way to the next one; see `PathDesign.added`."""
        self.check_index(index)
        count = len(self.theta)
        if count >= MOST_POINTS:
            raise CodedError("error.too_many_points", most=MOST_POINTS)
        last = not self.curve.closed and index == count - 1
        begin = index - 1 if last else index
        end = self.theta[begin + 1] if begin + 1 < count else self.theta[0] + PERIOD
        middle = (self.theta[begin] + end) / 2
        return self._with_handles(np.insert(self.theta, begin + 1, middle))

    @override
    def removed(self, index: int) -> PathDesign:
        """The design without one handle; the drawing stays as it is."""
        self.check_index(index)
        least = 3 if self.curve.closed else 2
        if len(self.theta) <= least:
            raise CodedError("error.too_few_points", least=least)
        return self._with_handles(np.delete(self.theta, index))

    def weights(self, index: int) -> Array:
        """How far each control point moves if a handle is moved by 1, shape (pieces + DEGREE,)."""
        return _weights(self.first, tuple(self.theta.tolist()), index)

    @property
    def _curve(self) -> SplineCurve:
        assert isinstance(self.curve, SplineCurve)
        return self.curve

    def _with_handles(self, theta: Array) -> PathDesign:
        if self.curve.closed:
            theta = np.sort((theta + np.pi) % PERIOD - np.pi)
        return replace(self, points=self.curve.at(theta), theta=theta)


def drawn(stroke: Array) -> PathDesign:
    """A design from a freehand stroke.

    The curve is closed if the ends of the stroke are nearer to each other than a quarter of its
    size, the longer side of the box around it: a word is long, and yet not closed. Else it is drawn
    again and again, with the pen raised on the way back; see `spline_through`.

    Args:
        stroke: shape (n, 2), [m]; clipped to ±REACH.

    Raises:
        ValueError: the stroke is too short or not finite.
    """
    stroke = np.asarray(stroke, dtype=float)
    if stroke.ndim != 2 or not len(stroke) or not np.all(np.isfinite(stroke)):
        raise CodedError("error.stroke_not_finite")
    stroke = np.clip(stroke, -REACH, REACH)
    size = float(np.ptp(stroke, axis=0).max())
    closed = float(np.linalg.norm(stroke[0] - stroke[-1])) < 0.25 * size
    line = distinct(stroke, least=3 if closed else 2)
    curve = spline_through([steadied(line, closed)], closed, repeated=True)
    return from_curve(compared(curve, [np.vstack([line, line[:1]]) if closed else line]))


def from_curve(curve: Curve) -> PathDesign:
    """A design from any plane curve.

    The parameter of a series is aligned with that of a circle (closed) or a segment to the right
    (open): the robots keep their direction of travel, and the old path can be blended into it.
    """
    if isinstance(curve, SplineCurve):
        theta = _handles(curve)
        return DrawingDesign("drawn", curve, curve.at(theta), theta=theta, first=curve)
    assert isinstance(curve, SeriesCurve)
    rightwards = segment((-0.1, 0.0), (0.1, 0.0))
    turned = aligned(curve, circle(0.1) if curve.closed else rightwards)
    points = control_points(turned, 10 if curve.closed else 6)
    kept = replace(turned, given=curve.given, deviation=curve.deviation)
    return PathDesign("drawn", kept, points)


def _handles(curve: SplineCurve) -> Array:
    """Places of handles at equal distances along what is drawn, shape (k,), [rad]."""
    theta = np.linspace(-np.pi, np.pi, 2 * curve.grid + 1)
    middle = (theta[1:] + theta[:-1]) / 2
    steps = np.linalg.norm(np.diff(curve.at(theta), axis=0), axis=1) * curve.draws(middle)
    s = np.concatenate([[0.0], np.cumsum(steps)])
    count = int(np.clip(s[-1] / APART, FEWEST, USUAL))
    even: Array = np.linspace(0.0, float(s[-1]), count, endpoint=not curve.closed)
    return np.interp(even, s, theta)


@lru_cache(maxsize=64)
def _weights(curve: SplineCurve, theta: tuple[float, ...], index: int) -> Array:
    """`DrawingDesign.weights`, the same in all moves of a drag: with 500 pieces, they take 10 ms.

    Args:
        curve: the first drawing.
        theta: places of the handles, rising, [rad].
    """
    here, count = theta[index], len(theta)
    closed, width = curve.closed, PERIOD / curve.pieces
    before = here - theta[index - 1] if index or closed else np.inf
    after = theta[(index + 1) % count] - here if index + 1 < count or closed else np.inf
    before, after = (each % PERIOD if closed else each for each in (before, after))
    if np.inf in (before, after):
        before = after = min(before, after)
    before, after = (min(max(each, NARROWEST * width), np.pi) for each in (before, after))
    number = np.arange(len(curve.points), dtype=np.float64)
    away = width * (number - (DEGREE - 1) / 2) - np.pi - here
    if closed:
        away = away[np.arange(len(away)) % curve.pieces]
        away = (away + np.pi) % PERIOD - np.pi
    moved = np.where(
        away > 0,
        _carried(curve, here, 1, after, away),
        _carried(curve, here, -1, before, -away),
    )
    place = (here + np.pi) / width
    piece = min(int(place), curve.pieces - 1)
    basis = np.array(piece_basis(place - piece, 1 / width)[0])
    return moved / (basis @ moved[piece : piece + WINDOW])


def _carried(curve: SplineCurve, here: float, side: int, far: float, away: Array) -> Array:
    """w of control points on one side of a handle.

    Args:
        curve: the first drawing.
        here: θ of the handle.
        side: 1 after it, -1 before it.
        far: distance from which w is 0, [rad].
        away: distances of the control points, [rad].
    """
    width = PERIOD / curve.pieces
    turns = np.array([-PERIOD, 0.0, PERIOD] if curve.closed else [0.0])
    tight = width * (np.flatnonzero(_tight(curve)) + 0.5) - np.pi - here
    middles, half = np.sort(side * np.add.outer(turns, tight).ravel()), width * DEGREE / 2
    begin = np.clip(np.append(0.0, middles + half), 0.0, far)
    end = np.clip(np.append(middles - half, far), 0.0, far)
    free = end - begin > width / 2
    begin, end = (begin[free], end[free]) if free.any() else (np.zeros(1), np.array([far]))
    arcs = curve.arc(here + side * np.array([begin, end]))
    squares = (arcs[1] - arcs[0]) ** 2
    t = np.clip((away[:, None] - begin) / (end - begin), 0.0, 1.0)
    return 1.0 - t**4 * (35 - 84 * t + 70 * t**2 - 20 * t**3) @ (squares / squares.sum())


def _tight(curve: SplineCurve) -> NDArray[np.bool_]:
    """Whether the bends of each piece are tight, shape (pieces,)."""
    count = PER_PIECE * curve.pieces
    theta = PERIOD * (np.arange(count) + 0.5) / count - np.pi
    bends = np.abs(curve.curvature(theta)).reshape(curve.pieces, PER_PIECE)
    return bends.max(axis=1) > 1 / TIGHT
