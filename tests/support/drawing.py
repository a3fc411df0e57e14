"""Numerical evaluation of the drawing's geometry, which is symbolic in CasADi."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import casadi as ca

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
