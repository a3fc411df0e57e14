"""Tries to pass every task without doing what it asks, or without understanding it.

See `onpath.lessons.cheating` and `onpath.lessons.students`.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from onpath.app.lab.advance_together import Frame, advance_together
from onpath.app.lab.commands.scripts import player_of
from onpath.app.lab.dry_runs.course_check import judged, lab_at, line_of_heading
from onpath.app.lab.lab import Command, Lab
from onpath.app.lab.lesson_record import Beginning, record_of
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.lessons.action_schema import Script
from onpath.lessons.cheating import Cheat, cheats
from onpath.lessons.checks import verdict
from onpath.lessons.course import REFERENCE, Course, read_references
from onpath.lessons.measures.earlier_run import EarlierRun
from onpath.lessons.problems import Problem
from onpath.lessons.record import Record
from onpath.lessons.schema import Lesson, Step
from onpath.lessons.students import MOST_PASS, STUDENTS, random_students, thoughtless
from onpath.lessons.task_schema import Event, Only, Reference, Setting, Task, Window
from onpath.lessons.words import DEFAULT, ENGLISH

FRAME = 1 / 30  # [s] of simulated time per frame
CHECK = 12  # frames between evaluations of a task's checks
TOGETHER = 48
"""Attempts that are simulated together: their closed loops are rows of arrays."""


@dataclass(frozen=True, slots=True)
class Asked:
    """A task, and the file with its reference solutions."""

    lesson: Lesson
    index: int
    task: Task
    reference: Reference
    file: Path

    @property
    def step(self) -> Step:
        """The step of the task."""
        return self.lesson.steps[self.index]

    def problem(self, text: str) -> Problem:
        """A fault of the task, at its solution."""
        heading = f"{self.task.id}.solution"
        line = line_of_heading(heading, self.file)
        return Problem(str(self.file), line, f"task {self.task.id!r} {text}")


@dataclass(frozen=True, slots=True)
class Passes:
    """Who passes a task without having understood it.

    Attributes:
        random: how many of the students who draw at random.
        students: how many there are.
        thoughtless: what was done by the others who pass, in words.
    """

    asked: Asked
    random: int
    students: int
    thoughtless: Sequence[str]

    def __str__(self) -> str:
        where = f"{self.asked.lesson.name} {self.asked.task.id}"
        trying = ", meant to be found by trying" * self.asked.task.exploratory
        return f"{where}: {self.random} of {self.students} random students pass{trying}"

    def problems(self) -> Iterator[Problem]:
        """What is wrong with the task; nothing if it is meant to be found by trying."""
        if self.asked.task.exploratory:
            return
        rest = "Give it a price, such as a bound on the torque, or mark it as `exploratory`"
        if self.random > MOST_PASS * self.students / STUDENTS:
            who = f"{self.random} of {self.students} students who draw at random"
            yield self.asked.problem(f"is passed by {who}. {rest}")
        if self.thoughtless:
            what = "; ".join(self.thoughtless[:3])
            yield self.asked.problem(f"is passed with {what}, in place of its settings. {rest}")


def asked_tasks(course: Course, folder: Path) -> Iterator[Asked]:
    """All tasks of a course.

    Args:
        folder: contains the lessons' own folders.
    """
    for name in course.lessons:
        lesson, file = course.lesson(name, DEFAULT), folder / name / REFERENCE
        references = read_references(lesson, file)[0]
        for index, step in enumerate(lesson.steps):
            for task in step.tasks():
                yield Asked(lesson, index, task, references[task.id], file)


def attempts(course: Course, folder: Path) -> list[tuple[Asked, Cheat]]:
    """All cheats of all tasks; see `asked_tasks`."""
    return [
        (asked, cheat)
        for asked in asked_tasks(course, folder)
        for cheat in cheats(asked.lesson, asked.index, asked.task, asked.reference)
    ]


def cheat_faults(tried: Iterable[tuple[Asked, Cheat]], loop_cache: LoopCache) -> Iterator[Problem]:
    """Find tasks that can be passed without doing what they ask.

    Args:
        tried: the cheats to try; see `attempts`.
        loop_cache: compiles and keeps the loops.
    """
    ordered = sorted(tried, key=lambda each: each[1].words)  # the same loops are adjacent
    trials = ((asked, cheat.script) for asked, cheat in ordered)
    found = dict[tuple[Path, str, str], tuple[Asked, Cheat]]()  # the first with each control
    for (asked, cheat), passed in zip(ordered, passes(trials, loop_cache), strict=True):
        if passed:
            found.setdefault((asked.file, asked.task.id, cheat.control), (asked, cheat))
    for (_, _, control), (asked, cheat) in sorted(found.items(), key=lambda each: each[0]):
        yield asked.problem(
            f"is passed with {cheat.words}. Add a check to the task, or,"
            f" if that is what it asks for, {control!r} to its list `fair`"
        )


def passes_of(asked: Asked, loop_cache: LoopCache, count: int = STUDENTS) -> Passes:
    """Who passes a task without having understood it.

    Args:
        count: of the students who draw at random, the first of whom play.
    """
    about = asked.lesson, asked.index, asked.task, asked.reference.solution
    tried, drawn = dict(thoughtless(*about)), list(random_students(*about, count))
    scripts = [*tried.values(), *drawn]
    passed = list(passes(((asked, script) for script in scripts), loop_cache))
    words = [what for what, did in zip(tried, passed, strict=False) if did]
    return Passes(asked, sum(passed[len(tried) :]), count, words)


def passes(trials: Iterable[tuple[Asked, Script]], loop_cache: LoopCache) -> Iterator[bool]:
    """Whether each script passes its task; many are played together."""
    waiting = list(trials)
    for begin in range(0, len(waiting), TOGETHER):
        batch = [_Trial(*each, loop_cache) for each in waiting[begin : begin + TOGETHER]]
        playing = batch
        while playing:
            for _ in range(CHECK):
                advance_together(trial.frame() for trial in playing)
            for trial in playing:
                trial.check()
            playing = [trial for trial in playing if not trial.over]
        yield from (trial.passed for trial in batch)


class _Trial:
    """A script that is being played. A command that the lab refuses has no effect.

    Attributes:
        passed: whether the task is passed.
        over: whether the attempt has ended.
    """

    def __init__(self, asked: Asked, script: Script, loop_cache: LoopCache) -> None:
        self._task, self.passed, self.over = asked.task, False, False
        self._lab: Lab = lab_at(asked.lesson, asked.step, loop_cache)
        self._earlier, self._begin = EarlierRun(), Beginning.now(self._lab.simulation)
        self._last = max((action.at for action in script.do), default=0.0)
        changes = [action.at for action in script.do if action.what not in ("hold", "pull")]
        self._settled = max(changes, default=0.0)
        windows = [check for check in asked.task.check if isinstance(check, Window)]
        self._least = max((check.least for check in windows), default=0.0)
        self._player, self._lab.simulation.running = player_of(script), True

    def frame(self) -> Frame:
        """A frame of the lab, after the commands that are due."""
        self._lab.drain()
        self.over = self._player.play(self._lab.simulation, self._ask)
        return self._lab.frame(FRAME)

    def check(self) -> None:
        """Judge the task; the attempt ends when it is passed, or cannot be any more."""
        simulation, task = self._lab.simulation, self._task
        if simulation.time < self._least and simulation.run_number == self._begin.run:
            return  # nothing has lasted long enough
        record = record_of(simulation, self._begin)
        verdicts = judged(task, record, self._earlier, ENGLISH)
        self.passed = all(verdict.passed for verdict in verdicts)
        self.over = self.over or self.passed or self._is_lost(record)

    def _ask(self, command: Command) -> None:
        with suppress(ValueError):  # it is refused
            command.apply(self._lab)

    def _is_lost(self, record: Record) -> bool:
        """Whether a check fails that only another action could satisfy."""
        if record.run != self._begin.run:
            return False
        final = Setting | Only if record.end > self._settled else ()
        final = Setting | Only | Event if record.end > self._last else final
        checks = [check for check in self._task.check if isinstance(check, final)]
        return not all(verdict(check, record, ENGLISH).passed for check in checks)
