"""The catalogue of robots: every module of this folder that defines a `ROBOT`."""

from __future__ import annotations

from importlib import import_module
from pkgutil import iter_modules

from onpath.models import systems
from onpath.models.systems.robots import RobotEntry


def found_robots() -> dict[str, RobotEntry]:
    """The robots of the modules of `models/systems`, by name, in the order of the modules' names.

    Raises:
        ValueError: two robots have the same name.
    """
    robots = dict[str, RobotEntry]()
    for module in iter_modules(systems.__path__, f"{systems.__name__}."):
        if module.name == __name__:
            continue
        entry = getattr(import_module(module.name), "ROBOT", None)
        if entry is None:
            continue
        if entry.name in robots:
            raise ValueError(f"{module.name}: there is another robot named {entry.name!r}")
        robots[entry.name] = entry
    return robots


ROBOTS = found_robots()
FIVE_BAR = ROBOTS["five_bar"]
"""The robot of section III of the paper, with which a lab begins."""
FLEXIBLE = ROBOTS["flexible"]
"""The robot of section IV of the paper."""
