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
    height = HEIGHT * (sketch.top - sketch.bottom)
    return next((each for each in sketch.shapes if _fits(each, drawn, height)), None)


def peaks_of(values: Sequence[float], height: float) -> int:
    """Number of peaks that rise from a valley and fall to one by at least `height`."""
    count, climbs, turn = 0, False, values[0] if values else 0.0
    for value in values:  # turn: the highest since the climb, or else the lowest since the peak
        turn = max(turn, value) if climbs else min(turn, value)
        if abs(value - turn) >= height:
            count, climbs, turn = count + climbs, not climbs, value
    return count


def _fits(shape: SketchShape, drawn: Answer, height: float) -> bool:
    values = drawn.values
    if shape.peaks and not shape.peaks[0] <= peaks_of(values, height) <= shape.peaks[1]:
        return False
    if shape.highest and not shape.highest[0] <= max(values) <= shape.highest[1]:
        return False
    return all(
        low <= float(np.interp(time, drawn.times, values)) <= high for time, low, high in shape.at
    )
