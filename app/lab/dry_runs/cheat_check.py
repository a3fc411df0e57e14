"""Tries to pass every task without doing what it asks; see `onpath.lessons.cheating`."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

from onpath.app.lab.advance_together import advance_together
from onpath.app.lab.commands.scripts import player_of
from onpath.app.lab.dry_runs.course_check import judged, lab_at, line_of_heading
from onpath.app.lab.lab import Lab
from onpath.app.lab.lesson_record import Beginning, record_of
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.lessons.cheating import Cheat, cheats
from onpath.lessons.checks import verdict
from onpath.lessons.course import REFERENCE, Course, read_references
from onpath.lessons.measures.earlier_run import EarlierRun
from onpath.lessons.problems import Problem
from onpath.lessons.record import Record
from onpath.lessons.schema import Lesson, Step
from onpath.lessons.task_schema import Event, Only, Setting, Task
from onpath.lessons.words import DEFAULT, ENGLISH

FRAME = 1 / 30  # [s]
LOOK = 12  # frames between evaluations of a task's checks
TOGETHER = 48
"""Attempts that are simulated together: their closed loops are rows of arrays."""


@dataclass(frozen=True, slots=True)
class Attempt:
    """A cheat at a task, and the file that says what is fair."""

    lesson: Lesson
    step: Step
    task: Task
    cheat: Cheat
    file: Path


def cheat_faults(course: Course, folder: Path, store: LoopCache) -> Iterator[Problem]:
    """Find tasks that can be passed without doing what they ask.

    Args:
        course, folder, store: see `course_check.play_course`.
    """
    ordered = sorted(_attempts(course, folder), key=lambda each: each.cheat.words)
    passed = dict[tuple[Path, str, str], Attempt]()  # the first with each control
    for begin in range(0, len(ordered), TOGETHER):  # attempts with the same loops are adjacent
        for each in _passed(ordered[begin : begin + TOGETHER], store):
            passed.setdefault((each.file, each.task.id, each.cheat.control), each)
    for (file, task, control), each in sorted(passed.items(), key=lambda item: item[0]):
        yield Problem(
            str(file),
            line_of_heading(f"{task}.solution", file),
            f"task {task!r} is passed with {each.cheat.words}. Add a check to the task, or,"
            f" if that is what it asks for, {control!r} to its list `fair`",
        )


def _attempts(course: Course, folder: Path) -> Iterator[Attempt]:
    for name in course.lessons:
        lesson, file = course.lesson(name, DEFAULT), folder / name / REFERENCE
        references = read_references(lesson, file)[0]
        for index, step in enumerate(lesson.steps):
            for task in step.tasks():
                for cheat in cheats(lesson, index, task, references[task.id]):
                    yield Attempt(lesson=lesson, step=step, task=task, cheat=cheat, file=file)


def _passed(attempts: Iterable[Attempt], store: LoopCache) -> Iterator[Attempt]:
    """The attempts that pass; all are played together."""
    trials = [_Trial(attempt, store) for attempt in attempts]
    while trials:
        for _ in range(LOOK):
            for trial in trials:
                trial.lab.drain()
            advance_together(trial.lab.frame(FRAME) for trial in trials)
        for trial in trials:
            trial.look()
        yield from (trial.attempt for trial in trials if trial.passed)
        trials = [trial for trial in trials if not trial.over]


class _Trial:
    """An attempt that is being played.

    Attributes:
        passed: whether the task is passed.
        over: whether the attempt has ended.
    """

    def __init__(self, attempt: Attempt, store: LoopCache) -> None:
        self.attempt, self.passed, self.over = attempt, False, False
        self.lab: Lab = lab_at(attempt.lesson, attempt.step, store)
        self._earlier, self._begin = EarlierRun(), Beginning.now(self.lab.session)
        script = attempt.cheat.script
        self._last = max((action.at for action in script.do), default=0.0)
        changes = [action.at for action in script.do if action.what not in ("hold", "pull")]
        self._settled = max(changes, default=0.0)
        self.lab.script, self.lab.session.running = player_of(script), True

    def look(self) -> None:
        """Judge the task; a control that the lab refuses, or a robot that stops, ends it."""
        lab, task = self.lab, self.attempt.task
        refused = lab.message_level == "warning"
        record = record_of(lab.session, self._begin)
        verdicts = judged(task, record, self._earlier, ENGLISH)
        self.passed = not refused and all(verdict.passed for verdict in verdicts)
        self.over = self.passed or refused or lab.script is None or self._is_lost(record)

    def _is_lost(self, record: Record) -> bool:
        """Whether a check fails that only another action could satisfy."""
        if record.run != self._begin.run:
            return False
        final = Setting | Only if record.end > self._settled else ()
        final = Setting | Only | Event if record.end > self._last else final
        checks = [check for check in self.attempt.task.check if isinstance(check, final)]
        return not all(verdict(check, record, ENGLISH).passed for check in checks)
