"""The drawing's geometry as numbers, which is symbolic in CasADi, and what viser draws of it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import casadi as ca
import numpy as np

from onpath.models.arrays import Array


def evaluated(function: Callable[..., Any], *values: Any) -> list[Array]:
    """Evaluate a symbolic function for numbers; columns remain columns."""
    given = [ca.DM(value) for value in values]
    symbols = [ca.SX.sym("x", *value.shape) for value in given]
    results = function(*symbols)
    results = results if isinstance(results, tuple) else (results,)
    outcome = ca.Function("f", symbols, [ca.densify(result) for result in results]).call(given)
    return [result.full() for result in outcome]


def drawn(skeleton: Callable[..., Any], q: Array, *values: float) -> tuple[Array, Array]:
    """Evaluate a robot's skeleton: bars, shape (n, 2, 3), and joints, shape (m, 3), [m]."""
    bars, joints = evaluated(skeleton, q, *values)
    return bars.T.reshape(-1, 2, 3), joints.T


def drawn_length(arrow: Any) -> float:
    """From end to end of what viser's client draws of a node with one arrow, [m]; 0 if hidden.

    Its shaft ends where the head begins, and the head is never shortened (Arrows.tsx).
    """
    if not arrow.visible:
        return 0.0
    (begin, end), head = arrow.points[0], arrow.head_length
    return max(float(np.linalg.norm(end - begin)), head)
