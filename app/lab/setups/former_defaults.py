"""Defaults that have changed. Set-ups are stored as differences from the defaults of their time.

Who changes a default adds a line to `CHANGES`, with the next version; a test fails until it is
there. A parameter that is added, and changes the motion, has a line, too: its former value is the
one with which the motion is as before.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from onpath.models.control.settable import specs
from onpath.models.systems.catalogue import ROBOTS


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
