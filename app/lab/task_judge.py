"""Judges the tasks of an open step repeatedly while a student works on them."""

from __future__ import annotations

from collections.abc import Iterator

from onpath.app.lab.lesson_record import Beginning, record_of
from onpath.app.lab.simulation import Simulation
from onpath.lessons.checks import Verdict, judge, statistic, way_of
from onpath.lessons.measures.earlier_run import EarlierRun
from onpath.lessons.record import Record
from onpath.lessons.task_schema import Task, Window
from onpath.lessons.words import Words


class TaskJudge:
    """Verdicts on the tasks of one step since it began.

    Attributes:
        begin: beginning of the step; nothing before it counts.
        verdicts: on the checks of each task; those of a task that was passed stay until a reset.
    """

    def __init__(self, begin: Beginning) -> None:
        self.verdicts: dict[str, list[Verdict]] = {}
        self.begin = begin
        self._passed: dict[str, int] = {}  # the run in which each task was passed
        self._earlier = EarlierRun()

    def follow(
        self, simulation: Simulation, tasks: list[Task], words: Words
    ) -> Iterator[tuple[Task, float, int]]:
        """Judge the tasks; yield those that are passed, the value to be improved, and the way."""
        record = record_of(simulation, self.begin, self._earlier.values)
        self._earlier.follow(record, tasks)
        for task in tasks:
            verdicts = judge(task, record, words)
            passed = all(verdict.passed for verdict in verdicts)
            if passed or self._passed.get(task.id) != record.run:
                self.verdicts[task.id] = verdicts
            if passed:
                self._passed[task.id] = record.run
                yield task, _best(task, record), way_of(task, record)


def _best(task: Task, record: Record) -> float:
    """The value of a run that a task asks to be small; 0 if it asks for none."""
    if not task.best:
        return 0.0
    chosen = record.chosen("follower", Window())
    return statistic(record, "follower", task.best, "max", chosen) or 0.0
