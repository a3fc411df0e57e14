"""The log of a real arm as a trajectory along a path, to be shown on the axes of simulated runs."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import casadi as ca
import numpy as np

from onpath.models.arrays import Array
from onpath.models.closed_loop.trajectory import Trajectory
from onpath.models.errors import CodedError
from onpath.models.paths.curves import Curve
from onpath.models.paths.distance import closest_parameters, drawn_distance
from onpath.models.studies.experiments import Experiment
from onpath.models.studies.linear_model import MotionRecord
from onpath.models.studies.record_file import log_columns, read_records
from onpath.models.systems.law_parameters import LEVEL_SET
from onpath.models.systems.rows import Rows

LOG = "log"
"""In the place of a control law's name."""


def log_motion(record: MotionRecord, experiment: Experiment) -> Trajectory:
    """The end-point of a log, and where it is on the path of an experiment.

    y = h(q) and y' = J v are those of the experiment's robot. θ is that of the closest point of the
    path. With g = z - σ(θ), in the plane of the path,

        θ' = σ' · z' / (|σ'|² - g · σ''),    ξ₁ = (σ₁' g₂ - σ₂' g₁) / |σ'|,

    the distance with its sign. On a path that leaves its plane, these two are NaN, and ξ₁ is NaN,
    too, where the law of the experiment takes a level set for it.

    Args:
        record: of the same robot. Its time begins at 0.

    Returns:
        With the fields q, v, y, u, force, theta, theta_rate and xi, (n, 1).
    """
    robot, curve = experiment.robot(), experiment.curve()
    system, frame = robot.system, robot.frame
    y_rate = ca.jtimes(system.output, system.q, system.v)
    inputs = [system.q, system.v, system.parameters]
    moving = Rows(inputs, ca.vertcat(system.output, y_rate))
    place, rate = np.split(
        moving(record.q, record.v, robot.plant(experiment.parameters)), 2, axis=1
    )
    theta = closest_parameters(frame, curve, place)
    z = frame.planar(place)
    moved = frame.planar(rate) - frame.planar(np.zeros_like(rate))
    if curve.dimension == 3:
        along, xi = np.full(len(theta), np.nan), np.full(len(theta), np.nan)
    else:
        along, xi = _on_path(curve, theta, z, moved)
    if experiment.parameters.across == LEVEL_SET:
        xi = np.full(len(theta), np.nan)
    speed = along * np.linalg.norm(curve.at(theta, 1), axis=1)
    motion = {"q": record.q, "v": record.v, "y": place, "u": record.u, "force": record.force}
    on_path = {"theta": theta, "theta_rate": along, "xi": xi}
    return Trajectory(
        law=LOG,
        t=np.arange(len(theta), dtype=float) * record.dt,
        fields=motion | {name: values[:, None] for name, values in on_path.items()},
        distance=drawn_distance(frame, curve, place, theta),
        speed=speed,
        held=np.zeros(len(theta), dtype=np.bool_),
        label=LOG,
    )


def read_motions(
    file: Path,
    experiment: Experiment,
    columns: Mapping[str, str | int],
    units: Mapping[str, str | float],
) -> list[Trajectory]:
    """`log_motion` of each part of a file, which begins at 0.

    Args:
        columns, units: see `log_columns`; without either it is a file of OnPath.

    Raises:
        CodedError: the file is refused; the message names it, and line and column.
        OSError: the file cannot be read.
    """
    robot = experiment.robot()
    log = log_columns(robot, columns, units) if columns or units else None
    try:
        records = read_records(file, robot, log)
    except CodedError as error:
        raise CodedError("error.in_file", file=str(file), reason=error.message) from None
    return [log_motion(record, experiment) for _, record in records]


def _on_path(curve: Curve, theta: Array, z: Array, z_rate: Array) -> tuple[Array, Array]:
    """θ' and ξ₁ of points whose closest parameters are θ, (n,) each."""
    gap, first, second = z - curve.at(theta), curve.at(theta, 1), curve.at(theta, 2)
    slope = (first**2).sum(1) - (gap * second).sum(1)
    across = first[:, 0] * gap[:, 1] - first[:, 1] * gap[:, 0]
    return (first * z_rate).sum(1) / slope, across / np.linalg.norm(first, axis=1)
