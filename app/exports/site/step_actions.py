"""The scripts and links of a lesson as data for a figure's page."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from onpath.app.exports.site.settings_places import Unsupported, with_values, writes
from onpath.app.exports.standalone.figure_choice import FigureChoice
from onpath.app.lab.external_forces import displaced
from onpath.lessons.action_schema import Action, RobotName, Script
from onpath.lessons.record import ROBOTS
from onpath.models.closed_loop.lab_settings import SETTINGS
from onpath.models.closed_loop.page_functions import page_functions

Act = dict[str, Any]


def script_acts(script: Script, figure: FigureChoice) -> dict[str, Any]:
    """A script as data.

    Raises:
        Unsupported: a figure cannot do one of its actions.
        ValueError: a value is out of range.
    """
    parameters, timed = figure.parameters, list[tuple[float, Act]]()
    for action in sorted(script.do, key=lambda each: each.at):
        timed.append((action.at, act_of(action, figure, parameters)))
        parameters = with_values(parameters, action.set or {})
    return {"until": script.until, "do": timed}


def link_acts(actions: Iterable[Action], figure: FigureChoice) -> list[Act]:
    """The actions of a link as data.

    Raises:
        Unsupported: a figure cannot do one of its actions.
        ValueError: a value is out of range.
    """
    return [act_of(action, figure, figure.parameters) for action in actions]


def act_of(action: Action, figure: FigureChoice, parameters: Any) -> Act:
    """One action as data.

    Args:
        parameters: the parameters before the action.

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
    values = action.set or {}
    if what == "set" and not SETTINGS.keys() & values.keys():
        return {"set": values, "write": writes(figure, values, parameters)}
    if what == "path" and action.path and action.path in figure.paths:
        return {"path": list(figure.paths).index(action.path)}
    if what in ("release", "reset", "run", "rate"):
        return {what: getattr(action, what)}
    raise Unsupported(f"{what}: only in the lab")


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
