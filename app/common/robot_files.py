"""Robots from files: adds them to the catalogue, and knows from which file each one is."""

from __future__ import annotations

import logging
import shlex
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from onpath.app.common.announced import announced
from onpath.models.errors import Message
from onpath.models.robot_files.file_chain import Options, TipAt
from onpath.models.systems.catalogue import add_robot
from onpath.models.systems.chain_robot import chain_entry
from onpath.models.systems.guessed_numbers import told_guess
from onpath.models.systems.rigid_chain import ChainSource
from onpath.models.systems.robot_file import read_robot
from onpath.models.systems.robots import RobotEntry

log = logging.getLogger(__name__)


@dataclass(frozen=True, slots=True, eq=False)
class GivenFile:
    """A robot's file, as it was given.

    Attributes:
        tips: that the file suggests, the best first.
        tip: of the robot.
        places: see `FileChain`.
    """

    file: Path
    options: Options
    tips: tuple[str, ...]
    tip: str
    places: Mapping[str, TipAt]

    def with_tip(self, tip: str) -> GivenFile:
        """The same file with another one of its tips."""
        return replace(self, options=replace(self.options, tip=tip), tip=tip)


@dataclass(frozen=True, slots=True, eq=False)
class ReadFile:
    """What has been read from a file: plain data, which another process may have read.

    Attributes:
        remarks: for the user, each once.
    """

    source: ChainSource
    given: GivenFile
    remarks: tuple[Message, ...]


_FILES = dict[str, GivenFile]()  # the robots' files, by the robot's name


def robot_of_file(file: Path, options: Options) -> tuple[RobotEntry, tuple[Message, ...]]:
    """Add the robot of a file to the catalogue; return it, with remarks for the user.

    What has been guessed is among the remarks. Each is said once.

    Raises:
        ValueError: see `read_robot`.
    """
    log.info("reading %s, and choosing a pose", file.name)  # a server says so, others below
    with announced(f"OnPath: reading {file.name} …"):
        read = read_file(file, options)
        return add_read(read), read.remarks


def read_file(file: Path, options: Options) -> ReadFile:
    """Read a robot's file, without a change of the catalogue.

    Raises:
        ValueError: see `read_robot`.
    """
    read = read_robot(file, options)
    source = read.entry.source
    assert source is not None
    guesses = (told_guess(guess) for guess in read.guesses)
    remarks = {str(remark): remark for remark in (*read.remarks, *guesses)}
    given = GivenFile(
        file=file.resolve(),
        options=options,
        tips=read.tips,
        tip=options.tip or next(iter(read.tips), ""),
        places=read.places,
    )
    return ReadFile(source, given, tuple(remarks.values()))


def add_read(read: ReadFile) -> RobotEntry:
    """Add the robot that has been read to the catalogue."""
    entry = add_robot(chain_entry(read.source))
    _FILES[entry.name] = read.given
    return entry


def given_file(robot: str) -> GivenFile | None:
    """The file of a robot in the catalogue; None if it is not from a file that was given."""
    return _FILES.get(robot)


def other_tips(robot: str) -> dict[str, TipAt]:
    """The tips that a robot's file suggests besides its own, and where they are."""
    given = _FILES.get(robot)
    if given is None:
        return {}
    return {name: given.places[name] for name in given.tips if name != given.tip}


def built_with(given: GivenFile) -> str:
    """The name of the robot in the catalogue that is from the same file, with this tip; or ""."""
    for name, other in tuple(_FILES.items()):  # a server's thread may add one meanwhile
        if other.file == given.file and other.tip == given.tip:
            return name
    return ""


def to_type(file: str, tip: str) -> str:
    """What starts the lab with a file and its tip, as one types it."""
    given = ["onpath", "--robot", file or "FILE"]
    return shlex.join(given + (["--tip", tip] if tip else []))


def robot_arguments(robot: str) -> list[str]:
    """`--robot` as the command line takes it: a name, or a file with its options."""
    if robot not in _FILES:
        return ["--robot", robot]
    file, options = _FILES[robot].file, _FILES[robot].options
    given = ["--robot", str(file)]
    given += ["--tip", options.tip] if options.tip else []
    for option, pairs in (
        ("--pose", options.pose),
        ("--lock", options.lock),
        ("--package", {name: folder.resolve() for name, folder in options.packages.items()}),
    ):
        for name, value in pairs.items():
            given += [option, f"{name}={value}"]
    for option, number in (
        ("--armature", options.armature),
        ("--density", options.density),
        ("--mass", options.mass),
    ):
        given += [option, str(number)] if number else []
    return given
