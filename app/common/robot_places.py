"""Where a robot's file is: what users may give instead of a name of the catalogue."""

from __future__ import annotations

import os
import re
import shlex
from collections.abc import Iterator
from dataclasses import dataclass, field
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from onpath.app.common.user_files import user_file
from onpath.models.errors import CodedError
from onpath.models.systems.catalogue import ROBOTS

ENDINGS = ".urdf", ".xml", ".mjcf", ".xacro"
DESCRIPTIONS = "robot_descriptions"
"""A package of PyPI whose modules bring the robots of public repositories."""
PLACES = "URDF_PATH", "MJCF_PATH", "XACRO_PATH"
"""What such a module calls its file; a module may have several of them."""
DEEPEST, MOST_ENTRIES, MOST_NAMES = 4, 5000, 20
"""How deep a folder is searched, how many files are looked at, and how many are listed."""
HEAD = 1 << 16  # [B] of a file that are searched for its first element
_ROOT = re.compile(rb"<(robot|mujoco)[\s>]")
_NAME = re.compile(r"[a-z0-9_]{1,80}")


@dataclass(frozen=True, slots=True)
class RobotPlace:
    """A robot's file.

    Attributes:
        packages: folders of packages that come with it, by name.
    """

    file: Path
    packages: dict[str, Path] = field(default_factory=dict[str, Path])


def is_from_file(robot: Any) -> bool:
    """Whether a robot is given by its file, by a folder, or by a name of `robot_descriptions`.

    A name of the catalogue is none of these, whatever files there are.
    """
    if isinstance(robot, Path):
        return True
    if not isinstance(robot, str) or not robot or robot in ROBOTS:
        return False
    path = Path(robot)
    names_path = path.suffix.lower() in ENDINGS or robot.startswith("~") or len(path.parts) > 1
    return names_path or path.is_dir() or is_described(robot)


def robot_place(robot: str | Path) -> RobotPlace:
    """The file of a robot for which `is_from_file`.

    Raises:
        CodedError: a folder has no robot's file, or several, which are listed.
        OSError: there is no such file.
    """
    path = Path(robot).expanduser()
    if path.is_dir():
        return RobotPlace(only_file_in(path))
    if isinstance(robot, str) and not path.exists() and is_described(robot):
        return described_place(robot)
    return RobotPlace(user_file(path))


def only_file_in(folder: Path) -> Path:
    """The only robot's file in a folder.

    Raises:
        CodedError: it has none, or several, which are listed.
    """
    found = sorted(_files_in(folder))
    plain = [file for file in found if file.suffix.lower() != ".xacro"]
    files = plain or found  # a xacro file beside others may be what they were made from
    if len(files) == 1:
        return files[0]
    if not files:
        raise CodedError("robot_file.empty_folder", folder=str(folder), endings=", ".join(ENDINGS))
    lines = [f"--robot {shlex.quote(str(file))}" for file in files[:MOST_NAMES]]
    lines += ["…"] if len(files) > MOST_NAMES else []
    raise CodedError(
        "robot_file.which_file",
        folder=str(folder),
        count=len(files),
        lines=", ".join(lines),
    )


def _files_in(folder: Path) -> Iterator[Path]:
    """Files of robots in a folder and those below it; links to folders are not followed."""
    seen = 0
    for place, folders, names in os.walk(folder):
        depth = len(Path(place).relative_to(folder).parts)
        folders[:] = sorted(each for each in folders if not each.startswith("."))
        if depth >= DEEPEST:
            folders.clear()
        for name in sorted(names):
            seen += 1
            if seen > MOST_ENTRIES:
                return
            file = Path(place, name)
            if file.suffix.lower() in ENDINGS and file.is_file() and _describes_robot(file):
                yield file


def _describes_robot(file: Path) -> bool:
    """Whether a file has a robot's element at its beginning."""
    try:
        with file.open("rb") as opened:
            return _ROOT.search(opened.read(HEAD)) is not None
    except OSError:
        return False


def is_described(name: str) -> bool:
    """Whether `robot_descriptions` is installed and has this robot; none of its code is run."""
    if _NAME.fullmatch(name) is None or find_spec(DESCRIPTIONS) is None:
        return False
    return name.endswith("_description") and find_spec(f"{DESCRIPTIONS}.{name}") is not None


def described_place(name: str) -> RobotPlace:
    """The file of a robot of `robot_descriptions`, which may fetch it from its repository.

    Raises:
        CodedError: the package cannot fetch it, or has no file of it that can be read.
    """
    try:
        module = import_module(f"{DESCRIPTIONS}.{name}")
    except Exception as error:  # of git, of the network
        reason = " ".join(str(error).split()) or type(error).__name__
        raise CodedError("robot_file.not_fetched", name=name, reason=reason) from error
    for place in PLACES:
        if file := getattr(module, place, ""):
            break
    else:
        raise CodedError("robot_file.no_description", name=name)
    package = getattr(module, "PACKAGE_PATH", "")
    return RobotPlace(Path(file), {Path(package).name: Path(package)} if package else {})
