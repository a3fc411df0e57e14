"""The scripts and links of a lesson as data for a figure's page."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from onpath.app.exports.standalone.figure_choice import FigureChoice
from onpath.app.exports.standalone.setting_numbers import Unsupported, page_values
from onpath.app.lab.external_forces import displaced
from onpath.lessons.action_schema import Action, RobotName, Script, Value
from onpath.lessons.record import ROBOTS
from onpath.models.closed_loop.page_functions import page_functions
from onpath.models.control.laws.registry import law_name
from onpath.models.control.settable import specs
from onpath.models.control.sides import SIDES

Act = dict[str, Any]


def script_acts(script: Script, figure: FigureChoice) -> dict[str, Any]:
    """A script as data.

    Raises:
        Unsupported: a figure cannot do one of its actions.
    """
    actions = sorted(script.do, key=lambda each: each.at)
    return {"until": script.until, "do": [(each.at, act_of(each, figure)) for each in actions]}


def link_acts(actions: Iterable[Action], figure: FigureChoice) -> list[Act]:
    """The actions of a link as data.

    Raises:
        Unsupported: a figure cannot do one of its actions.
    """
    return [act_of(action, figure) for action in actions]


def act_of(action: Action, figure: FigureChoice) -> Act:
    """One action as data.

    Raises:
        Unsupported: a figure cannot do it.
    """
    what = action.what
    side = {"side": _side(action.only)}
    if what == "hold":
        return {"hold": action.hold, **side}
    if what == "pull":
        assert action.pull is not None
        return {"pull": _in_picture(figure, action.pull), **side}
    if what == "set":
        return {"set": _settable(figure, action.set or {})}
    if what == "path" and action.path and action.path in figure.paths:
        return {"path": list(figure.paths).index(action.path)}
    if what == "laws" and action.laws is not None:
        laws = {
            side: figure.every_law.index(law_name(law)) for side, law in action.laws.named.items()
        }
        return {"laws": [laws.get(side) for side in SIDES]}
    if what == "move" and action.move is not None:
        index, right, up = action.move
        return {"move": [index, right / 1e3, up / 1e3]}
    if what in ("release", "reset", "run", "rate"):
        return {what: getattr(action, what)}
    raise Unsupported(f"{what}: only in the lab")


def _settable(figure: FigureChoice, values: Mapping[str, Value]) -> Mapping[str, Value]:
    """The values, if each parameter may change on the page.

    Raises:
        Unsupported: one may not, or not to its value.
    """
    for name, value in values.items():
        if value in figure.remade.get(name, ()):
            continue
        if name not in (*figure.sliders, *figure.changing):
            raise Unsupported(f"{name}: only in the lab")
        options = specs(figure.parameters)[name].options
        if options and value not in page_values(figure, name, {}):
            raise Unsupported(f"{name} = {value}: only in the lab")
    return values


def _side(only: RobotName | str) -> int | None:
    """Number of the side that an action concerns; None: both."""
    return list(ROBOTS).index(only) if only in ROBOTS else None  # type: ignore[arg-type]


def _in_picture(figure: FigureChoice, by: tuple[float, float]) -> list[float]:
    """A displacement in the path's plane, [mm], as a displacement in the picture, [m]."""
    robot, curve = figure.machine, next(iter(figure.paths.values()))
    place = page_functions(robot, figure.kind(figure.laws[0], curve))["place"]
    y = robot.frame.lift(np.zeros(2))
    moved = displaced(robot.frame, y, np.array(by) / 1e3)
    return (place(moved) - place(y)).full().ravel().tolist()
