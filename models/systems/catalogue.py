"""The catalogue of robots: every module of this folder that defines a `ROBOT`, and added ones."""

from __future__ import annotations

import copyreg
from collections.abc import Callable
from dataclasses import replace
from importlib import import_module
from pkgutil import iter_modules
from typing import Any

from onpath.models import systems
from onpath.models.errors import CodedError
from onpath.models.systems.chain_robot import chain_entry
from onpath.models.systems.parameter_specs import unknown_name
from onpath.models.systems.rigid_chain import ChainSource, source_from
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


def robot_named(name: str) -> RobotEntry:
    """The robot of this name.

    Raises:
        CodedError: there is none; the message lists the nearest names.
    """
    if name not in ROBOTS:
        raise unknown_name(name, list(ROBOTS), "robot")
    return ROBOTS[name]


def add_robot(entry: RobotEntry) -> RobotEntry:
    """Add a robot that is not a module of this folder, such as one from a file.

    While a server runs, its simulation thread calls it: no lab changes then. Other threads that go
    through the catalogue take a copy of it first.

    Returns:
        The entry, or the one added earlier from the same file and options, with what this one
        says of itself: its loops may already be compiled, and a guess may be settled meanwhile.

    Raises:
        CodedError: another robot has this name.
    """
    known = ROBOTS.setdefault(entry.name, entry)
    if known is not entry and known.source is None:
        raise CodedError("robot_file.same_name", name=entry.name)
    if known != entry:
        return known
    if known.guesses != entry.guesses:
        known = ROBOTS[entry.name] = replace(entry, make=known.make)
    return known


def robot_again(name: str, data: dict[str, Any] | None) -> RobotEntry:
    """A robot that was pickled; one from a file is added to the catalogue.

    If the catalogue has a robot of this name that is made differently, it stays, and the one
    returned is not in it.

    Args:
        data: `ChainSource.data` of a robot from a file; None for one of this package.

    Raises:
        ValueError: this version of OnPath has no such robot, or cannot read its data.
    """
    if data is None:
        return robot_named(name)
    entry = chain_entry(source_from(data))
    known = ROBOTS.setdefault(name, entry)
    return known if known == entry else entry


def _pickled(entry: RobotEntry) -> tuple[Callable[..., RobotEntry], tuple[Any, ...]]:
    """What `copyreg` asks for."""
    if _FOUND.get(entry.name) == entry:
        return robot_again, (entry.name, None)
    if entry.source is None:
        raise TypeError(f"{entry.name}: only robots of OnPath and from files can be pickled")
    return robot_again, (entry.name, entry.source.data())


copyreg.pickle(RobotEntry, _pickled)  # type: ignore[arg-type]


def added_chains() -> list[ChainSource]:
    """The sources of the chains that have been added: plain data, for another process."""
    robots = tuple(ROBOTS.items())
    return [entry.source for name, entry in robots if name not in _FOUND and entry.source]


def add_chains(sources: list[ChainSource]) -> None:
    """Add the robots of `added_chains` of another process."""
    for source in sources:
        add_robot(chain_entry(source))


_FOUND = found_robots()
FIVE_BAR = _FOUND["five_bar"]
"""The robot of section III of the paper, with which a lab begins."""
ROBOTS = {FIVE_BAR.name: FIVE_BAR, **_FOUND}  # menus begin with it, too
FLEXIBLE = ROBOTS["flexible"]
"""The robot of section IV of the paper."""
