"""Distance of end-points to the path in the output space, apart from any controller."""

from __future__ import annotations

import numpy as np

from models.curves import Curve, nearest
from models.frames import Frame
from models.system import Array


def path_distance(frame: Frame, curve: Curve, y: Array) -> Array:
    """Euclidean distance by global search, shape (n, p) -> (n,), [m]."""
    parts = [
        nearest(lambda theta: frame.lift(curve.at(theta)), curve.sample(), part)[1]
        for part in np.array_split(y, len(y) // 4096 + 1)
    ]
    return np.concatenate(parts)


def near_distance(frame: Frame, curve: Curve, y: Array, theta: Array, steps: int = 2) -> Array:
    """Euclidean distance by Newton from a guess near the closest point; for live display.

    The curve is evaluated once, at the guess, and is its cubic Taylor polynomial from there on.

    Args:
        y: end-points, shape (n, p), [m].
        theta: guesses, shape (n,), [rad].
    """
    origin = frame.lift(np.zeros(2))
    sigma, first, second, third = curve.all_orders(theta)
    point, first, second, third = (
        frame.lift(sigma),
        frame.lift(first) - origin,
        frame.lift(second) - origin,
        frame.lift(third) - origin,
    )
    step = np.zeros(len(theta))
    for _ in range(steps):
        x = step[:, None]
        gap = point + x * (first + x / 2 * (second + x / 3 * third)) - y
        slope1 = first + x * (second + x / 2 * third)
        squared = (slope1**2).sum(-1)
        slope = np.maximum(squared + (gap * (second + x * third)).sum(-1), 0.2 * squared)
        step = step - (gap * slope1).sum(-1) / slope
    x = step[:, None]
    gap = point + x * (first + x / 2 * (second + x / 3 * third)) - y
    return np.sqrt((gap**2).sum(-1))
