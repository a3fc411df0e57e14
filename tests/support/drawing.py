"""Numerical evaluation of the drawing's geometry, which is symbolic in CasADi."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import casadi as ca

from onpath.models.arrays import Array


def evaluated(function: Callable[..., Any], *values: Any) -> list[Array]:
    """What a function of symbols gives for numbers; columns come and go as they are."""
    given = [ca.DM(value) for value in values]
    symbols = [ca.SX.sym("x", *value.shape) for value in given]
    results = function(*symbols)
    results = results if isinstance(results, tuple) else (results,)
    outcome = ca.Function("f", symbols, [ca.densify(result) for result in results]).call(given)
    return [result.full() for result in outcome]


def drawn(skeleton: Callable[..., Any], q: Array, *values: float) -> tuple[Array, Array]:
    """Bars, shape (n, 2, 3), and joints, shape (m, 3), of a robot's skeleton, [m]."""
    bars, joints = evaluated(skeleton, q, *values)
    return bars.T.reshape(-1, 2, 3), joints.T
