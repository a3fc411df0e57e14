"""A robot about which everything is guessed that can be."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from typing import get_args, get_type_hints

from onpath.models.errors import Message
from onpath.models.robot_files.guesses import Guess
from onpath.models.systems.catalogue import ROBOTS, robot_named
from onpath.models.systems.chain_robot import chain_entry
from onpath.models.systems.robots import RobotEntry

KINDS: tuple[str, ...] = get_args(get_type_hints(Guess)["kind"])


def guess(kind: str) -> Guess:
    """A guess of a kind; its line names it."""
    message = Message("robot_file.massless", {"joint": f"elbow of {kind}"})
    return Guess(kind=kind, message=message, line=f"--{kind} 12")  # type: ignore[arg-type]


def guessed_robot(kinds: Iterable[str] = KINDS, name: str = "guessed_0a1b2c3d") -> RobotEntry:
    """The planar arm with guesses of some kinds."""
    source = robot_named("planar_arm").source
    assert source is not None
    guesses = tuple(map(guess, kinds))
    return chain_entry(dataclasses.replace(source, name=name, label=name, guesses=guesses))


@contextmanager
def in_catalogue(entry: RobotEntry) -> Iterator[RobotEntry]:
    """The catalogue has this robot, too."""
    ROBOTS[entry.name] = entry
    try:
        yield entry
    finally:
        del ROBOTS[entry.name]
