"""`onpath lessons play`: what a step of a lesson does, as numbers."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, cast

import msgspec
import tyro

if TYPE_CHECKING:
    from onpath.app.exports.step_play import PlayedScript
    from onpath.lessons.action_schema import StepSetup
    from onpath.lessons.course import Course
    from onpath.lessons.schema import Lesson, Step
    from onpath.lessons.step_numbers import ScriptPart

PLOTTED = {"torques": ("torque",), "phase": ("across", "across_rate")}
"""Quantities of the plots that have other names than they."""
ALWAYS = ("distance", "torque")  # quantities that are printed for every step


@dataclass(frozen=True)
class PlayLesson:
    """Play a step of a lesson and print numbers: its script, or its tasks' reference scripts."""

    lesson: Annotated[str, tyro.conf.Positional]
    """Name or number of the lesson, as 1b or 01b-let-the-clock-wait."""
    step: Annotated[int, tyro.conf.Positional]
    """Number of the step, from 1."""
    lessons: Path | None = None
    """Folder of lessons; by default the built-in ones."""
    json: bool = False
    """Print everything as JSON."""
    all: bool = False
    """Print all quantities, not only those that the step predicts, plots or checks."""

    def run(self) -> None:
        """Play and print.

        Raises:
            ValueError: there is no such lesson or step, or a script cannot be played.
        """
        from onpath.lessons.course import BUILT_IN, read_course

        folder = self.lessons or BUILT_IN
        course, problems = read_course([folder])
        if problems:
            raise ValueError(str(problems[0]))
        lesson = chosen_lesson(course, self.lesson)
        if not 1 <= self.step <= len(lesson.steps):
            raise ValueError(f"step {self.step}: {lesson.name} has steps 1 to {len(lesson.steps)}")
        index = self.step - 1
        runs = list(_runs(lesson, lesson.steps[index], folder))
        if self.json:
            print(json.dumps(_as_json(lesson, index, runs), indent=2))
        else:
            print("\n".join(_lines(lesson, index, runs, self.all)))


def chosen_lesson(course: Course, asked: str) -> Lesson:
    """The English version of a lesson, by its name or its number.

    Raises:
        ValueError: there is none; the message has the nearest name.
    """
    from onpath.models.systems.parameter_specs import unknown_name

    by_number = {number: name for name, number in course.numbers().items()}
    name = by_number.get(asked.lstrip("0"), asked)
    if name not in course.lessons:
        raise unknown_name(asked, list(course.lessons), "lesson")
    return course.lesson(name, "en")


def _runs(lesson: Lesson, step: Step, folder: Path) -> Iterator[PlayedScript]:
    from onpath.app.exports.step_play import play_script
    from onpath.app.lab.loops.loop_cache import LoopCache
    from onpath.lessons.course import REFERENCE, read_references

    loop_cache = LoopCache(at_once=True)
    try:
        if step.script is not None:
            yield play_script(lesson, step, "script", step.script, loop_cache)
        references = read_references(lesson, folder / lesson.name / REFERENCE)[0]
        for task in step.tasks():
            for what in ("solution", "failure"):
                script = getattr(references[task.id], what)
                yield play_script(lesson, step, f"{task.id}.{what}", script, loop_cache, task)
    finally:
        loop_cache.close()


def _setup(lesson: Lesson, index: int) -> dict[str, Any]:
    """The lab at the beginning of the step."""
    from onpath.models.control.sides import DEFAULT_LAWS

    setup = lesson.setup_at(index)
    robot, path = setup.robot or lesson.front.robot, setup.path or "circle"
    laws = {**DEFAULT_LAWS, **setup.laws.named}
    return {
        "robot": robot,
        "path": path,
        "laws": laws,
        "set": dict(setup.set),
        "plot": list(setup.plots),
        **_drawn(setup),
    }


def _drawn(setup: StepSetup) -> dict[str, Any]:
    """The start and the drawings, where they differ from a new lab's."""
    fields = {"start": setup.start, "show": setup.show, "marks": setup.marks}
    plain = {name: msgspec.to_builtins(value) for name, value in fields.items()}
    plain["start"] = {name: value for name, value in plain["start"].items() if value}
    return {name: value for name, value in plain.items() if value}


def _as_json(lesson: Lesson, index: int, runs: list[PlayedScript]) -> dict[str, Any]:
    step = lesson.steps[index]
    return {
        "lesson": lesson.name,
        "step": index + 1,
        "kind": step.kind,
        "title": step.title,
        "setup": _setup(lesson, index),
        "runs": [
            {
                "title": run.title,
                "until": run.script.until,
                "parts": [_part_as_json(part) for part in run.parts],
                "passed": run.passed if run.verdicts else None,
                "checks": [dataclasses.asdict(verdict) for verdict in run.verdicts],
            }
            for run in runs
        ],
    }


def _part_as_json(part: ScriptPart) -> dict[str, Any]:
    from onpath.lessons.step_numbers import action_text

    plain: dict[str, Any] = msgspec.to_builtins(dataclasses.replace(part, actions=()))
    return plain | {"actions": [action_text(action) for action in part.actions]}


def _lines(
    lesson: Lesson, index: int, runs: list[PlayedScript], all_quantities: bool
) -> Iterator[str]:
    from onpath.lessons.record import QUANTITIES

    step, setup = lesson.steps[index], _setup(lesson, index)
    yield f"{lesson.name}, step {index + 1}, {step.kind}: {step.title}"
    laws = ", ".join(f"{side} {law}" for side, law in setup["laws"].items())
    yield f"  robot {setup['robot']}, path {setup['path']}, laws: {laws}"
    values = ", ".join(f"{name} = {value}" for name, value in setup["set"].items())
    yield f"  set: {values or 'nothing'}; all others as in a new lab"
    for name in ("plot", "start", "show", "marks"):
        if setup.get(name):
            yield f"  {name}: {_in_a_line(setup[name])}"
    if not runs:
        yield "  no script and no task"
    mentioned = _mentioned(lesson, index)
    shown = [name for name in QUANTITIES if all_quantities or name in mentioned]
    for run in runs:
        yield f"\n{run.title}, {run.script.until:g} s"
        for part in run.parts:
            yield from _part_lines(part, shown)
        if run.verdicts:
            yield f"  task {'passed' if run.passed else 'not passed'}; at the end:"
        for verdict in run.verdicts:
            yield f"    {'✓' if verdict.passed else '○'} {verdict.words}"


def _in_a_line(value: Any) -> str:
    """Plots, a start, drawings or marks as text."""
    if isinstance(value, dict):
        return ", ".join(f"{name} = {each}" for name, each in cast(dict[str, Any], value).items())
    return ", ".join(each if isinstance(each, str) else f"[{_in_a_line(each)}]" for each in value)


def _part_lines(part: ScriptPart, quantities: list[str]) -> Iterator[str]:
    from onpath.lessons.record import QUANTITIES
    from onpath.lessons.step_numbers import action_text

    done = "; ".join(map(action_text, part.actions))
    yield f"  {part.begin:g} to {part.end:g} s{': ' + done if done else ''}"
    heads = ("max", "at [s]", "min", "mean", "rms", "final")
    yield " ".join([f"    {'':32s}", *(f"{head:>9s}" for head in heads)])
    for quantity in quantities:
        for robot, numbers in part.numbers.items():
            if quantity in numbers:
                row = dataclasses.astuple(numbers[quantity])
                name = f"{quantity} [{QUANTITIES[quantity]}] {robot}"
                yield " ".join([f"    {name:32s}", *(f"{value:9.4g}" for value in row)])
    for robot, settled in part.settled.items():
        when = "not at the end" if settled is None else f"from {settled:.2f} s after its beginning"
        yield f"    {robot} within 1 mm of the path: {when}"


def _mentioned(lesson: Lesson, index: int) -> set[str]:
    """Quantities that a step predicts, plots or checks."""
    step = lesson.steps[index]
    asked = [block for each in lesson.steps[max(0, index - 1) : index + 1] for block in each.blocks]
    named = {getattr(block, "quantity", "") for block in asked}
    checked = {getattr(check, "quantity", "") for task in step.tasks() for check in task.check}
    plots = {
        quantity for plot in lesson.setup_at(index).plots for quantity in PLOTTED.get(plot, (plot,))
    }
    return {*ALWAYS, *named, *checked, *plots}
