"""Paths as users edit them: a curve with control points. Drawings are in drawing_design.py.

A `PathDesign` is immutable; every edit returns a new one.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import cache, partial

import numpy as np

from onpath.models.arrays import Array
from onpath.models.errors import CodedError
from onpath.models.paths.curve_fit import along, closed_through, control_points, open_through
from onpath.models.paths.curves import Curve, circle, ellipse, fourier, segment

MOST_POINTS = 24
USUAL_RADIUS = 0.05  # [m], of the predefined circle
REACH = 0.2  # [m], largest coordinate of a control point, in absolute value


@dataclass(frozen=True, slots=True, eq=False)
class PathDesign:
    """A curve with the control points that shape it.

    Attributes:
        name: name of the preset, "drawn" for a stroke, or "edited" after a change.
        curve: the path, in coordinates of its plane.
        points: control points, shape (k, 2), [m]. The curve passes near them, not exactly through
            them.
    """

    name: str
    curve: Curve
    points: Array

    def moved(self, index: int, z: Array) -> PathDesign:
        """The design with one control point moved.

        Args:
            index: of the control point.
            z: its new position, shape (2,), [m]; clipped to ±REACH.

        Raises:
            ValueError: there is no such point, z is not finite, or no curve can be fitted.
        """
        self.check_index(index)
        if not np.all(np.isfinite(z)):
            raise CodedError("error.point_not_finite")
        points = self.points.copy()
        points[index] = z
        return self._through(points)

    def added(self, index: int) -> PathDesign:
        """The design with a new control point on the curve, half-way to the next one.

        After the last point of an open curve, the new one is put before it.

        Args:
            index: of the control point after which the new one is inserted.

        Raises:
            ValueError: there is no such point, or there are `MOST_POINTS` already.
        """
        self.check_index(index)
        count = len(self.points)
        if count >= MOST_POINTS:
            raise CodedError("error.too_many_points", most=MOST_POINTS)
        last = not self.curve.closed and index == count - 1
        other = index - 1 if last else (index + 1) % count
        theta = self.curve.nearest((self.points[[index]] + self.points[[other]]) / 2)[0]
        where = index if last else index + 1
        return self._through(np.insert(self.points, where, self.curve.at(theta)[0], axis=0))

    def removed(self, index: int) -> PathDesign:
        """The design without one control point.

        Args:
            index: of the control point.

        Raises:
            ValueError: there is no such point, or fewer than 3 (closed) or 2 (open) would remain.
        """
        self.check_index(index)
        least = 3 if self.curve.closed else 2
        if len(self.points) <= least:
            raise CodedError("error.too_few_points", least=least)
        return self._through(np.delete(self.points, index, axis=0))

    def _through(self, points: Array) -> PathDesign:
        """The design with the curve fitted to new control points."""
        fit = closed_through if self.curve.closed else open_through
        within = np.clip(points, -REACH, REACH)  # the curve between them may still lie outside
        return PathDesign("edited", fit(within), within)

    def check_index(self, index: int) -> None:
        """Raise ValueError unless `index` is that of a control point."""
        if index not in range(len(self.points)):
            raise CodedError("error.no_point", index=index, count=len(self.points))


def _rounded_square(half: float = 0.05, power: float = 5.0) -> Curve:
    """The superellipse |z1|^power + |z2|^power = half^power, half in [m]."""
    angle = np.linspace(-np.pi, np.pi, 4096, endpoint=False)
    c, s = np.cos(angle), np.sin(angle)
    radius = half / (np.abs(c) ** power + np.abs(s) ** power) ** (1 / power)
    return along(radius[:, None] * np.column_stack([c, s]), closed=True)


def _clover(mean: float) -> Curve:
    """r(φ) = r (1 + 0.2 cos 4φ) in polar coordinates, r in [m], represented exactly.

    cos φ cos 4φ = (cos 3φ + cos 5φ) / 2 and sin φ cos 4φ = (sin 5φ - sin 3φ) / 2 make both
    coordinates sums of harmonics.
    """
    a, lobe = mean, mean * 0.2 / 2
    cosine, sine = np.zeros((5, 2)), np.zeros((5, 2))
    cosine[[0, 2, 4], 0] = a, lobe, lobe
    sine[[0, 2, 4], 1] = a, -lobe, lobe
    return fourier(np.zeros(2), cosine, sine)


def _figure_eight(width: float, height: float) -> Curve:
    """σ(θ) = (w cos θ, h sin 2θ), w and h in [m]."""
    cosine = np.array([[width, 0.0]])
    return fourier(np.zeros(2), cosine, np.array([[0.0, 0.0], [0.0, height]]))


class Presets(Mapping[str, PathDesign]):
    """Designs by name, each computed when it is first looked up. Thread-safe."""

    def __init__(self, making: Mapping[str, Callable[[], PathDesign]]) -> None:
        self._making, self._made = making, dict[str, PathDesign]()

    def __getitem__(self, name: str) -> PathDesign:
        if name not in self._made:
            self._made.setdefault(name, self._making[name]())
        return self._made[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._making)

    def __len__(self) -> int:
        return len(self._making)


@cache
def presets(radius: float = USUAL_RADIUS) -> Presets:
    """The predefined paths by name.

    The figure of eight crosses itself: its users are warned, see models/paths/path_checks.py.

    Args:
        radius: of the circle, [m]; the others scale with it.
    """
    k = radius / USUAL_RADIUS
    designs = (
        ("circle", partial(circle, radius), 8),
        ("ellipse", partial(ellipse, (1.4 * radius, 0.7 * radius)), 8),
        ("rounded square", partial(_rounded_square, radius), 12),
        ("clover", partial(_clover, 0.055 * k), 16),
        ("segment", partial(segment, (-0.06 * k, -0.02 * k), (0.06 * k, 0.03 * k)), 2),
        ("figure of eight", partial(_figure_eight, 0.06 * k, 0.04 * k), 16),
    )
    return Presets({name: partial(_designed, name, make, count) for name, make, count in designs})


def _designed(name: str, make: Callable[[], Curve], count: int) -> PathDesign:
    """A design with `count` control points on a curve."""
    curve = make()
    return PathDesign(name, curve, control_points(curve, count))
