"""`--robot FILE`, and the options that describe a robot's file."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import tyro

from onpath.app.cli.assignments import assignments
from onpath.app.cli.options import Repeated

if TYPE_CHECKING:
    from onpath.models.systems.robots import RobotEntry


@dataclass(frozen=True)
class RobotOptions:
    """Options for a robot that is a file."""

    tip: str = ""
    """For a robot's file: the link, or site, whose origin is the end-point; by default the
    likeliest."""
    pose: Repeated = ()
    """For a robot's file: where a joint stands at home, as joint=value in rad or m; repeat for
    more. By default a pose is chosen."""
    lock: Repeated = ()
    """For a robot's file: a joint that does not move, as joint=value; repeat for more."""
    armature: float = 0.0
    """For a robot's file: inertia of the motors as seen at the joints, in kg m², which URDF leaves
    out."""
    density: float | None = None
    """For a robot's file without masses: density of its links, in kg/m³; 1000 by default."""
    mass: float | None = None
    """For a robot's file without masses: mass of all that moves, in kg, instead of a density."""
    package: Repeated = ()
    """For a robot's file: the folder of a package with meshes, as NAME=FOLDER; repeat for more."""

    def entry_of(self, robot: str) -> RobotEntry:
        """The robot of this name, or one from a file, which is added to the catalogue.

        Raises:
            ValueError: see `name_of`, or there is no such robot.
        """
        from onpath.models.systems.catalogue import robot_named

        return robot_named(self.name_of(robot))

    def name_of(self, robot: str) -> str:
        """The name of a robot in the catalogue: the one given, or that of a file, which is added.

        Raises:
            ValueError: the file is refused, or there are options for a file, but no file.
        """
        (name,) = self.names_of([robot])
        return name

    def names_of(self, robots: Sequence[str]) -> list[str]:
        """The names of several robots, as `name_of`; the options are those of every file.

        Raises:
            ValueError: see `name_of`.
        """
        from onpath.app.common.robot_places import is_from_file  # slow to import

        if self != NO_OPTIONS and not any(map(is_from_file, robots)):
            *others, last = (f"--{option.name}" for option in fields(self))
            raise ValueError(f"{', '.join(others)} and {last} need --robot FILE")
        return [self._added(robot) if is_from_file(robot) else robot for robot in robots]

    def _added(self, robot: str) -> str:
        """The name of the robot of a file, which is added."""
        from onpath.app.notebook.robot import robot as robot_from

        entry = robot_from(
            robot,
            tip=self.tip,
            pose=_numbers("--pose", self.pose),
            lock=_numbers("--lock", self.lock),
            armature=self.armature,
            density=self.density,
            mass=self.mass,
            packages=_folders(self.package),
        )
        return entry.name


NO_OPTIONS = RobotOptions()
FileOptions = Annotated[RobotOptions, tyro.conf.arg(name="")]


def _numbers(option: str, pairs: tuple[str, ...]) -> dict[str, float]:
    numbers = dict[str, float]()
    for name, text in assignments(pairs, option, "joint=value").items():
        try:
            numbers[name] = float(text)
        except ValueError:
            raise ValueError(f"{option} {name}={text}: expected a number") from None
    return numbers


def _folders(pairs: tuple[str, ...]) -> dict[str, Path]:
    folders = {
        n: Path(text).expanduser()
        for n, text in assignments(pairs, "--package", "NAME=FOLDER").items()
    }
    for name, folder in folders.items():
        if not folder.is_dir():
            raise ValueError(f"--package {name}={folder}: there is no such folder")
    return folders
