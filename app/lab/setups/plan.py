"""The robots of a set-up in the form that a simulation uses, after all checks of names and
numbers."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import msgspec
import numpy as np

from onpath.app.common.robot_files import to_type
from onpath.app.lab.setups.setup import (
    DRAWING,
    DRAWN,
    EDITED,
    LONGEST_WORD,
    UNIT,
    Path,
    RobotSetup,
    Setup,
    plain,
)
from onpath.models.closed_loop.lab_settings import Kept, LabSettings, changed_setting, settings_kept
from onpath.models.closed_loop.simulation import raised
from onpath.models.closed_loop.start import ON_PATH, check_start
from onpath.models.control.settable import changed
from onpath.models.control.sides import checked_laws
from onpath.models.errors import CodedError, Message
from onpath.models.path_files.placing import LARGEST
from onpath.models.paths.curve_faults import curve_faults
from onpath.models.paths.curve_fit import closed_through, control_points, open_through
from onpath.models.paths.curves import Curve, from_terms, terms_of
from onpath.models.paths.drawing_design import from_curve
from onpath.models.paths.path_design import MOST_POINTS, REACH, PathDesign, presets
from onpath.models.paths.spline_curves import GRAIN, SplineCurve
from onpath.models.paths.spline_fit import DECIMALS
from onpath.models.robot_files.xml_elements import shown
from onpath.models.systems.catalogue import ROBOTS, RobotEntry
from onpath.models.systems.parameter_specs import NOTHING, unknown_name
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
    own: LabSettings

    @property
    def path_faults(self) -> tuple[Message, ...]:
        """Why the robot cannot follow its path; empty if it can."""
        return tuple(fault.reason for fault in curve_faults(self._robot.margin, self._path))

    def check_start(self) -> None:
        """Refuse a start that is not possible; see `models.closed_loop.start.check_start`."""
        if self.own.start != ON_PATH:
            check_start(self._robot, self._path, self.parameters, self.own.start)

    @property
    def _robot(self) -> Robot:
        return self.entry.make(self.parameters)

    @property
    def _path(self) -> Curve:
        return raised(self.design.curve, self.parameters)


def planned(setup: Setup) -> dict[str, Wanted]:
    """The robots of a set-up, by name; does not check whether a robot can follow its path.

    Raises:
        ValueError: an unknown name, a number out of range, points that do not form a path, or a
            law that does not suit the robot.
    """
    msgspec.convert(plain(setup), Setup)  # a set-up made in Python has not been validated
    own_settings(setup.settings)
    robots = dict(setup.robots)
    robots.setdefault(setup.robot, RobotSetup())
    wanted = {name: wanted_robot(name, robot) for name, robot in robots.items()}
    checked_laws(setup.laws, wanted[setup.robot].entry)
    return wanted


def wanted_robot(name: str, robot: RobotSetup) -> Wanted:
    """One robot of a set-up; see `planned`."""
    if is_absent(name):
        file, tip = (shown(text, LONGEST_WORD) for text in (robot.file, robot.tip))
        raise CodedError("robot_file.absent_robot", name=name, line=to_type(file, tip))
    if name not in ROBOTS:
        raise unknown_name(name, list(ROBOTS), "robot")
    parameters = ROBOTS[name].parameters()
    for field, value in robot.parameters.items():
        tiny = isinstance(value, float) and abs(value) <= NOTHING
        parameters = changed(parameters, field, 0.0 if tiny else value)
    return Wanted(
        entry=ROBOTS[name],
        parameters=parameters,
        design=_design(robot.path, presets(ROBOTS[name].radius)),
        own=own_settings(robot.settings, of_robot=True),
    )


def is_absent(robot: str) -> bool:
    """Whether a name is that of a robot from a file, and this process was not given the file."""
    return robot not in ROBOTS and _FROM_FILE.fullmatch(robot) is not None


def own_settings(
    values: Mapping[str, Any], where: Kept = "code", of_robot: bool = False
) -> LabSettings:
    """The lab's own settings with some values.

    Args:
        where, of_robot: see `settings_kept`; other settings are refused.

    Raises:
        ValueError: an unknown name or a bad value.
    """
    settings = LabSettings()
    known = settings_kept(where, of_robot)
    for name, value in values.items():
        if name not in known:
            raise unknown_name(name, list(known), "setting")
        settings = changed_setting(settings, name, value)
    return settings


def _design(path: Path, paths: Mapping[str, PathDesign]) -> PathDesign:
    if path.name not in (EDITED, DRAWN, DRAWING):
        if path.name not in paths:
            raise unknown_name(path.name, [*paths, EDITED, DRAWN, DRAWING], "path")
        if path.numbers:
            raise CodedError("error.path_takes_no_numbers", name=repr(path.name))
        return paths[path.name]
    if len(path.numbers) % 2:
        raise CodedError("error.half_a_point")
    if path.name == DRAWING:
        return from_curve(_drawing(path))
    z = UNIT * np.array(path.numbers, dtype=float).reshape(-1, 2)
    if path.name == EDITED:
        if not 2 <= len(z) <= MOST_POINTS or np.abs(z).max(initial=0.0) > REACH + UNIT / 2:
            raise CodedError("error.points_out_of_bounds", most=MOST_POINTS, reach=f"{REACH:g}")
        return PathDesign(EDITED, (closed_through if path.closed else open_through)(z), z)
    if len(z) != terms_of(path.closed):
        raise CodedError("error.coefficients", wanted=terms_of(path.closed), count=len(z))
    curve = from_terms(path.closed, z)
    return PathDesign(DRAWN, curve, control_points(curve, DRAWN_POINTS[path.closed]))


def _drawing(path: Path) -> SplineCurve:
    """The curve of a drawing, to the last bit of the one that was captured.

    Raises:
        ValueError: the numbers are not those of a drawing.
    """
    points = np.array(path.numbers, dtype=int).reshape(-1, 2).cumsum(axis=0).cumsum(axis=0)
    ends = [end / 10**DECIMALS for end in path.raised]
    rises = all(a <= b for a, b in pairwise([-np.pi, *ends, np.pi]))
    far = np.abs(points).max(initial=0) > LARGEST / GRAIN
    if far or path.duration == 0 or len(ends) % 2 or not rises:
        raise CodedError("error.no_drawing")
    return SplineCurve(
        path.closed,
        GRAIN * points,
        raised=tuple(zip(ends[::2], ends[1::2], strict=True)),
        duration=path.duration / 10**DECIMALS,
    )
