"""Plays lessons without a browser, to check that scripts run and tasks accept their solutions."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

from onpath.app.lab.commands.scripts import player_of
from onpath.app.lab.dry_runs.behaviour_check import behaviour_faults, page_faults
from onpath.app.lab.dry_runs.run_samples import Samples
from onpath.app.lab.dry_runs.sentence_check import sentence_faults
from onpath.app.lab.dry_runs.sketch_check import sketch_faults
from onpath.app.lab.dry_runs.stated_check import stated_faults
from onpath.app.lab.lab import Lab
from onpath.app.lab.lesson_record import Beginning, record_of
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.lab.setups.step_setup import setup_of
from onpath.lessons.action_schema import Script
from onpath.lessons.checks import Verdict, judge
from onpath.lessons.course import REFERENCE, Course, read_plays, read_references
from onpath.lessons.measures.earlier_run import EarlierRun
from onpath.lessons.problems import Problem
from onpath.lessons.record import Record
from onpath.lessons.schema import Lesson, Step
from onpath.lessons.task_schema import Task
from onpath.lessons.text_files import read_text
from onpath.lessons.words import DEFAULT, Words

FRAME = 1 / 60  # [s] of simulated time per frame
CHECKS = 0.1  # [s] between evaluations of a task's checks


def play_course(course: Course, folder: Path, loop_cache: LoopCache) -> Iterator[Problem]:
    """Find problems in the scripts, solutions and failures of a folder's lessons.

    Args:
        course: the lessons read from the folder.
        folder: contains the lessons' own folders.
        loop_cache: provides the closed loops.
    """
    for name, versions in course.played.items():
        lesson = course.lesson(name, DEFAULT)
        home = folder / name
        file = home / f"{lesson.language}.md"
        runs, faults = _measured_runs(lesson, loop_cache)
        if not faults:
            faults = [*stated_faults(lesson, runs), *sketch_faults(lesson, runs)]
        faults += behaviour_faults(lesson, read_plays(home / REFERENCE), loop_cache)
        yield from (Problem(str(file), line, text) for line, text in faults)
        for other in versions.values():
            file = home / f"{other.language}.md"
            shown = page_faults(other, read_text(file))
            yield from (Problem(str(file), line, text) for line, text in shown)
        yield from _reference_faults(lesson, home / REFERENCE, loop_cache)
    yield from sentence_faults(course, folder, loop_cache)


def lab_at(lesson: Lesson, step: Step, loop_cache: LoopCache) -> Lab:
    """A lab set up for a step of a lesson."""
    lab = Lab(loop_cache)
    lab.set_up(setup_of(lesson, lesson.steps.index(step)))
    return lab


def play(lab: Lab, script: Script, task: Task | None = None) -> Iterator[list[Verdict]]:
    """Play a script to its end and yield the verdicts on a task, if any, ten times a second.

    Raises:
        ValueError: the lab refuses a command of the script, or a path; the message says why. A
            note on what it does all the same is no refusal.
    """
    simulation, words, earlier = lab.simulation, Words(), EarlierRun()
    begin = Beginning.now(simulation)
    lab.script, simulation.running = (player := player_of(script)), True
    for _ in range(round(3 * script.seconds / CHECKS)):
        for _ in range(round(CHECKS / FRAME)):
            lab.drain()
            lab.advance(simulation.settings.rate * FRAME)
        if simulation.editor.faults or (lab.script is None and not player.finished):
            raise ValueError(lab.message)
        yield [] if task is None else judged(task, record_of(simulation, begin), earlier, words)
        if lab.script is None:
            return
    raise ValueError(f"the script does not reach its end at {script.until:g} s")


def judged(task: Task, record: Record, earlier: EarlierRun, words: Words) -> list[Verdict]:
    """The verdicts on a task while a script is played."""
    earlier.follow(record, [task])
    return judge(task, replace(record, before=earlier.values), words)


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


def measured_run(lesson: Lesson, index: int, loop_cache: LoopCache) -> Record:
    """Everything measured while a step's script is played.

    Raises:
        ValueError: see `play`.
    """
    step = lesson.steps[index]
    assert step.script is not None
    lab = lab_at(lesson, step, loop_cache)
    samples = Samples(lab.simulation)
    for _ in play(lab, step.script):
        samples.follow(lab.simulation)
    return samples.record(lab.simulation)


def _measured_runs(
    lesson: Lesson, loop_cache: LoopCache
) -> tuple[dict[int, Record], list[tuple[int, str]]]:
    """Records of all scripts of a lesson, by the step's index, and faults with their lines."""
    runs, faults = dict[int, Record](), list[tuple[int, str]]()
    for index, step in enumerate(lesson.steps):
        try:
            if step.script is not None:
                runs[index] = measured_run(lesson, index, loop_cache)
        except ValueError as error:
            faults.append((step.line, f"the script of step {step.title!r}: {error}"))
    return runs, faults


def _reference_faults(lesson: Lesson, file: Path, loop_cache: LoopCache) -> Iterator[Problem]:
    references = read_references(lesson, file)[0]
    for step in lesson.steps:
        for task in step.tasks():
            if task.id not in references:
                continue  # reported by read_references
            scripts = references[task.id]
            variants = [("variant", script) for script in scripts.variant]
            others = ("solution", scripts.solution), ("failure", scripts.failure)
            for number, (what, script) in enumerate((*variants, *others), 1):
                if fault := _fault(lesson, step, script, task, loop_cache, what != "failure"):
                    heading, count = f"{task.id}.{what}", f" {number}" * (what == "variant")
                    line = line_of_heading(heading, file)
                    yield Problem(str(file), line, f"{heading}{count} {fault}")


def _fault(
    lesson: Lesson, step: Step, script: Script, task: Task, loop_cache: LoopCache, right: bool
) -> str:
    """Why a script is not a valid solution, or not a valid failure."""
    try:
        passed, last = solved(lab_at(lesson, step, loop_cache), script, task)
    except ValueError as error:
        return f"cannot be played: {error}"
    if passed == right:
        return ""
    if passed:
        return "passes the task, which it should not"
    missing = "; ".join(verdict.words for verdict in last if not verdict.passed)
    return f"does not pass the task. At its end: {missing}"


def line_of_heading(heading: str, file: Path) -> int:
    """The line of `[heading]` or the first `[[heading]]` in a TOML file; 1 if there is none."""
    lines, headings = read_text(file).split("\n"), (f"[{heading}]", f"[[{heading}]]")
    return next((i for i, line in enumerate(lines, 1) if line.strip() in headings), 1)
