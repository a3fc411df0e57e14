"""Compares the numbers that a lesson's texts state with those measured in its runs."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from onpath.lessons.checks import statistic
from onpath.lessons.measures.responses import unit_of
from onpath.lessons.measures.stated import Stated, in_span
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
            at = _run_of(lesson, index)
            if at is None:
                yield (
                    stated.line,
                    f"{stated.text} is stated, but no step has a script",
                )
                continue
            if fault := _fault(stated, runs[at]):
                yield stated.line, f"{fault} (step {at + 1}, {lesson.steps[at].title!r})"


def _run_of(lesson: Lesson, index: int) -> int | None:
    """The run that a step describes: its own, else the last one before it, else the next one."""
    steps = range(len(lesson.steps))
    ordered = [*range(index, -1, -1), *steps[index + 1 :]]
    return next((at for at in ordered if lesson.steps[at].script is not None), None)


def _fault(stated: Stated, run: Record) -> str:
    """Why a stated number differs from the run's; empty if it does not."""
    chosen = run.chosen(stated.robot, Window(during=stated.during)) & in_span(run.times, stated)
    measured = statistic(run, stated.robot, stated.quantity, stated.stat, chosen)
    what = f"{stated.stat} {stated.quantity} {stated.robot}"
    if measured is None:
        return f"{stated.text} is stated of {what}, which was not measured: {_why(stated, run)}"
    if stated.agrees(measured):
        return ""
    unit = unit_of(stated.stat, stated.quantity)
    return f"{stated.text} is stated, but {what} is {measured:.4g} {unit}"


def _why(stated: Stated, run: Record) -> str:
    """Why there is no such number."""
    values = run.values[stated.robot].get(stated.quantity)
    if values is None or not np.isfinite(values).any():
        return f"the robot of this run has no {stated.quantity}"
    during = run.chosen(stated.robot, Window(during=stated.during))
    if not during.any():
        return f"the {stated.robot} is never {stated.during}"
    if not (during & in_span(run.times, stated)).any():
        span = f"from {stated.begin:g} to {stated.end:g} s"
        part = "" if stated.during == "always" else f" at which it is {stated.during}"
        return f"no instant {span}{part}; the run ends at {run.end:.4g} s"
    return f"there is no {stated.stat} in this run"
