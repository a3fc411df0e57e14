"""The names that a lesson may use, and the checks that it uses only those."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import get_args

from onpath.lessons.action_schema import Action, Laws, Script, StepSetup, Value
from onpath.lessons.measures.responses import WITH_SIGN
from onpath.lessons.record import PLOTS, QUANTITIES
from onpath.lessons.schema import NumberQuestion, Prediction, Sketch
from onpath.lessons.task_schema import Bound, Check, Compare, Event, EventName, Order, Setting, Task
from onpath.models.closed_loop.simulation import check_level_set, raised
from onpath.models.control.benches import BENCHES, checked_laws
from onpath.models.control.laws.own import OWN
from onpath.models.control.laws.registry import LAWS
from onpath.models.paths.curve_faults import curve_faults
from onpath.models.paths.path_design import presets
from onpath.models.systems.catalogue import ROBOTS, RobotEntry
from onpath.models.systems.parameter_specs import unknown_name
from onpath.models.systems.parameters import changed, specs

CONTROLS = (
    *("hold", "path", "editor", "gains", "plots", "past", "robot", "laws", "copy", "flexible"),
    *("identify", "show", "direction", "wall", "start"),
)
EVENTS: tuple[str, ...] = get_args(EventName)
HIGHEST = 1e6
"""Largest limit of a sketch's axis."""
LONGEST = 60.0
"""Longest script or sketch, [s]: the lab keeps one minute of history."""


def scene_faults(scene: StepSetup, robot: str) -> Iterator[str]:
    """The faults of a scene."""
    if scene.robot:
        yield from _one_of(scene.robot, ROBOTS, "robot")
    if scene.path:
        yield from _one_of(scene.path, presets(), "path")
    if scene.plot:
        yield from _one_of(scene.plot, PLOTS, "plot")
    entry = ROBOTS.get(scene.robot or robot)
    if entry is not None:
        yield from _law_faults(scene.laws, entry)
        faults = list(_setting_faults(scene.set, entry))
        yield from faults or _path_faults(scene, entry)
        for name in scene.controls:
            yield from _one_of(name, [*CONTROLS, *specs(entry.parameters)], "control")


def script_faults(script: Script, robot: str) -> Iterator[str]:
    """The faults of a script."""
    if not 0 < script.until <= LONGEST:
        yield f"until = {script.until:g}: a script ends between 0 and {LONGEST:g} s"
    for action in script.do:
        if not 0 <= action.at <= script.until:
            yield f"at = {action.at:g}: between 0 and the script's end at {script.until:g} s"
        yield from action_faults(action, robot)
        robot = action.robot or robot


def action_faults(action: Action, robot: str) -> Iterator[str]:
    """The faults of an action."""
    try:
        what = action.what
    except ValueError as error:
        yield str(error)
        return
    if what == "set" and robot in ROBOTS:
        yield from _setting_faults(action.set or {}, ROBOTS[robot])
    elif what == "path":
        yield from _one_of(action.path or "", presets(), "path")
    elif what == "robot":
        yield from _one_of(action.robot or "", ROBOTS, "robot")
    elif what == "laws" and action.laws is not None and robot in ROBOTS:
        yield from _law_faults(action.laws, ROBOTS[robot])


def prediction_faults(prediction: Prediction) -> Iterator[str]:
    """The faults of a prediction."""
    if prediction.reasons and prediction.why:
        yield "why = true: reasons are given, so own words are not asked for"
    if len(prediction.reasons) == 1 or not all(map(str.strip, prediction.reasons)):
        yield "reasons: two or more are needed, none of them empty"
    if isinstance(prediction, Sketch):
        yield from _one_of(prediction.quantity, QUANTITIES, "quantity")
        if not 0 < prediction.seconds <= LONGEST:
            yield f"seconds = {prediction.seconds:g}: between 0 and {LONGEST:g}"
        low, high = prediction.bottom, prediction.top
        if not -HIGHEST <= low < high <= HIGHEST:
            yield f"top = {high:g} must be above bottom = {low:g}, both within ±{HIGHEST:g}"
    else:
        yield from option_faults([option.right for option in prediction.options])


def number_faults(question: NumberQuestion) -> Iterator[str]:
    """The faults of a question whose answer is a number."""
    if not abs(question.number) <= HIGHEST:
        yield f"number = {question.number:g}: within ±{HIGHEST:g}"
    if not 0 < question.tolerance <= HIGHEST:
        yield f"tolerance = {question.tolerance:g}: above 0, and at most {HIGHEST:g}"
    elif question.number and question.tolerance >= abs(question.number):
        yield f"tolerance = {question.tolerance:g}: 0 would be accepted as {question.number:g}"


def option_faults(right: list[bool]) -> Iterator[str]:
    """The faults of a question's options.

    Args:
        right: for every option, whether it is correct.
    """
    if len(right) < 2 or sum(right) != 1:
        yield f"{len(right)} options, {sum(right)} right: two or more are needed, one of them right"


def task_faults(task: Task, robot: str) -> Iterator[str]:
    """The faults of a task."""
    if not task.id.replace("-", "").isalnum():
        yield f"id {task.id!r}: letters, digits and hyphens"
    if not task.check:
        yield f"task {task.id!r} has no check"
    if task.best:
        yield from _one_of(task.best, QUANTITIES, "quantity")
    for check in task.check:
        yield from _check_faults(check, ROBOTS.get(robot))


def _check_faults(check: Check, entry: RobotEntry | None) -> Iterator[str]:
    if isinstance(check, Bound | Compare):
        yield from _one_of(check.quantity, QUANTITIES, "quantity")
        if check.stat == "overshoot" and check.quantity not in WITH_SIGN:
            yield f"overshoot of {check.quantity}: it has no sign, only {', '.join(WITH_SIGN)} have"
    if isinstance(check, Bound | Setting):
        equals = getattr(check, "equals", None)
        if check.below is None and check.above is None and equals is None:
            yield "a check needs below or above"
    others = "path", "robot", "length", *BENCHES
    if isinstance(check, Setting) and check.name not in others and entry is not None:
        yield from _one_of(check.name, specs(entry.parameters), "parameter")
    if isinstance(check, Order):
        for event in check.events:
            yield from _one_of(event.partition(":")[0], EVENTS, "event")
    if isinstance(check, Event) and check.event == "law" and check.name:
        yield from _one_of(check.name, [*LAWS, OWN], "law")
    if isinstance(check, Setting) and check.name in BENCHES and check.equals is not None:
        yield from _one_of(str(check.equals), [*LAWS, OWN], "law")
    if isinstance(check, Event) and check.event == "set" and check.name and entry is not None:
        yield from _one_of(check.name, specs(entry.parameters), "parameter")


def _path_faults(scene: StepSetup, entry: RobotEntry) -> Iterator[str]:
    design, parameters = presets().get(scene.path), entry.lab
    if design is None:
        return
    for name, value in scene.set.items():
        parameters = changed(parameters, name, value)
    try:
        check_level_set(parameters, design.curve)
    except ValueError as error:
        yield f"path {scene.path!r}: {error}"
    for fault in curve_faults(entry.make(parameters).margin, raised(design.curve, parameters)):
        yield f"path {scene.path!r}: {fault.reason}"


def _law_faults(laws: Laws, entry: RobotEntry) -> Iterator[str]:
    try:
        checked_laws(laws.named, entry)
    except ValueError as error:
        yield str(error)


def _setting_faults(values: dict[str, Value], entry: RobotEntry) -> Iterator[str]:
    for name, value in values.items():
        try:
            changed(replace(entry.lab), name, value)
        except ValueError as error:
            yield str(error)


def _one_of(name: str, known: object, what: str) -> Iterator[str]:
    names = [str(each) for each in known]  # type: ignore[union-attr]
    if name not in names:
        yield str(unknown_name(name, names, what=what))
