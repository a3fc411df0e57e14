"""Reads what was stored or shared under earlier defaults, names and path checks.

Set-ups are stored as differences from the defaults of their time. Whoever changes a default adds a
line to `CHANGES` with the next version; a test fails until it is there. A new parameter that
changes the motion needs a line, too: its former value is the one that leaves the motion as it was.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from datetime import date
from typing import Any

import msgspec

from onpath.app.lab.setups.plan import planned
from onpath.app.lab.setups.setup import Path, RobotSetup, Setup
from onpath.models.closed_loop.lab_settings import settings_of_start
from onpath.models.closed_loop.start import ON_PATH
from onpath.models.control.settable import specs
from onpath.models.errors import Message
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.parameter_specs import FORMER_NAMES

UNTIL = date(2027, 9, 30)
"""These readers stay until the end of the academic year. Then the present `CHANGES`, `RENAMED` and
`FORMER_NAMES` may be deleted, and a set-up that needs them is refused as invalid."""


@dataclass(frozen=True, slots=True)
class Change:
    """A default that has changed.

    Attributes:
        since: version of the defaults in which it has its present value.
        name: of the parameter.
        former: its previous value.
        robots: names of the robots concerned; empty for all that have the parameter.
    """

    since: int
    name: str
    former: float | str
    robots: tuple[str, ...] = ()


CHANGES = (
    Change(2, "K3", 0.0, ("five_bar", "two_link_arm")),
    Change(2, "tracker_integral", "on", ("five_bar", "two_link_arm", "flexible")),
    Change(3, "at_limit_for", "path_following"),
    Change(4, "observer_time", 0.0),
    Change(4, "observer_bound", 10.0),
)
"""By version, oldest first."""
DEFAULTS = 5
"""Present version of the defaults; stored data without a version are of version 1. Since 5, the
lab's own settings stand under "settings"; see `as_of_today`."""
OWN = {"rate": "rate", "copy": "copy", "exaggeration": "larger", "hold": "hold_direction"}
"""Former name of a lab's own setting, which stood beside the robots -> its present name."""
RENAMED: Mapping[tuple[str, Any], str] = {("plant", "as_printed"): "unit_modes"}
"""(Parameter, former name of an option) -> its present name."""


def as_of_today(data: Any) -> Any:
    """A stored set-up with the lab's own settings where they stand today.

    What never had such a form is left as it is, for the check that follows.
    """
    if not isinstance(data, dict) or data.get("defaults", 1) == DEFAULTS:
        return data
    current = {name: value for name, value in data.items() if name not in OWN}
    current["settings"] = {OWN[name]: value for name, value in data.items() if name in OWN}
    if isinstance(robots := data.get("benches"), dict):
        current["benches"] = {name: _robot_of_today(robot) for name, robot in robots.items()}
    return current


def _robot_of_today(robot: Any) -> Any:
    """See `as_of_today`."""
    if not isinstance(robot, dict):
        return robot
    start, wall = robot.get("start", {}), robot.get("wall", [])
    if not isinstance(start, dict) or not isinstance(wall, list):
        return robot
    settings: dict[str, Any] = {f"start_{name}": value for name, value in start.items()}
    if wall:
        names = "wall_z1", "wall_z2", "wall_angle"
        if len(wall) != len(names) or not all(isinstance(each, int | float) for each in wall):
            return robot
        z1, z2, angle = wall
        if not -2 * math.pi <= angle <= 2 * math.pi:
            return robot
        settings |= zip(names, (z1, z2, math.remainder(angle, 2 * math.pi)), strict=True)
        settings["wall"] = True
    return {n: value for n, value in robot.items() if n not in ("start", "wall")} | {
        "settings": settings
    }


def own_of_today(state: Mapping[str, Any]) -> Any:
    """The lab's own settings of a stored state, some of which stood in the progress."""
    lessons = state.get("lessons")
    if isinstance(lessons, dict) and "presenting" in lessons:
        return {"presenting": lessons["presenting"]}
    return state.get("settings", {})


def former_defaults(robot: str, version: int) -> dict[str, Any]:
    """A robot's parameters whose defaults were different in a version, with their values then."""
    former = dict[str, Any]()
    for change in CHANGES:
        concerned = robot in change.robots if change.robots else _has(robot, change.name)
        if change.since > version and concerned:
            former.setdefault(change.name, change.former)
    return former


def _has(robot: str, name: str) -> bool:
    return name in specs(ROBOTS[robot].parameters)


def brought_up(robots: Mapping[str, RobotSetup], version: int) -> dict[str, RobotSetup]:
    """Set-ups of robots as they are written today: differences from the present defaults.

    Args:
        version: of the defaults that they differ from.
    """
    current = dict(robots)
    for name in dict.fromkeys([*ROBOTS, *robots]):
        former = former_defaults(name, version) if name in ROBOTS else {}
        robot = robots.get(name, RobotSetup())
        own = {FORMER_NAMES.get(name, name): value for name, value in robot.parameters.items()}
        parameters = {
            parameter: RENAMED.get((parameter, value), value)
            for parameter, value in {**former, **own}.items()
        }
        if parameters != robot.parameters:
            current[name] = msgspec.structs.replace(robot, parameters=parameters)
    return current


def with_paths_of_today(setup: Setup) -> tuple[Setup, tuple[Message, ...]]:
    """A stored set-up with the circle in place of each path that is now refused, and the reasons.

    A path that was accepted when it was stored may be refused now. A start that is no longer
    possible is replaced by a new lab's.

    Raises:
        ValueError: the set-up is impossible for another reason.
    """
    robots, messages = dict(setup.robots), list[Message]()
    for name, wanted in planned(setup).items():
        if reasons := wanted.path_faults:
            kept = robots.get(name, RobotSetup())
            robots[name] = msgspec.structs.replace(kept, path=Path(), settings=_on_path(kept))
            messages += reasons
        elif wanted.own.start != ON_PATH:
            try:
                wanted.check_start()
            except ValueError:
                kept = robots[name]
                robots[name] = msgspec.structs.replace(kept, settings=_on_path(kept))
    return msgspec.structs.replace(setup, robots=robots), tuple(messages)


def _on_path(robot: RobotSetup) -> dict[str, Any]:
    """A robot's own settings, with the start of a new lab."""
    start = settings_of_start(ON_PATH)
    return {name: value for name, value in robot.settings.items() if name not in start}
