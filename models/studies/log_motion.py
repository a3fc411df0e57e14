"""The log of a real arm as a trajectory along a path, to be shown on the axes of simulated runs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from onpath.models.arrays import Array
from onpath.models.closed_loop.trajectory import Trajectory
from onpath.models.errors import CodedError
from onpath.models.paths.curves import Curve
from onpath.models.paths.distance import closest_parameters, drawn_distance
from onpath.models.paths.frames import Frame
from onpath.models.studies.experiments import Experiment
from onpath.models.studies.linear_model import MotionRecord
from onpath.models.studies.record_file import log_columns, read_records
from onpath.models.systems.law_parameters import LEVEL_SET
from onpath.models.systems.robots import Robot
from onpath.models.systems.rows import Rows

LOG = "log"
"""In the place of a control law's name."""


@dataclass(frozen=True, slots=True, eq=False)
class LoggedMotion:
    """The motion of an end-point as an arm has logged it. A row of NaN stands for each gap.

    Attributes:
        t: time of each row, from 0 on, (rows,), [s].
        y, y_rate: end-point and its velocity, shape (rows, p), [m] and [m/s].
        u: torque of the motors until the next row, (rows, m), [N m].
        force: on the end-point, likewise, (rows, p), [N].
    """

    t: Array
    y: Array
    y_rate: Array
    u: Array
    force: Array


def logged_motion(records: Sequence[MotionRecord], robot: Robot, plant: Array) -> LoggedMotion:
    """The motion of the end-point: y = h(q) and y' = J v.

    Args:
        records: of the same robot, in the order of time, with gaps between them.
        plant: the robot's parameters.
    """
    system = robot.system
    y_rate = ca.jtimes(system.output, system.q, system.v)
    inputs = [system.q, system.v, system.parameters]
    moving = Rows(inputs, ca.vertcat(system.output, y_rate))
    parts = list[LoggedMotion]()
    for record in records:
        place, rate = np.split(moving(record.q, record.v, plant), 2, axis=1)
        t = record.start + record.dt * np.arange(len(place), dtype=float)
        parts.append(LoggedMotion(t=t, y=place, y_rate=rate, u=record.u, force=record.force))
    return _joined(parts)


def thinned(motion: LoggedMotion, most: int, least_step: float) -> LoggedMotion:
    """The same motion in at most `most` rows, `least_step` seconds apart or more.

    Each part between gaps has two rows at least; what is too much then is left out at the end.
    Torques and forces are the means over the longer steps.
    """
    parts = _parts(motion)
    seconds = sum(_length(part) for part in parts)
    step = max(least_step, seconds / max(most - len(parts), 1))
    return _rows(_joined([_with_steps(part, step) for part in parts]), slice(most))


def _with_steps(motion: LoggedMotion, step: float) -> LoggedMotion:
    """A motion without a gap in longer steps: two or more of them."""
    rows, seconds = len(motion.t), _length(motion)
    count = max(int(seconds / step + 1e-9), 2)
    if count >= rows:
        return motion
    step = min(step, seconds / count)
    ends: Array = np.linspace(0.0, seconds, rows + 1)
    edges: Array = step * np.arange(count + 1, dtype=float)

    def at(values: Array) -> Array:
        return _columns([np.interp(edges[:-1], ends[:-1], each) for each in values.T])

    def means(values: Array) -> Array:
        sums = np.concatenate([np.zeros((1, values.shape[1])), np.cumsum(values, axis=0)])
        whole = _columns([np.interp(edges, ends, ends[1] * each) for each in sums.T])
        return np.asarray((whole[1:] - whole[:-1]) / step, dtype=float)

    return LoggedMotion(
        t=motion.t[0] + edges[:-1],
        y=at(motion.y),
        y_rate=at(motion.y_rate),
        u=means(motion.u),
        force=means(motion.force),
    )


def _length(motion: LoggedMotion) -> float:
    """From the first row of a motion without a gap to a step after the last one, [s]."""
    rows = len(motion.t)
    return float(motion.t[-1] - motion.t[0]) * rows / max(rows - 1, 1)


def _parts(motion: LoggedMotion) -> list[LoggedMotion]:
    """What is between the gaps."""
    gaps = np.flatnonzero(np.isnan(motion.y).any(axis=1)).tolist()
    ends = zip([-1, *gaps], [*gaps, len(motion.t)], strict=True)
    return [_rows(motion, slice(before + 1, after)) for before, after in ends]


def _joined(parts: Sequence[LoggedMotion]) -> LoggedMotion:
    """Motions one after another, with a row of NaN in the middle of each gap."""
    pieces = [parts[0]]
    for before, after in pairwise(parts):
        unknown = LoggedMotion(**{name: np.nan * x[:1] for name, x in _arrays(after).items()})
        middle = (before.t[-1:] + after.t[:1]) / 2
        pieces += [replace(unknown, t=middle), after]
    each = [_arrays(piece) for piece in pieces]
    return LoggedMotion(**{name: np.concatenate([x[name] for x in each]) for name in each[0]})


def _rows(motion: LoggedMotion, chosen: slice) -> LoggedMotion:
    return LoggedMotion(**{name: x[chosen] for name, x in _arrays(motion).items()})


def _arrays(motion: LoggedMotion) -> dict[str, Array]:
    return {field.name: getattr(motion, field.name) for field in fields(motion)}


def _columns(columns: Sequence[Any]) -> Array:
    return np.array(columns, dtype=float).T


def along_path(
    motion: LoggedMotion, frame: Frame, curve: Curve, *, level_set: bool = False
) -> dict[str, Array]:
    """Where a logged motion is on a path, by name as in a `Trajectory`.

    θ is that of the closest point of the path. With g = z - σ(θ), in the plane of the path,

        θ' = σ' · z' / (|σ'|² - g · σ''),    ξ₁ = (σ₁' g₂ - σ₂' g₁) / |σ'|,

    the distance with its sign. On a path that leaves its plane, these two are NaN.

    Args:
        level_set: whether ξ₁ is meant to be one; it is NaN then.

    Returns:
        distance, speed, theta, theta_rate and xi, shape (rows,) each; NaN in a gap.
    """
    known: NDArray[np.bool_] = np.asarray(np.isfinite(motion.y).all(axis=1))
    y, y_rate = motion.y[known], motion.y_rate[known]
    theta = closest_parameters(frame, curve, y)
    z = frame.planar(y)
    moved = frame.planar(y_rate) - frame.planar(np.zeros_like(y_rate))
    if curve.dimension == 3:
        along, xi = np.full(len(theta), np.nan), np.full(len(theta), np.nan)
    else:
        along, xi = _on_path(curve, theta, z, moved)
    found = {
        "distance": drawn_distance(frame, curve, y, theta),
        "speed": along * np.linalg.norm(curve.at(theta, 1), axis=1),
        "theta": theta,
        "theta_rate": along,
        "xi": np.full(len(theta), np.nan) if level_set else xi,
    }
    whole = {name: np.full(len(known), np.nan) for name in found}
    for name, values in found.items():
        whole[name][known] = values
    return whole


def log_motion(record: MotionRecord, experiment: Experiment) -> Trajectory:
    """The end-point of a log, and where it is on the path of an experiment; see `along_path`.

    Args:
        record: of the same robot. Its part of the file begins at 0.

    Returns:
        With the fields q, v, y, u, force, theta, theta_rate and xi, (n, 1).
    """
    robot, level_set = experiment.robot(), experiment.parameters.across == LEVEL_SET
    motion = logged_motion([record], robot, robot.plant(experiment.parameters))
    run = log_trajectory(motion, robot.frame, experiment.curve(), level_set=level_set)
    return replace(run, fields={"q": record.q, "v": record.v, **run.fields})


def log_trajectory(
    motion: LoggedMotion, frame: Frame, curve: Curve, *, level_set: bool = False
) -> Trajectory:
    """A logged motion along a path; see `along_path`.

    Returns:
        With the fields y, u, force, theta, theta_rate and xi, (n, 1).
    """
    on_path = along_path(motion, frame, curve, level_set=level_set)
    distance, speed = on_path.pop("distance"), on_path.pop("speed")
    moved = {"y": motion.y, "u": motion.u, "force": motion.force}
    return Trajectory(
        law=LOG,
        t=motion.t,
        fields=moved | {name: values[:, None] for name, values in on_path.items()},
        distance=distance,
        speed=speed,
        held=np.zeros(len(distance), dtype=np.bool_),
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
    records = _records(file, experiment.robot(), columns, units)
    return [log_motion(record, experiment) for _, record in records]


def read_logged(
    file: Path,
    robot: Robot,
    plant: Array,
    columns: Mapping[str, str | int],
    units: Mapping[str, str | float],
) -> LoggedMotion:
    """`logged_motion` of the first part of a file; the arguments are those of `read_motions`."""
    return logged_motion(first_part(_records(file, robot, columns, units)), robot, plant)


def first_part(records: Sequence[tuple[str, MotionRecord]]) -> list[MotionRecord]:
    """The records of the first law and robot in a file, with gaps between them.

    Args:
        records: with their laws, as `read_records` gives them.
    """
    part, end = list[MotionRecord](), 0.0
    for law, record in records:
        if law != records[0][0] or record.start < end:  # another robot's begins at 0 again
            break
        part.append(record)
        end = record.start + len(record.q) * record.dt
    return part


def _records(
    file: Path,
    robot: Robot,
    columns: Mapping[str, str | int],
    units: Mapping[str, str | float],
) -> list[tuple[str, MotionRecord]]:
    log = log_columns(robot, columns, units) if columns or units else None
    try:
        return read_records(file, robot, log)
    except CodedError as error:
        raise CodedError("error.in_file", file=str(file), reason=error.message) from None


def _on_path(curve: Curve, theta: Array, z: Array, z_rate: Array) -> tuple[Array, Array]:
    """θ' and ξ₁ of points whose closest parameters are θ, (n,) each."""
    gap, first, second = z - curve.at(theta), curve.at(theta, 1), curve.at(theta, 2)
    slope = (first**2).sum(1) - (gap * second).sum(1)
    across = first[:, 0] * gap[:, 1] - first[:, 1] * gap[:, 0]
    return (first * z_rate).sum(1) / slope, across / np.linalg.norm(first, axis=1)
