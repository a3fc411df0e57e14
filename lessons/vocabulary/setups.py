"""Faults of set-ups, scripts and actions."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

from onpath.lessons.action_schema import (
    Action,
    Laws,
    RunStart,
    SceneMark,
    Script,
    StepSetup,
    Value,
)
from onpath.lessons.record import PLOTS
from onpath.lessons.vocabulary.kinds import kind_faults
from onpath.lessons.vocabulary.names import (
    CONTROLS,
    DRAWINGS,
    LONGEST,
    MOST_MARKS,
    MOST_PLOTS,
    REACH,
    one_of,
)
from onpath.models.closed_loop.lab_settings import RATES, SETTINGS, step_specs
from onpath.models.closed_loop.simulation import check_level_set, raised
from onpath.models.closed_loop.start import Start, check_start
from onpath.models.control.settable import with_values
from onpath.models.control.sides import checked_laws
from onpath.models.paths.curve_faults import curve_faults
from onpath.models.paths.curves import Curve
from onpath.models.paths.path_design import presets
from onpath.models.systems.catalogue import ROBOTS, RobotEntry
from onpath.models.systems.parameter_specs import checked, unknown_name
from onpath.models.systems.parameters import Parameters


def setup_faults(setup: StepSetup, robot: str) -> Iterator[str]:
    """The faults of a step's set-up."""
    if setup.robot:
        yield from one_of(setup.robot, ROBOTS, "robot")
    if setup.path:
        yield from one_of(setup.path, presets(), "path")
    yield from _drawing_faults(setup)
    entry = ROBOTS.get(setup.robot or robot)
    if entry is not None:
        yield from _law_faults(setup.laws, entry)
        faults = list(_setting_faults(setup.set, entry))
        yield from faults or _path_faults(setup, entry)
        for name in setup.controls:
            yield from one_of(name, [*CONTROLS, *step_specs(entry.parameters)], "control")


def _drawing_faults(setup: StepSetup) -> Iterator[str]:
    """The faults of a set-up's plots and drawings."""
    for name in setup.plots:
        yield from one_of(name, PLOTS, "plot")
    if len(set(setup.plots)) < len(setup.plots) or len(setup.plots) > MOST_PLOTS:
        yield f"plot: one, or a list of {MOST_PLOTS} different ones"
    for name in setup.show:
        yield from one_of(name, DRAWINGS, "drawing")
    if len(setup.marks) > MOST_MARKS:
        yield f"marks: at most {MOST_MARKS}"
    for mark in setup.marks:
        yield from _mark_faults(mark)


def _mark_faults(mark: SceneMark) -> Iterator[str]:
    numbers = [*mark.at, *(mark.tail or ())]
    if not all(abs(number) <= REACH for number in numbers):  # NaN fails too
        yield f"marks: places within ±{REACH:g} mm"
    if mark.tail is None and not mark.text.strip():
        yield "marks: each has a text, or with `from` an arrow"
    elif mark.tail == mark.at:
        yield "marks: the arrow begins where it ends"


def script_faults(script: Script, robot: str) -> Iterator[str]:
    """The faults of a script."""
    if not 0 < script.until <= LONGEST:
        yield f"until = {script.until:g}: a script ends between 0 and {LONGEST:g} s"
    for before, action in pairwise(script.do):
        if action.at < before.at:
            yield f"at = {action.at:g} stands after at = {before.at:g}: in the order of their times"
    for action in script.do:
        if not 0 <= action.at <= script.until:
            yield f"at = {action.at:g}: between 0 and the script's end at {script.until:g} s"
        yield from action_faults(action, robot)
        robot = action.robot or robot


def release_faults(script: Script) -> Iterator[str]:
    """The fault of a pull that outlasts its script, since the student cannot end it."""
    pulled: Action | None = None
    for action in sorted(script.do, key=lambda action: action.at):
        if action.pull is not None:
            pulled = action
        elif action.release or action.reset or action.start or action.robot:
            pulled = None
    if pulled is not None:
        yield f"pull at {pulled.at:g} s: nothing releases it; add {{ at = …, release = true }}"


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
        yield from one_of(action.path or "", presets(), "path")
    elif what == "robot":
        yield from one_of(action.robot or "", ROBOTS, "robot")
    elif what == "laws" and action.laws is not None and robot in ROBOTS:
        yield from _law_faults(action.laws, ROBOTS[robot])
    elif what == "rate" and not RATES[0] <= (action.rate or 0.0) <= RATES[-1]:
        yield f"rate = {action.rate:g}: between {RATES[0]:g} and {RATES[-1]:g}"
    elif what == "start" and action.start is not None:
        yield from _start_faults(action.start)


def _path_faults(setup: StepSetup, entry: RobotEntry) -> Iterator[str]:
    """The faults of a set-up's path, and of its start on that path."""
    name, parameters = setup.path or "circle", entry.parameters()
    design = presets().get(name)
    if design is None:
        return
    parameters = with_values(parameters, {n: v for n, v in setup.set.items() if n not in SETTINGS})
    try:
        check_level_set(parameters, design.curve)
    except ValueError as error:
        yield f"path {name!r}: {error}"
    curve = raised(design.curve, parameters)
    faults = curve_faults(entry.make(parameters).margin, curve)
    for fault in faults:
        yield f"path {name!r}: {fault.reason}"
    if setup.start.numbers and not faults:
        yield from _start_faults(setup.start, (entry, parameters, curve))


def _start_faults(
    start: RunStart, where: tuple[RobotEntry, Parameters, Curve] | None = None
) -> Iterator[str]:
    """The reason why a start is not possible.

    Args:
        where: robot, parameters and path, if they are known.
    """
    try:
        state = Start(**start.numbers)
        if where is not None:
            entry, parameters, curve = where
            check_start(entry.make(parameters), curve, parameters, state)
    except ValueError as error:
        yield f"start: {error}"


def _law_faults(laws: Laws, entry: RobotEntry) -> Iterator[str]:
    try:
        checked_laws(laws.named, entry)
    except ValueError as error:
        yield str(error)


def _setting_faults(values: dict[str, Value], entry: RobotEntry) -> Iterator[str]:
    known = step_specs(entry.parameters)
    for name, value in values.items():
        try:
            if name not in known:
                raise unknown_name(name, list(known))
            checked(known[name], name, value)
        except ValueError as error:
            yield str(error)
        else:
            yield from kind_faults(name, value, known[name])
