"""The robots of a set-up in the form that a simulation uses, after all checks of names and
numbers."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import asdict, dataclass

import msgspec
import numpy as np

from onpath.app.lab.setups.setup import (
    DRAWN,
    EDITED,
    EXAGGERATIONS,
    RATES,
    UNIT,
    Path,
    RobotSetup,
    Setup,
    plain,
)
from onpath.models.closed_loop.obstacles import Wall, check_direction
from onpath.models.closed_loop.simulation import raised
from onpath.models.closed_loop.start import ON_PATH, Start, check_start
from onpath.models.control.settable import changed
from onpath.models.control.sides import checked_laws
from onpath.models.errors import CodedError, Message
from onpath.models.paths.curve_faults import curve_faults
from onpath.models.paths.curve_fit import closed_through, control_points, open_through
from onpath.models.paths.curves import Curve, from_terms, terms_of
from onpath.models.paths.path_design import MOST_POINTS, REACH, PathDesign
from onpath.models.systems.catalogue import ROBOTS, RobotEntry
from onpath.models.systems.parameter_specs import NOTHING, out_of_range, unknown_name
from onpath.models.systems.parameters import Parameters
from onpath.models.systems.robots import Robot

_FROM_FILE = re.compile(r"[a-z0-9_]+_[0-9a-f]{8}")  # the name of a `RobotFile`
DRAWN_POINTS = {True: 10, False: 6}  # control points of closed and open strokes, as in `drawn`


@dataclass(frozen=True, slots=True, eq=False)
class Wanted:
    """A robot's set-up in the form that a simulation uses."""

    entry: RobotEntry
    parameters: Parameters
    design: PathDesign
    start: Start = ON_PATH
    wall: Wall | None = None

    @property
    def path_faults(self) -> tuple[Message, ...]:
        """Why the robot cannot follow its path; empty if it can."""
        return tuple(fault.reason for fault in curve_faults(self._robot.margin, self._path))

    def check_start(self) -> None:
        """Refuse a start that is not possible; see `models.closed_loop.start.check_start`."""
        if self.start != ON_PATH:
            check_start(self._robot, self._path, self.parameters, self.start)

    @property
    def _robot(self) -> Robot:
        return self.entry.make(self.parameters)

    @property
    def _path(self) -> Curve:
        return raised(self.design.curve, self.parameters)


def planned(setup: Setup, paths: Mapping[str, PathDesign]) -> dict[str, Wanted]:
    """The robots of a set-up, by name; does not check whether a robot can follow its path.

    Args:
        paths: the presets.

    Raises:
        ValueError: an unknown name, a number out of range, points that do not form a path, or a
            law that does not suit the robot.
    """
    msgspec.convert(plain(setup), Setup)  # a set-up made in Python has not been validated
    _within("speed", setup.rate, RATES)
    _within("exaggeration", setup.exaggeration, EXAGGERATIONS)
    robots = dict(setup.robots)
    robots.setdefault(setup.robot, RobotSetup())
    wanted = {name: wanted_robot(name, robot, paths) for name, robot in robots.items()}
    checked_laws(setup.laws, wanted[setup.robot].entry)
    check_direction(setup.hold)
    return wanted


def wanted_robot(name: str, robot: RobotSetup, paths: Mapping[str, PathDesign]) -> Wanted:
    """One robot of a set-up; see `planned`."""
    if is_absent(name):
        raise CodedError("robot_file.absent_robot", name=name)
    if name not in ROBOTS:
        raise unknown_name(name, list(ROBOTS), "robot")
    parameters = ROBOTS[name].parameters()
    for field, value in robot.parameters.items():
        tiny = isinstance(value, float) and abs(value) <= NOTHING
        parameters = changed(parameters, field, 0.0 if tiny else value)
    if unknown := set(robot.start) - set(asdict(ON_PATH)):
        raise unknown_name(min(unknown), list(asdict(ON_PATH)), "start")
    if len(robot.wall) not in (0, 3):
        raise CodedError("error.half_a_wall")
    start, wall = Start(**robot.start), None
    if robot.wall:
        z1, z2, angle = robot.wall
        wall = Wall(z1, z2, angle)
    return Wanted(
        entry=ROBOTS[name],
        parameters=parameters,
        design=_design(robot.path, paths),
        start=start,
        wall=wall,
    )


def is_absent(robot: str) -> bool:
    """Whether a name is that of a robot from a file, and this process was not given the file."""
    return robot not in ROBOTS and _FROM_FILE.fullmatch(robot) is not None


def _within(what: str, value: float, bounds: tuple[float, ...]) -> None:
    if not bounds[0] <= value <= bounds[-1]:
        raise out_of_range(what, f"{value:g}", f"{bounds[0]:g}", f"{bounds[-1]:g}")


def _design(path: Path, paths: Mapping[str, PathDesign]) -> PathDesign:
    if path.name not in (EDITED, DRAWN):
        if path.name not in paths:
            raise unknown_name(path.name, [*paths, EDITED, DRAWN], "path")
        if path.numbers:
            raise CodedError("error.path_takes_no_numbers", name=repr(path.name))
        return paths[path.name]
    if len(path.numbers) % 2:
        raise CodedError("error.half_a_point")
    z = UNIT * np.array(path.numbers, dtype=float).reshape(-1, 2)
    if path.name == EDITED:
        if not 2 <= len(z) <= MOST_POINTS or np.abs(z).max(initial=0.0) > REACH + UNIT / 2:
            raise CodedError("error.points_out_of_bounds", most=MOST_POINTS, reach=f"{REACH:g}")
        return PathDesign(EDITED, (closed_through if path.closed else open_through)(z), z)
    if len(z) != terms_of(path.closed):
        raise CodedError("error.coefficients", wanted=terms_of(path.closed), count=len(z))
    curve = from_terms(path.closed, z)
    return PathDesign(DRAWN, curve, control_points(curve, DRAWN_POINTS[path.closed]))
