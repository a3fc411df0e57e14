"""Plays lessons without a browser, to check that scripts run and tasks accept their solutions."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from onpath.app.lab.commands.scripts import player_of
from onpath.app.lab.lab import Lab
from onpath.app.lab.lesson_record import Beginning, record_of
from onpath.app.lab.lesson_run import setup_of
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.lessons.action_schema import Script
from onpath.lessons.checks import Verdict, judge
from onpath.lessons.course import REFERENCE, Course, read_references
from onpath.lessons.problems import Problem
from onpath.lessons.schema import Lesson, Step
from onpath.lessons.task_schema import Task
from onpath.lessons.words import DEFAULT, Words

FRAME = 1 / 60  # [s]
LOOKS = 0.1  # [s] between evaluations of a task's checks


def play_course(course: Course, folder: Path, store: LoopCache) -> Iterator[Problem]:
    """Find problems in the scripts, solutions and failures of a folder's lessons.

    Args:
        course: the lessons read from the folder.
        folder: contains the lessons' own folders.
        store: provides the closed loops.
    """
    for name in course.lessons:
        lesson = course.lesson(name, DEFAULT)
        home = folder / name
        for step in lesson.steps:
            yield from _script_faults(lesson, step, home / f"{lesson.language}.md", store)
        yield from _reference_faults(lesson, home / REFERENCE, store)


def lab_at(lesson: Lesson, step: Step, store: LoopCache) -> Lab:
    """A lab set up for a step of a lesson."""
    lab = Lab(store)
    lab.set_up(setup_of(lesson, lesson.steps.index(step)))
    return lab


def play(lab: Lab, script: Script, task: Task | None = None) -> Iterator[list[Verdict]]:
    """Play a script to its end and yield the verdicts on a task, if any, ten times a second.

    Raises:
        ValueError: the lab refuses a command of the script; the message says why.
    """
    session, words = lab.session, Words()
    begin = Beginning.now(session)
    lab.script, session.running = player_of(script), True
    for _ in range(round(3 * script.until / LOOKS)):
        for _ in range(round(LOOKS / FRAME)):
            lab.drain()
            lab.advance(session.rate * FRAME)
        if lab.message_level == "warning":
            raise ValueError(lab.message)
        yield [] if task is None else judge(task, record_of(session, begin), words)
        if lab.script is None:
            return
    raise ValueError(f"the script does not reach its end at {script.until:g} s")


def solved(lab: Lab, script: Script, task: Task) -> tuple[bool, list[Verdict]]:
    """Whether a script passes a task at any time, and the last verdicts.

    Raises:
        ValueError: see `play`.
    """
    last: list[Verdict] = []
    passed = False
    for last in play(lab, script, task):
        passed |= all(verdict.passed for verdict in last)
    return passed, last


def _script_faults(lesson: Lesson, step: Step, file: Path, store: LoopCache) -> Iterator[Problem]:
    if step.script is None:
        return
    try:
        for _ in play(lab_at(lesson, step, store), step.script):
            pass
    except ValueError as error:
        yield Problem(str(file), step.line, f"the script of step {step.title!r}: {error}")


def _reference_faults(lesson: Lesson, file: Path, store: LoopCache) -> Iterator[Problem]:
    references = read_references(lesson, file)[0]
    for step in lesson.steps:
        for task in step.tasks():
            if task.id not in references:
                continue  # reported by read_references
            scripts = references[task.id]
            for what, script in (("solution", scripts.solution), ("failure", scripts.failure)):
                fault = _fault(lesson, step, script, task, store, what == "solution")
                if fault:
                    heading = f"{task.id}.{what}"
                    yield Problem(str(file), _line_of(heading, file), f"{heading} {fault}")


def _fault(
    lesson: Lesson, step: Step, script: Script, task: Task, store: LoopCache, right: bool
) -> str:
    """Why a script is not a valid solution, or not a valid failure."""
    try:
        passed, last = solved(lab_at(lesson, step, store), script, task)
    except ValueError as error:
        return f"cannot be played: {error}"
    if passed == right:
        return ""
    if passed:
        return "passes the task, which it should not"
    missing = "; ".join(verdict.words for verdict in last if not verdict.passed)
    return f"does not pass the task. At its end: {missing}"


def _line_of(heading: str, file: Path) -> int:
    lines = file.read_text("utf-8-sig").split("\n")
    return next((i for i, line in enumerate(lines, 1) if line.strip() == f"[{heading}]"), 1)
