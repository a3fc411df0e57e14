"""Identification of the controllers' model from the right robot's recent motion."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from itertools import groupby

import numpy as np

from onpath.app.lab.segments import Drive, HistoryCopy, Segment
from onpath.lessons.words import Words
from onpath.models.arrays import Array
from onpath.models.closed_loop.loop_kind import Kind
from onpath.models.closed_loop.loop_vectors import loop_layouts
from onpath.models.closed_loop.loops import InterpretedLoop
from onpath.models.closed_loop.simulation import kernel_of
from onpath.models.control.settable import changed, specs
from onpath.models.control.sides import RIGHT
from onpath.models.errors import CodedError
from onpath.models.studies.identification import (
    BALANCE,
    DRY,
    INERTIA,
    Identified,
    JointRecord,
    joint_torques,
    simplest,
    smooth_velocities,
)
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.parameters import Parameters
from onpath.models.systems.robots import BalancedLinkage, Robot

MOST_TICKS = 3000  # maximum ticks to use
MEASURED = RIGHT  # the side whose record is used; any would do, under any law
# settings of the plant and its sensors; while they are unchanged, the robot is the same
PLANT = ("plant", "coulomb", "stiction", "encoder_step", "sensor_noise")
UNITS = {"M": "kg m²", "b": "N m s", "c": "N m", "G": "N m"}
POOR = 0.05  # unexplained share of the torque above which the report warns


@dataclass(frozen=True, slots=True)
class Learned:
    """What was learned about a robot.

    Attributes:
        robot: the robot at that time.
        model: the estimates.
        seconds: duration of the data, [s].
    """

    robot: Robot
    model: Identified
    seconds: float

    def believed(self, parameters: Parameters) -> Parameters:
        """These parameters with the controllers' model as identified."""
        linkage = ROBOTS[self.robot.name].linkage
        return parameters if linkage is None else believing(linkage, parameters, self.model)

    def report(self, before: Parameters, words: Words) -> str:
        """What was identified, applied and left out, for the user.

        Args:
            before: the parameters until now.
        """
        return _sentence(self, before, self.believed(before), words)


def learn(robot: Robot, history: HistoryCopy) -> Learned:
    """Identify the model from the right robot's last seconds.

    Raises:
        ValueError: unsuitable robot, no data, or insufficient excitation.
    """
    if ROBOTS[robot.name].linkage is None:
        raise CodedError("identified.other_robot")
    record = last_record(robot, history.latest(MOST_TICKS))
    return Learned(robot, simplest(record), len(record.q) * record.dt)


def last_record(robot: Robot, history: list[Segment]) -> JointRecord:
    """Sensor data of the right robot's last seconds, while the robot was as it is now.

    Raises:
        ValueError: there is no data, or the robot is not a balanced linkage.
    """
    linkage, segments = ROBOTS[robot.name].linkage, _same_robot(robot, history)
    if linkage is None or not segments:
        raise CodedError("error.nothing_recorded")
    drive, dt = segments[-1].drives[MEASURED], segments[-1].dt
    log = loop_layouts(robot.system, drive.kind).log.unpack(_rows(robot, segments))
    q, v = log["q"], log["v"]
    torque = log["u"] + joint_torques(q, log["force"], linkage.l1, linkage.l4)
    if drive.kind.encoder:
        step = float(_setting(robot, drive, "encoder_step")[0])
        q = step * np.floor(q / step + 0.5)
        v = smooth_velocities(q, dt)
    return JointRecord(dt, q, v, torque)


def believing(linkage: BalancedLinkage, parameters: Parameters, found: Identified) -> Parameters:
    """The parameters with the controllers' model as identified, limited to the sliders' ranges."""
    built, known = linkage.built, specs(parameters)
    for name in (f"error_{name}" for name in INERTIA):
        spec, inertia = known[name], name.removeprefix("error_")
        error = round(100 * (found.values[inertia] / built[inertia] - 1), 2)
        parameters = changed(parameters, name, min(max(error, spec.low), spec.high))
    return parameters


def _same_robot(robot: Robot, history: list[Segment]) -> list[Segment]:
    """The latest segments without a stop or a change of the plant or its sensors."""
    found, ticks = list[Segment](), 0
    for segment in reversed(history):
        ticks += segment.ticks
        later = found[-1] if found else segment
        drive, next_drive = segment.drives[MEASURED], later.drives[MEASURED]
        if ticks > MOST_TICKS or drive.frozen or segment.dt != later.dt:
            break
        if not _alike(robot, drive, next_drive):
            break
        found.append(segment)
    return found[::-1]


def _alike(robot: Robot, one: Drive, other: Drive) -> bool:
    if one.settings is other.settings:
        return True
    return one.kind.encoder == other.kind.encoder and all(
        np.array_equal(_setting(robot, one, name), _setting(robot, other, name)) for name in PLANT
    )


def _setting(robot: Robot, drive: Drive, name: str) -> Array:
    return drive.settings[loop_layouts(robot.system, drive.kind).settings.slices[name]]


def _rows(robot: Robot, segments: list[Segment]) -> Array:
    """Recompute the right robot's log rows, in one call for segments with the same inputs."""
    rows = list[Array]()
    runs = groupby(segments, lambda s: (s.drives[MEASURED].settings.tobytes(), id(s.curve)))
    for _, group in runs:
        members = list(group)
        drive, table = members[0].drives[MEASURED], members[0].curve.table()
        ticks = sum(member.ticks for member in members)
        loop = _loop(robot, drive.kind)
        rows.append(loop.run(drive.state, drive.settings, table, ticks)[1])
    return np.concatenate(rows)


@lru_cache(maxsize=4)
def _loop(robot: Robot, kind: Kind) -> InterpretedLoop:
    """A loop for the identification thread only."""
    return InterpretedLoop(kernel_of(robot, kind))


def _sentence(learned: Learned, before: Parameters, after: Parameters, words: Words) -> str:
    """Report of what was identified, applied and left out."""
    robot, model, duration = learned.robot, learned.model, learned.seconds
    believed = dict(zip(robot.system.parameter_names, robot.model(before), strict=True))
    values = "; ".join(
        words("identified.value", value=_value(model, name, words), before=f"{believed[name]:.4f}")
        for name in INERTIA
    )
    text = words("identified.found", seconds=f"{duration:.1f}", values=values)
    limited = [name for name in INERTIA if _at_end(after, name)]
    if limited:
        text += words("identified.limited", names=words("identified.and").join(limited))
    further = [name for name in (*DRY, *BALANCE) if _matters(model, name)]
    if further:
        values = ", ".join(_value(model, name, words) for name in further)
        text += words("identified.also", values=values)
    if model.unexplained > POOR:
        text += words("identified.unexplained", percent=f"{100 * model.unexplained:.0f}")
    return text


def _value(found: Identified, name: str, words: Words) -> str:
    """For instance "M11 = 0.0226 (±0.0001) kg m²"; errors are rounded up."""
    error = math.ceil(found.errors[name] * 1e4 - 1e-3) / 1e4
    numbers = f"{found.values[name]:.4f} (±{max(error, 1e-4):.4f})"
    return f"{name} = {words.written(numbers)} {UNITS[name[0]]}"


def _at_end(parameters: Parameters, name: str) -> bool:
    spec = specs(parameters)[f"error_{name}"]
    return getattr(parameters, f"error_{name}") in (spec.low, spec.high)


def _matters(found: Identified, name: str) -> bool:
    value = abs(found.values.get(name, 0.0))
    return value > 5e-4 and value > 2 * found.errors[name]
