"""Compares the axes on which a student draws with the curve that the run then shows."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from onpath.lessons.record import QUANTITIES, Record
from onpath.lessons.schema import Lesson, Sketch

ROOM = 1e-3
"""Share of its length by which a curve may leave the axis: less than a pixel."""


def sketch_faults(lesson: Lesson, runs: Mapping[int, Record]) -> Iterator[tuple[int, str]]:
    """Lines of steps and faults of sketches whose true curve leaves their axis.

    A robot that diverges is left out: until the lab stops it, it may leave any axis.

    Args:
        runs: what was measured in the scripts, by the index of the step.
    """
    for index, step in enumerate(lesson.steps):
        for sketch in step.predictions():
            run = runs.get(index, runs.get(index + 1))
            if isinstance(sketch, Sketch) and run is not None and not run.stopped(sketch.robot):
                for fault in _faults(sketch, run):
                    yield step.line, f"step {step.title!r}: {fault}"


def _faults(sketch: Sketch, run: Record) -> Iterator[str]:
    curve = run.values[sketch.robot].get(sketch.quantity, np.zeros(0))
    curve = curve[np.isfinite(curve)]
    if not len(curve):
        yield f"the run after it has no {sketch.quantity} of the {sketch.robot}"
        return
    room = ROOM * (sketch.top - sketch.bottom)
    what, unit = f"{sketch.quantity} of the {sketch.robot}", QUANTITIES[sketch.quantity]
    low, high = float(curve.min()), float(curve.max())
    if high > sketch.top + room:
        yield f"top = {sketch.top:g}: the {what} goes up to {high:.4g} {unit} in the run after it"
    if low < sketch.bottom - room:
        yield (
            f"bottom = {sketch.bottom:g}: the {what} goes down to {low:.4g} {unit}"
            " in the run after it"
        )
