"""A path as a user makes it: control points, presets, strokes. Immutable; edits give a new one."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from types import MappingProxyType

import numpy as np

from onpath.models.arrays import Array
from onpath.models.errors import CodedError
from onpath.models.paths.curve_fit import closed_through, control_points, from_stroke, open_through
from onpath.models.paths.curves import Curve, aligned, circle, ellipse, fourier, segment

MOST_POINTS = 24
REACH = 0.2  # [m], control points stay within this of the middle


@dataclass(frozen=True, slots=True, eq=False)
class PathDesign:
    """A curve with the control points that shape it.

    Attributes:
        name: of the preset it began as, "drawn" for a stroke, "edited" after a change.
        curve: what is followed.
        points: control points, shape (k, 2), [m]; near the curve, not always on it.
    """

    name: str
    curve: Curve
    points: Array

    def moved(self, index: int, z: Array) -> PathDesign:
        """With a control point elsewhere.

        Raises:
            ValueError: no such point, not finite, or points that make no curve.
        """
        self._check(index)
        if not np.all(np.isfinite(z)):
            raise CodedError("error.point_not_finite")
        points = self.points.copy()
        points[index] = z
        return self._through(points)

    def added(self, index: int) -> PathDesign:
        """With a control point more, half-way to the next one.

        Raises:
            ValueError: no such point, or already as many as there may be.
        """
        self._check(index)
        count = len(self.points)
        if count >= MOST_POINTS:
            raise CodedError("error.too_many_points", most=MOST_POINTS)
        last = not self.curve.closed and index == count - 1
        other = index - 1 if last else (index + 1) % count
        theta = self.curve.nearest((self.points[[index]] + self.points[[other]]) / 2)[0]
        where = index if last else index + 1
        return self._through(np.insert(self.points, where, self.curve.at(theta)[0], axis=0))

    def removed(self, index: int) -> PathDesign:
        """With a control point less.

        Raises:
            ValueError: no such point, or too few would be left.
        """
        self._check(index)
        least = 3 if self.curve.closed else 2
        if len(self.points) <= least:
            raise CodedError("error.too_few_points", least=least)
        return self._through(np.delete(self.points, index, axis=0))

    def _through(self, points: Array) -> PathDesign:
        fit = closed_through if self.curve.closed else open_through
        within = np.clip(points, -REACH, REACH)  # between its points a curve may swing beyond
        return PathDesign("edited", fit(within), within)

    def _check(self, index: int) -> None:
        if index not in range(len(self.points)):
            raise CodedError("error.no_point", index=index, count=len(self.points))


def drawn(stroke: Array, before: Curve | None = None) -> PathDesign:
    """From a freehand stroke, closed if its ends are near each other.

    It begins and turns as the presets do, an open one as the open path `before` it, whichever way
    the hand went: so the robots keep their direction, and one path blends into another smoothly.

    Raises:
        ValueError: the stroke is too short or not finite.
    """
    stroke = np.asarray(stroke, dtype=float)
    if stroke.ndim != 2 or not len(stroke) or not np.all(np.isfinite(stroke)):
        raise CodedError("error.stroke_not_finite")
    stroke = np.clip(stroke, -REACH, REACH)
    length = float(np.linalg.norm(np.diff(stroke, axis=0), axis=1).sum())
    closed = float(np.linalg.norm(stroke[0] - stroke[-1])) < 0.25 * length
    rightwards = before if before and not before.closed else segment((-0.1, 0.0), (0.1, 0.0))
    curve = aligned(from_stroke(stroke, closed), circle(0.1) if closed else rightwards)
    return PathDesign("drawn", curve, control_points(curve, 10 if closed else 6))


def _designed(name: str, curve: Curve, count: int) -> PathDesign:
    return PathDesign(name, curve, control_points(curve, count))


def _rounded_square(half: float = 0.05, power: float = 5.0) -> Curve:
    angle = np.linspace(-np.pi, np.pi, 96, endpoint=False)
    c, s = np.cos(angle), np.sin(angle)
    radius = half / (np.abs(c) ** power + np.abs(s) ** power) ** (1 / power)
    return closed_through(radius[:, None] * np.column_stack([c, s]))


def _clover() -> Curve:
    """r = 0.055 (1 + 0.2 cos 4 theta), exact: products of cosines are sums of harmonics."""
    a, lobe = 0.055, 0.055 * 0.2 / 2
    cosine, sine = np.zeros((5, 2)), np.zeros((5, 2))
    cosine[[0, 2, 4], 0] = a, lobe, lobe
    sine[[0, 2, 4], 1] = a, -lobe, lobe
    return fourier(np.zeros(2), cosine, sine)


def _figure_eight() -> Curve:
    cosine = np.array([[0.06, 0.0]])
    return fourier(np.zeros(2), cosine, np.array([[0.0, 0.0], [0.0, 0.04]]))


@cache
def presets(radius: float = 0.05) -> Mapping[str, PathDesign]:
    """Paths to choose from, by name; the figure of eight is there to be refused."""
    designs = (
        _designed("circle", circle(radius), 8),
        _designed("ellipse", ellipse((1.4 * radius, 0.7 * radius)), 8),
        _designed("rounded square", _rounded_square(radius), 12),
        _designed("clover", _clover(), 16),
        _designed("segment", segment((-0.06, -0.02), (0.06, 0.03)), 2),
        _designed("figure of eight", _figure_eight(), 12),
    )
    return MappingProxyType({design.name: design for design in designs})
