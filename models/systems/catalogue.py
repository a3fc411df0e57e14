"""The catalogue of robots: every module of this folder that defines a `ROBOT`, and added ones."""

from __future__ import annotations

from importlib import import_module
from pkgutil import iter_modules

from onpath.models import systems
from onpath.models.errors import CodedError
from onpath.models.systems.chain_robot import chain_entry
from onpath.models.systems.rigid_chain import ChainSource
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


def add_robot(entry: RobotEntry) -> RobotEntry:
    """Add a robot that is not a module of this folder, such as one from a file.

    Call it before a server listens: pages and labs expect that the robots stay the same.

    Returns:
        The entry; an earlier one with the same chain of bodies, whose loops may be compiled.

    Raises:
        CodedError: another robot has this name.
    """
    known = ROBOTS.setdefault(entry.name, entry)
    if known is not entry and known.source is None:
        raise CodedError("robot_file.same_name", name=entry.name)
    return known


def added_chains() -> list[ChainSource]:
    """What the robots are made from that have been added: plain data, for another process."""
    return [entry.source for name, entry in ROBOTS.items() if name not in _FOUND and entry.source]


def add_chains(sources: list[ChainSource]) -> None:
    """Add the robots of `added_chains` of another process."""
    for source in sources:
        add_robot(chain_entry(source))


ROBOTS = found_robots()
_FOUND = frozenset(ROBOTS)
FIVE_BAR = ROBOTS["five_bar"]
"""The robot of section III of the paper, with which a lab begins."""
FLEXIBLE = ROBOTS["flexible"]
"""The robot of section IV of the paper."""
