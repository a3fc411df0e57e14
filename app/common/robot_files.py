"""Adds robots from files to the catalogue, and gives their arguments on a command line."""

from __future__ import annotations

from pathlib import Path

from onpath.models.errors import Message
from onpath.models.systems.catalogue import add_robot
from onpath.models.systems.file_chain import Options
from onpath.models.systems.guessed_numbers import told_guess
from onpath.models.systems.robot_file import read_robot
from onpath.models.systems.robots import RobotEntry

_FILES = dict[str, tuple[Path, Options]]()  # by name


def robot_of_file(file: Path, options: Options) -> tuple[RobotEntry, tuple[Message, ...]]:
    """Add the robot of a file to the catalogue; return it, with remarks for the user.

    What has been guessed is among the remarks, but for the pose, which one sees. Each is said once.

    Raises:
        ValueError: see `read_robot`.
    """
    read = read_robot(file, options)
    entry = add_robot(read.entry)
    _FILES[entry.name] = file.resolve(), options
    guesses = (told_guess(guess) for guess in read.guesses if guess.kind != "pose")
    return entry, tuple({str(remark): remark for remark in (*read.remarks, *guesses)}.values())


def robot_arguments(robot: str) -> list[str]:
    """`--robot` as the command line takes it: a name, or a file with its options."""
    if robot not in _FILES:
        return ["--robot", robot]
    file, options = _FILES[robot]
    given = ["--robot", str(file)]
    given += ["--tip", options.tip] if options.tip else []
    for option, pairs in (
        ("--pose", options.pose),
        ("--lock", options.lock),
        ("--package", {name: folder.resolve() for name, folder in options.packages.items()}),
    ):
        for name, value in pairs.items():
            given += [option, f"{name}={value}"]
    given += ["--armature", str(options.armature)] if options.armature else []
    for option, number in (("--density", options.density), ("--mass", options.mass)):
        given += [] if number is None else [option, str(number)]
    return given
