"""What was kept or shared when defaults, names or checks of paths were others: all that reads it.

Set-ups are stored as differences from the defaults of their time. Who changes a default adds a line
to `CHANGES`, with the next version; a test fails until it is there. A parameter that is added, and
changes the motion, has a line, too: its former value is the one with which the motion is as before.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from datetime import date
from typing import Any

import msgspec

from onpath.app.lab.setups.plan import planned
from onpath.app.lab.setups.setup import Path, RobotSetup, Setup
from onpath.models.closed_loop.start import ON_PATH
from onpath.models.control.settable import specs
from onpath.models.errors import Message
from onpath.models.paths.path_design import presets
from onpath.models.systems.catalogue import ROBOTS

UNTIL = date(2027, 9, 30)
"""Until the end of the academic year these readers stay. Then `CHANGES` up to that day and
`RENAMED` may be deleted: a set-up that needs them is refused as one that is not valid."""


@dataclass(frozen=True, slots=True)
class Change:
    """A default that has changed.

    Attributes:
        since: version of the defaults in which it has its present value.
        name: of the parameter.
        former: its value before.
        robots: names of those whose default it was; empty: of all that have the parameter.
    """

    since: int
    name: str
    former: float | str
    robots: tuple[str, ...] = ()


CHANGES = (
    Change(2, "K3", 0.0, ("five_bar", "two_link_arm")),
    Change(2, "tracker_integral", "on", ("five_bar", "two_link_arm", "flexible")),
    Change(3, "at_limit_for", "path_following"),
)
"""By version, oldest first."""
DEFAULTS = max(change.since for change in CHANGES)
"""Present version of the defaults; stored data that name none are of version 1."""
RENAMED: Mapping[tuple[str, Any], str] = {("plant", "as_printed"): "unit_modes"}
"""(Parameter, former name of an option) -> its present name."""


def former_defaults(robot: str, version: int) -> dict[str, Any]:
    """A robot's parameters whose defaults were others in a version, with their values then."""
    found = dict[str, Any]()
    for change in CHANGES:
        concerned = robot in change.robots if change.robots else _has(robot, change.name)
        if change.since > version and concerned:
            found.setdefault(change.name, change.former)
    return found


def _has(robot: str, name: str) -> bool:
    return name in specs(ROBOTS[robot].parameters)


def brought_up(robots: Mapping[str, RobotSetup], version: int) -> dict[str, RobotSetup]:
    """Set-ups of robots as they are written today: differences from the present defaults.

    Args:
        version: of the defaults that they differ from.
    """
    found = dict(robots)
    for name in dict.fromkeys([*ROBOTS, *robots]):
        former = former_defaults(name, version) if name in ROBOTS else {}
        robot = robots.get(name, RobotSetup())
        own = {**former, **robot.parameters}
        own = {each: RENAMED.get((each, value), value) for each, value in own.items()}
        if own != robot.parameters:
            found[name] = msgspec.structs.replace(robot, parameters=own)
    return found


def with_paths_of_today(setup: Setup) -> tuple[Setup, tuple[Message, ...]]:
    """A kept set-up with the circle in place of every path that is refused today, and why it is.

    A path that was accepted when it was kept may be refused now. A start that is not possible, too,
    is replaced by that of a new lab.

    Raises:
        ValueError: the set-up is impossible for another reason.
    """
    robots, told = dict(setup.robots), tuple[Message, ...]()
    for name, wanted in planned(setup, presets()).items():
        if reasons := wanted.path_faults:
            kept = robots.get(name, RobotSetup())
            robots[name] = msgspec.structs.replace(kept, path=Path(), start={})
            told = (*told, *reasons)
        elif wanted.start != ON_PATH:
            try:
                wanted.check_start()
            except ValueError:
                robots[name] = msgspec.structs.replace(robots[name], start={})
    return msgspec.structs.replace(setup, robots=robots), told
