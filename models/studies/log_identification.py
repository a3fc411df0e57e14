"""Identification of a robot from a file of OnPath or the log of a real arm."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from onpath.models.arrays import Array
from onpath.models.errors import CodedError
from onpath.models.studies.exciting_motion import ExcitingMotion, exciting_motion
from onpath.models.studies.identification import SHORTEST
from onpath.models.studies.linear_model import MotionRecord, linear_model
from onpath.models.studies.link_estimate import LinkEstimate, link_estimate
from onpath.models.studies.parameter_estimate import Estimate, estimate, unexplained_of
from onpath.models.studies.record_file import LogColumns, log_columns, read_records
from onpath.models.systems.link_parameters import scaled_system
from onpath.models.systems.parameter_specs import unknown_name
from onpath.models.systems.parameters import TICK, Parameters, declared
from onpath.models.systems.robots import Robot, RobotEntry
from onpath.models.systems.system import MechanicalSystem


@dataclass(frozen=True, slots=True, eq=False)
class FileEstimate:
    """The parameters of a robot that were identified from a file.

    Attributes:
        robot: its name.
        coordinates: names of its coordinates.
        laws: whose rows were used; empty if the file has no laws.
        seconds: of motion.
        measured: whether the angles are sensor readings.
        estimate: of the parameters and the delay.
        motion: a motion that would identify what the file does not, or None.
        centre: mean of the coordinates, (n,).
        fastest: largest rate of each coordinate, (n,).
        others: share of the torque that the estimate does not explain in other files, by name.
        links: what the file tells of the robot's links, if that was asked for.
    """

    robot: str
    coordinates: tuple[str, ...]
    laws: tuple[str, ...]
    seconds: float
    measured: bool
    estimate: Estimate
    motion: ExcitingMotion | None
    centre: Array
    fastest: Array
    others: Mapping[str, float]
    links: LinkEstimate | None = None

    @property
    def settings(self) -> dict[str, float]:
        """Settings with which a robot is simulated with this friction and delay.

        `coulomb` is the mean of the motors' dry friction. `delay` is that of torques that were
        logged before they acted, in control intervals: of 1 ms or, if it is too long for these, of
        `control_rate`. Torques that were logged late say nothing of the controller.
        """
        dry = [each.value for each in self.estimate.found if each.is_dry_friction]
        late = self.estimate.delay
        found = {"coulomb": max(sum(dry) / len(dry), 0.0)} if dry else {}
        if late is not None and late.high < 0:
            found |= _delay_settings(-late.value)
        return {name: float(f"{value:.4g}") for name, value in found.items()}


def _delay_settings(delay: float) -> dict[str, float]:
    """A delay, [s], in intervals of the fastest control rate up to 1 kHz at which it can be set."""
    known = declared(Parameters)
    rates = [rate for rate in known["control_rate"].options if rate <= 1 / TICK]
    rate = max(rate for rate in rates if delay * rate <= known["delay"].high)
    return {"delay": delay * rate} | ({} if rate == 1 / TICK else {"control_rate": rate})


def identified_system(entry: RobotEntry) -> tuple[MechanicalSystem, Array]:
    """The system whose parameters are estimated, and the numbers for its geometry.

    It is that of the robot; of a chain, `scaled_system`.
    """
    if entry.source is not None:
        system = scaled_system(entry.source)
        return system, np.zeros(len(system.parameter_names))
    robot = entry.make(entry.parameters())
    return robot.system, robot.plant(entry.parameters())


def identify_file(
    path: Path,
    entry: RobotEntry,
    law: str = "",
    columns: Mapping[str, str | int] | None = None,
    units: Mapping[str, str | float] | None = None,
    others: Sequence[Path] = (),
    *,
    links: bool = False,
) -> FileEstimate:
    """Estimate a robot's parameters.

    Args:
        entry: the robot; of its parameters, only those on which h and B depend are used.
        law: use only the rows of this law; "": all.
        columns, units: see `log_columns`; without either it is a file of OnPath.
        others: files of the same form, whose torques the estimate is to explain, too.
        links: whether to estimate the base parameters of each link, too.

    Raises:
        ValueError: the robot is not suitable, the file is refused, or its motion is too short.
        OSError: the file cannot be read.
    """
    robot = entry.make(entry.parameters())
    system, geometry = identified_system(entry)
    linear_model(system)  # refuse an unsuitable robot before reading
    if links and entry.source is None:
        raise CodedError("error.no_links", robot=entry.name)
    log = log_columns(robot, columns or {}, units or {}) if columns or units else None
    laws, used = _records(path, robot, log, law)
    result = estimate(system, used, geometry)
    sums = (name for each in result.found for name, _ in each.others)
    names = (*(each.name for each in result.found), *sums, *result.unexcited)
    return FileEstimate(
        robot=entry.name,
        coordinates=tuple(robot.system.coordinate_names),
        laws=tuple(name for name in laws if name),
        seconds=sum(len(each.q) * each.dt for each in used),
        measured=all(each.measured for each in used),
        estimate=result,
        motion=exciting_motion(system, used, geometry, names),
        centre=np.mean(np.concatenate([each.q for each in used]), axis=0),
        fastest=np.max([np.abs(each.v).max(axis=0) for each in used], axis=0),
        others={
            str(each): unexplained_of(system, result, _records(each, robot, log, law)[1], geometry)
            for each in others
        },
        links=link_estimate(entry.source, used) if links and entry.source else None,
    )


def _records(
    path: Path, robot: Robot, log: LogColumns | None, law: str
) -> tuple[list[str], list[MotionRecord]]:
    """The laws of a file whose rows are used, and their records.

    Raises:
        ValueError, OSError: see `identify_file`.
    """
    try:
        records = read_records(path, robot, log)
    except CodedError as error:
        raise CodedError("error.in_file", file=str(path), reason=error.message) from None
    known = list(dict.fromkeys(name for name, _ in records))
    if law and known == [""]:
        raise CodedError("error.record_without_laws", law=law, file=str(path))
    laws = [name for name in known if law in ("", name)]
    if not laws:
        raise unknown_name(law, known, "law")
    used = [each for name, each in records if name in laws]
    return laws, [each for each in used if len(each.q) * each.dt >= SHORTEST] or used
