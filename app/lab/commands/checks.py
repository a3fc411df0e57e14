"""Checks of the numbers and names that commands carry."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from onpath.models.arrays import Array
from onpath.models.control.laws import NAMES


def finite(value: float) -> float:
    """A finite number.

    Raises:
        ValueError: it is none.
    """
    try:
        result = float(value)
    except (TypeError, ValueError, OverflowError):
        result = math.nan
    if not math.isfinite(result):
        raise ValueError("that is not a number")
    return result


def within(what: str, value: float, bounds: Sequence[float]) -> float:
    """A number between the first and the last of `bounds`.

    Raises:
        ValueError: it is not there, or no number.
    """
    number = finite(value)
    if not bounds[0] <= number <= bounds[-1]:
        raise ValueError(f"{what} {number:g}: between {bounds[0]:g} and {bounds[-1]:g}")
    return number


def point(value: Array, size: int) -> Array:
    """A finite point, shape (size,).

    Raises:
        ValueError: it is none.
    """
    checked = np.asarray(value, dtype=float)
    if checked.shape != (size,) or not np.isfinite(checked).all():
        raise ValueError("that is not a point")
    return checked


def controller(name: str) -> str:
    """The name of a controller.

    Raises:
        ValueError: there is no such one.
    """
    if name not in NAMES:
        raise ValueError(f"no robot {name!r}: there are {', '.join(NAMES)}")
    return name
