"""Settling time and overshoot of a quantity on its way back to zero."""

from __future__ import annotations

import numpy as np

from onpath.lessons.record import QUANTITIES, Mask
from onpath.lessons.task_schema import Stat
from onpath.models.arrays import Array

BAND = 0.05
"""A quantity has settled when it stays within this share of its largest value."""
UNITS: dict[Stat, str] = {"settling": "s", "overshoot": "%"}
"""Statistics whose unit is not that of the quantity."""
WITH_SIGN = ("across", "across_rate", "deflection")
"""Quantities that can overshoot zero, because they have a sign."""


def unit_of(stat: Stat, quantity: str) -> str:
    """The unit of a statistic of a quantity."""
    return UNITS.get(stat, QUANTITIES[quantity])


def latest_stretch(chosen: Mask) -> Mask:
    """The last uninterrupted part of the chosen instants, shape (n,)."""
    if not chosen.any():
        return chosen
    last = int(np.flatnonzero(chosen)[-1])
    gaps = np.flatnonzero(~chosen[:last])
    first = int(gaps[-1]) + 1 if len(gaps) else 0
    stretch = np.zeros_like(chosen)
    stretch[first : last + 1] = True
    return stretch


def settling_time(times: Array, values: Array) -> float | None:
    """Time from the first instant until a quantity stays within 5 % of its largest value, [s].

    None if it is not settled at the end.

    Args:
        times, values: shape (n,), n > 0.
    """
    outside = np.flatnonzero(np.abs(values) > BAND * np.abs(values).max())
    if not len(outside):
        return 0.0
    after = int(outside[-1]) + 1
    return None if after == len(values) else float(times[after] - times[0])


def overshoot(values: Array) -> float:
    """How far a quantity goes beyond zero after its largest value, in percent of that value.

    Args:
        values: with sign, shape (n,), n > 0.
    """
    peak = int(np.abs(values).argmax())
    if values[peak] == 0:
        return 0.0
    return float(100 * np.max(-values[peak:] / values[peak], initial=0.0))
