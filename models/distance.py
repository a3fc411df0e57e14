"""Distance of end-points to the path in the output space, apart from any controller."""

from __future__ import annotations

import numpy as np

from models.curves import Curve
from models.frames import Frame
from models.system import Array

CHUNK = 4096
NEAR = 0.1  # [rad]; within it the Taylor polynomial stands for the curve


def path_distance(frame: Frame, curve: Curve, y: Array, samples: int = 256) -> Array:
    """Euclidean distance by global search, shape (n, p) -> (n,), [m]."""
    grid = curve.sample(samples)
    points = frame.lift(curve.at(grid))
    distances = np.empty(len(y))
    for begin in range(0, len(y), CHUNK):
        some = y[begin : begin + CHUNK]
        squared = ((some[:, None, :] - points[None]) ** 2).sum(-1)
        theta = grid[squared.argmin(axis=1)]
        for _ in range(2):
            theta = _refined(frame, curve, some, theta)[0]
        distances[begin : begin + CHUNK] = _refined(frame, curve, some, theta)[1]
    return distances


def near_distance(frame: Frame, curve: Curve, y: Array, theta: Array) -> Array:
    """The same from guesses near the closest points, shape (n,), [rad]; for live display.

    Where a guess proves to be far off, the search is global.
    """
    better, distances = _refined(frame, curve, y, theta)
    guessed = np.sqrt(((frame.lift(curve.at(theta)) - y) ** 2).sum(-1))
    astray = ~((np.abs(better - theta) < NEAR) & (distances <= guessed + 1e-12))
    if astray.any():
        distances[astray] = path_distance(frame, curve, y[astray], 64)
    return distances


def _refined(frame: Frame, curve: Curve, y: Array, theta: Array) -> tuple[Array, Array]:
    """Better theta and the distance there, by Newton on the curve's cubic Taylor polynomial."""
    origin = frame.lift(np.zeros(2))
    sigma, *derivatives = curve.all_orders(theta)
    point = frame.lift(sigma)
    first, second, third = (frame.lift(derivative) - origin for derivative in derivatives)
    step = np.zeros((len(theta), 1))
    for _ in range(2):
        gap = point + step * (first + step / 2 * (second + step / 3 * third)) - y
        tangent = first + step * (second + step / 2 * third)
        squared = (tangent**2).sum(-1)
        slope = np.maximum(squared + (gap * (second + step * third)).sum(-1), 0.2 * squared)
        step = step - ((gap * tangent).sum(-1) / slope)[:, None]
    gap = point + step * (first + step / 2 * (second + step / 3 * third)) - y
    return theta + step[:, 0], np.sqrt((gap**2).sum(-1))
