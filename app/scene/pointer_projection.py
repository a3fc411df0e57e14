"""From a pointer on the screen to a point on a robot's plane. Pure geometry."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from math import hypot, isfinite
from operator import mul, sub

import numpy as np
from numpy.typing import ArrayLike

from onpath.models.arrays import Array
from onpath.models.systems.robots import Robot

PARALLEL_COSINE = 1e-3
"""Rays that meet the plane at a smaller angle than this [rad] count as parallel to it."""


@dataclass(frozen=True, slots=True)
class DragPlane:
    """A plane in a robot's frame.

    Attributes:
        point: a point on it, shape (3,), [m].
        normal: shape (3,), any length.
    """

    point: np.ndarray
    normal: np.ndarray


def plane_coordinates(robot: Robot, points: Array) -> Array:
    """Coordinates of the path's plane, (..., 2), of points of the robot's frame, (..., 3), [m]."""
    return robot.frame.planar(robot.output_at(points))


@dataclass(frozen=True, slots=True)
class Box:
    """An axis-aligned box in a robot's frame.

    Attributes:
        lower: smallest coordinates, shape (3,), [m].
        upper: largest coordinates, shape (3,), [m].
    """

    lower: np.ndarray
    upper: np.ndarray

    def clamp(self, point: Iterable[float]) -> Array:
        """The nearest point of the box, shape (3,), [m]."""
        bounds = zip(point, self.lower.tolist(), self.upper.tolist(), strict=True)
        return np.array([min(max(x, low), high) for x, low, high in bounds])


def _numbers(vector: ArrayLike) -> list[float]:
    """The numbers of a vector as a list, which for three of them is faster than an array."""
    return np.asarray(vector, dtype=float).tolist()


def _meeting(
    start: list[float], direction: list[float], there: list[float], normal: list[float]
) -> list[float] | None:
    """The point where a ray meets the plane through `there`, or None; see `pointer_on_plane`."""
    lengths, closing = hypot(*direction) * hypot(*normal), _dot(direction, normal)
    if not isfinite(lengths) or abs(closing) <= PARALLEL_COSINE * lengths:
        return None
    along = _dot(map(sub, there, start), normal) / closing
    if not along >= 0.0:
        return None
    point = [x + along * dx for x, dx in zip(start, direction, strict=True)]
    return point if all(map(isfinite, point)) else None


def _dot(a: Iterable[float], b: Iterable[float]) -> float:
    return sum(map(mul, a, b))


def pointer_on_plane(
    camera: ArrayLike,
    pointer: ArrayLike,
    base: np.ndarray,
    plane: DragPlane,
    box: Box,
) -> np.ndarray | None:
    """Project the pointer onto a robot's plane.

    A drag reports the pointer on a plane that faces the camera, not on the robot's own; both lie
    on one ray from the camera.

    Args:
        camera: position of the camera in the world, shape (3,), [m].
        pointer: any point of the world under the pointer, shape (3,), [m].
        base: origin of the robot's frame in the world, shape (3,), [m].
        plane: the robot's plane.
        box: the result is clamped to it.

    Returns:
        The point in the robot's frame, shape (3,), [m]; None when the ray runs parallel to the
        plane, when the plane lies behind the camera, or when anything is not finite.
    """
    origin, there, foot = map(_numbers, (camera, pointer, base))
    start, direction = list(map(sub, origin, foot)), list(map(sub, there, origin))
    hit = _meeting(start, direction, _numbers(plane.point), _numbers(plane.normal))
    return None if hit is None else box.clamp(hit)
