"""Reads what was stored or shared under earlier defaults, names and path checks.

Set-ups are stored as differences from the defaults of their time. Whoever changes a default adds a
line to `CHANGES` with the next version; a test fails until it is there. A new parameter that
changes the motion needs a line, too: its former value is the one that leaves the motion as it was.
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
DEFAULTS = max(change.since for change in CHANGES)
"""Present version of the defaults; stored data without a version are of version 1."""
RENAMED: Mapping[tuple[str, Any], str] = {("plant", "as_printed"): "unit_modes"}
"""(Parameter, former name of an option) -> its present name."""


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
    for name, wanted in planned(setup, presets()).items():
        if reasons := wanted.path_faults:
            kept = robots.get(name, RobotSetup())
            robots[name] = msgspec.structs.replace(kept, path=Path(), start={})
            messages += reasons
        elif wanted.start != ON_PATH:
            try:
                wanted.check_start()
            except ValueError:
                robots[name] = msgspec.structs.replace(robots[name], start={})
    return msgspec.structs.replace(setup, robots=robots), tuple(messages)
