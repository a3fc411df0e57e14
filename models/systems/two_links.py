"""Two links in a plane, from a pivot to the elbow and from there to the end-point."""

from __future__ import annotations

import casadi as ca
import numpy as np

from onpath.models.arrays import Array


def elbow_cosine(squared: Array, first: float, second: float) -> Array:
    """cos q2 = (r² - l1² - l2²) / (2 l1 l2) of the elbow's angle; beyond ±1 out of reach.

    Args:
        squared: r², the squared distance of the end-point from the pivot, [m²].
        first, second: l1 and l2, [m].
    """
    return (squared - first**2 - second**2) / (2 * first * second)


def elbow_sine(squared: Array, first: float, second: float) -> Array:
    """|sin q2| at the squared distance r² [m²]; 0 out of reach. See `elbow_cosine`."""
    return np.sqrt(np.maximum(1 - elbow_cosine(squared, first, second) ** 2, 0.0))


def elbow_up(x: Array, z: Array, first: float, second: float, pivot: str) -> tuple[Array, Array]:
    """Angle q1 of the first link from the horizontal, and q2 of the second from the first, [rad].

    Of the two poses, that with the elbow up: -π < q2 < 0.

    Args:
        x, z: the end-point, seen from the pivot, [m].
        first, second: l1 and l2, [m].
        pivot: name of the pivot, for the error.

    Raises:
        ValueError: the end-point is out of reach.
    """
    with np.errstate(over="ignore", invalid="ignore"):  # far beyond any reach
        cosine = elbow_cosine(x**2 + z**2, first, second)
    if not np.all(np.abs(cosine) <= 1):
        raise ValueError(
            f"end-point out of reach: it must stay between {abs(first - second):.3f} m and"
            f" {first + second:.3f} m of the {pivot}"
        )
    q2 = -np.arccos(cosine)
    q1 = np.arctan2(z, x) - np.arctan2(second * np.sin(q2), first + second * np.cos(q2))
    return q1, q2


def elbow_sine_of(squared: ca.SX, first: float, second: float) -> ca.SX:
    """`elbow_sine` in symbols."""
    cosine = (squared - first**2 - second**2) / (2 * first * second)
    return ca.sqrt(ca.fmax(1 - cosine**2, 0))


def elbow_up_of(x: ca.SX, z: ca.SX, first: float, second: float) -> ca.SX:
    """`elbow_up` in symbols, for end-points within reach, (2, 1)."""
    q2 = -ca.acos((x**2 + z**2 - first**2 - second**2) / (2 * first * second))
    away = ca.atan2(second * ca.sin(q2), first + second * ca.cos(q2))
    return ca.vertcat(ca.atan2(z, x) - away, q2)
