"""Converts a student's sketch to the form that is stored."""

from __future__ import annotations

import numpy as np

from onpath.lessons.given import Answer
from onpath.lessons.measures.thinning import peaks
from onpath.lessons.schema import Sketch
from onpath.models.arrays import Array
from onpath.models.errors import CodedError

MOST_POINTS = 160


def sketched(prediction: Sketch, answer: Answer) -> Answer:
    """Sort a sketch by time, clip it to the prediction's axes and reduce its points.

    Raises:
        ValueError: it is not a curve.
    """
    if answer.skipped:
        return answer
    try:
        times, values = np.array(answer.times, dtype=float), np.array(answer.values, dtype=float)
    except (OverflowError, TypeError) as error:
        raise CodedError("error.sketch_without_points") from error
    if times.shape != values.shape or not np.isfinite(times).all() or not np.isfinite(values).all():
        raise CodedError("error.sketch_without_points")
    order = np.argsort(times, kind="stable")
    times = np.round(np.clip(times[order], 0.0, prediction.seconds), 3)
    times, first = np.unique(times, return_index=True)
    values: Array = np.round(np.clip(values[order][first], prediction.bottom, prediction.top), 3)
    if len(times) < 2:
        raise CodedError("error.sketch_direction")
    kept = peaks([values], MOST_POINTS)
    return Answer(times=tuple(times[kept].tolist()), values=tuple(values[kept].tolist()))
