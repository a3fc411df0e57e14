"""Checks of the numbers and names in commands."""

from __future__ import annotations

import math

import numpy as np

from onpath.models.arrays import Array
from onpath.models.control.sides import SIDES
from onpath.models.errors import CodedError
from onpath.models.systems.parameter_specs import unknown_name


def finite(value: float) -> float:
    """Check that a number is finite.

    Raises:
        ValueError: it is not.
    """
    try:
        result = float(value)
    except (TypeError, ValueError, OverflowError):
        result = math.nan
    if not math.isfinite(result):
        raise CodedError("error.not_a_number")
    return result


def point(value: Array, size: int) -> Array:
    """Check that a point is finite and has shape (size,).

    Raises:
        ValueError: it is not, or has another shape.
    """
    checked = np.asarray(value, dtype=float)
    if checked.shape != (size,) or not np.isfinite(checked).all():
        raise CodedError("error.not_a_point")
    return checked


def side(name: str) -> str:
    """Check the name of a side.

    Raises:
        ValueError: there is no such side.
    """
    if name not in SIDES:
        raise unknown_name(name, list(SIDES), "side")
    return name
