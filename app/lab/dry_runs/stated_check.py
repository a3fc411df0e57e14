"""Compares the numbers that a lesson's texts state with those measured in its runs."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from onpath.lessons.checks import statistic
from onpath.lessons.measures.responses import unit_of
from onpath.lessons.measures.stated import Measure, Stated, in_span
from onpath.lessons.record import Record
from onpath.lessons.schema import Lesson
from onpath.lessons.task_schema import Window


def stated_faults(lesson: Lesson, runs: Mapping[int, Record]) -> Iterator[tuple[int, str]]:
    """Lines and faults of the stated numbers of a lesson.

    Args:
        runs: what was measured in the scripts, by the index of the step.
    """
    for index, step in enumerate(lesson.steps):
        for stated in step.stated:
            at = run_of(lesson, index)
            if at is None:
                yield (
                    stated.line,
                    f"{stated.text} is stated, but no step has a script",
                )
                continue
            if fault := _fault(stated, runs[at]):
                yield stated.line, f"{fault} (step {at + 1}, {lesson.steps[at].title!r})"


def run_of(lesson: Lesson, index: int) -> int | None:
    """The run that a step describes: its own, else the last one before it, else the next one.

    A question for a prediction describes the run that follows it.
    """
    steps = range(len(lesson.steps))
    before, later = range(index, -1, -1), steps[index + 1 :]
    ordered = [*later, *before] if lesson.steps[index].predictions() else [*before, *later]
    return next((at for at in ordered if lesson.steps[at].script is not None), None)


def measured(measure: Measure, run: Record) -> float | None:
    """The number that a run gives; None if it gives none."""
    chosen = run.chosen(measure.robot, Window(during=measure.during)) & in_span(run.times, measure)
    return statistic(run, measure.robot, measure.quantity, measure.stat, chosen)


def _fault(stated: Stated, run: Record) -> str:
    """Why a stated number differs from the run's; empty if it does not."""
    what = stated.measure
    found = measured(what, run)
    if found is None:
        return f"{stated.text} is stated of {what.words}, which was not measured: {why(what, run)}"
    if stated.agrees(found):
        return ""
    unit = unit_of(what.stat, what.quantity)
    return f"{stated.text} is stated, but {what.words} is {found:.4g} {unit}"


def why(measure: Measure, run: Record) -> str:
    """Why there is no such number."""
    values = run.values[measure.robot].get(measure.quantity)
    if values is None or not np.isfinite(values).any():
        return f"the robot of this run has no {measure.quantity}"
    during = run.chosen(measure.robot, Window(during=measure.during))
    if not during.any():
        return f"the {measure.robot} is never {measure.during}"
    if not (during & in_span(run.times, measure)).any():
        span = f"from {measure.begin:g} to {measure.end:g} s"
        part = "" if measure.during == "always" else f" at which it is {measure.during}"
        return f"no instant {span}{part}; the run ends at {run.end:.4g} s"
    return f"there is no {measure.stat} in this run"
