"""Plays the runs of a lesson, and compares the numbers that its texts state of them."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from onpath.lessons.checks import statistic
from onpath.lessons.measures.responses import unit_of
from onpath.lessons.measures.stated import Stated, in_span
from onpath.lessons.record import Record
from onpath.lessons.schema import Lesson
from onpath.lessons.task_schema import Window


def stated_faults(lesson: Lesson, played: Callable[[int], Record]) -> Iterator[tuple[int, str]]:
    """Lines and faults of the stated numbers of a lesson.

    Args:
        played: plays the script of the step of an index, and returns what was measured.
    """
    runs = dict[int, Record]()
    for index, step in enumerate(lesson.steps):
        for stated in step.stated:
            at = _run_of(lesson, index)
            if at is None:
                yield (
                    stated.line,
                    f"{stated.text} is stated, but no step has a script",
                )
                continue
            if at not in runs:
                runs[at] = played(at)
            if fault := _fault(stated, runs[at]):
                yield stated.line, f"{fault} (step {at + 1}, {lesson.steps[at].title!r})"


def _run_of(lesson: Lesson, index: int) -> int | None:
    """The run that a step tells of: its own, else the last one before it, else the next one."""
    steps = range(len(lesson.steps))
    ordered = [*range(index, -1, -1), *steps[index + 1 :]]
    return next((at for at in ordered if lesson.steps[at].script is not None), None)


def _fault(stated: Stated, run: Record) -> str:
    """Why a number is not that of a run; empty if it is."""
    chosen = run.chosen(stated.robot, Window(during=stated.during)) & in_span(run.times, stated)
    measured = statistic(run, stated.robot, stated.quantity, stated.stat, chosen)
    what = f"{stated.stat} {stated.quantity} {stated.robot}"
    if measured is None:
        return f"{stated.text} is stated of {what}, which was not measured"
    if stated.agrees(measured):
        return ""
    unit = unit_of(stated.stat, stated.quantity)
    return f"{stated.text} is stated, but {what} is {measured:.4g} {unit}"
