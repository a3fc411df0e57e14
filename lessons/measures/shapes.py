"""Which of the shapes that an author names a drawn curve has."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from onpath.lessons.given import Answer
from onpath.lessons.schema import Sketch, SketchShape

HEIGHT = 0.1
"""Least height of a peak over the valleys on both sides, as a share of the axis."""


def shape_of(sketch: Sketch, drawn: Answer) -> SketchShape | None:
    """The first shape of a sketch that a curve has; None if none fits."""
    return next(
        (each for each in sketch.shapes if has(sketch, each, drawn.times, drawn.values)), None
    )


def has(
    sketch: Sketch, shape: SketchShape, times: Sequence[float], values: Sequence[float]
) -> bool:
    """Whether a curve has all that a shape names; as `has` in assets/web/lessons/features.ts."""
    height = HEIGHT * (sketch.top - sketch.bottom)
    if shape.peaks and not shape.peaks[0] <= peaks_of(values, height) <= shape.peaks[1]:
        return False
    ends = (shape.highest, max(values)), (shape.lowest, min(values))
    if not all(bounds is None or bounds[0] <= value <= bounds[1] for bounds, value in ends):
        return False

    def within(times_then: Sequence[float], low: float, high: float) -> bool:
        return all(low <= float(value) <= high for value in np.interp(times_then, times, values))

    return all(within([time], low, high) for time, low, high in shape.at) and all(
        within([start, *(t for t in times if start < t < end), end], low, high)
        for start, end, low, high in shape.level
    )


def peaks_of(values: Sequence[float], height: float) -> int:
    """Number of peaks that rise from a valley and fall to one by at least `height`."""
    count, climbs, turn = 0, False, values[0] if values else 0.0
    for value in values:  # turn: the highest since the climb, or else the lowest since the peak
        turn = max(turn, value) if climbs else min(turn, value)
        if abs(value - turn) >= height:
            count, climbs, turn = count + climbs, not climbs, value
    return count
