"""Captures the set-up of a simulation as data."""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from typing import Any

import numpy as np

from onpath.app.common.robot_files import given_file
from onpath.app.lab.robot_settings import RobotSettings
from onpath.app.lab.setups.setup import (
    DRAWING,
    DRAWN,
    EDITED,
    LONGEST_WORD,
    UNIT,
    Path,
    RobotSetup,
    Setup,
)
from onpath.app.lab.simulation import Simulation
from onpath.models.closed_loop.lab_settings import Kept, LabSettings, settings_kept
from onpath.models.control.settable import specs, values_of
from onpath.models.control.sides import DEFAULT_LAWS
from onpath.models.paths.curves import SeriesCurve
from onpath.models.paths.path_design import PathDesign
from onpath.models.paths.spline_curves import SplineCurve
from onpath.models.paths.spline_fit import DECIMALS
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.parameter_specs import NOTHING, Spec
from onpath.models.systems.parameters import Parameters

DIGITS = 6


def capture(simulation: Simulation) -> Setup:
    """The current set-up of a simulation; a path being dragged counts only after the drag."""
    robots = {**simulation.earlier, simulation.entry.name: simulation.robot_settings()}
    captured = {
        name: _captured(name, settings, simulation.presets)
        for name, settings in sorted(robots.items())
    }
    chosen = simulation.chosen_laws.items()
    return Setup(
        robot=simulation.entry.name,
        robots={name: robot for name, robot in captured.items() if robot != RobotSetup()},
        laws={side: law for side, law in chosen if law != DEFAULT_LAWS[side]},
        settings=dict(own_differences(simulation.settings, "code")),
    )


def _captured(name: str, settings: RobotSettings, paths: Mapping[str, PathDesign]) -> RobotSetup:
    """The set-up of one robot."""
    editor, given = settings.editor, given_file(name)
    return RobotSetup(
        parameters=dict(_differences(name, settings.parameters)),
        path=capture_path(editor.design, paths) if editor else Path(),
        settings=dict(own_differences(settings.own, "code", of_robot=True)),
        file="" if given is None else _plain_name(given.file.name),
        tip="" if given is None else _plain_name(given.tip),
    )


def _plain_name(name: str) -> str:
    """A name as it can be typed; "" for one that cannot be told in a line."""
    return name if len(name) <= LONGEST_WORD and name.isprintable() else ""


@lru_cache(maxsize=256)  # every lab is captured once a second
def own_differences(
    settings: LabSettings, where: Kept, of_robot: bool = False
) -> dict[str, int | float | str]:
    """The values of `settings_kept` that differ from a new lab's."""
    known = settings_kept(where, of_robot)
    values = {name: kept(each.spec, getattr(settings, name)) for name, each in known.items()}
    return {name: value for name, value in values.items() if value != known[name].default}


@lru_cache(maxsize=256)
def _differences(robot: str, parameters: Parameters) -> dict[str, int | float | str]:
    """The parameters that differ from those of a new lab with this robot."""
    defaults, differing = values_of(ROBOTS[robot].parameters()), dict[str, int | float | str]()
    known = specs(parameters)
    for name, value in values_of(parameters).items():
        spec, default = known[name], defaults[name]
        if value != default and kept(spec, value) != default:
            differing[name] = kept(spec, value)
    return differing


def kept(spec: Spec, value: Any) -> int | float | str:
    """A parameter's value in the form stored in a set-up."""
    return value if spec.options else min(max(_rounded(value), spec.low), spec.high)


def _rounded(value: float) -> float:
    return 0.0 if abs(value) <= NOTHING else float(f"{value:.{DIGITS}g}")


def capture_path(design: PathDesign, paths: Mapping[str, PathDesign]) -> Path:
    """Convert a path to data, given the presets."""
    if design.name in paths:
        return Path(design.name)
    curve, closed = design.curve, design.curve.closed
    if isinstance(curve, SplineCurve):
        beginning = np.zeros((2, 2))
        return Path(
            name=DRAWING,
            closed=closed,
            numbers=_lengths(np.diff(curve.points, n=2, axis=0, prepend=beginning)),
            raised=tuple(round(end * 10**DECIMALS) for link in curve.raised for end in link),
            duration=round(curve.duration * 10**DECIMALS),
        )
    if design.name == EDITED:
        return Path(EDITED, closed, _lengths(design.points))
    assert isinstance(curve, SeriesCurve)
    return Path(DRAWN, closed, _lengths(curve.terms()))


def _lengths(z: np.ndarray) -> tuple[int, ...]:
    return tuple(int(n) for n in np.rint(z / UNIT).ravel())
