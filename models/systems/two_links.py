"""Two links in a plane, from a pivot to the elbow and from there to the end-point."""

from __future__ import annotations

import casadi as ca


def elbow_up(x: ca.SX, z: ca.SX, first: float, second: float) -> ca.SX:
    """Angle q1 of the first link from the horizontal, and q2 of the second from the first, (2, 1).

        cos q2 = (r² - l1² - l2²) / (2 l1 l2),   r² = x² + z²

    This is the pose with the elbow up: -π < q2 < 0. NaN out of reach.

    Args:
        x, z: the end-point relative to the pivot, [m].
        first, second: l1 and l2, [m].
    """
    q2 = -ca.acos((x**2 + z**2 - first**2 - second**2) / (2 * first * second))
    away = ca.atan2(second * ca.sin(q2), first + second * ca.cos(q2))
    return ca.vertcat(ca.atan2(z, x) - away, q2)
