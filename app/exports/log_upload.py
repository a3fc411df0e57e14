"""The log of a real arm that a browser has sent; see upload_reader.py."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path, PurePath
from tempfile import TemporaryDirectory

from onpath.app.channel.file_messages import LogQuantity
from onpath.app.lab.shown_log import ShownLog, shown_log
from onpath.models.errors import Coded, CodedError, Message
from onpath.models.studies.array_file import ENDINGS
from onpath.models.studies.log_guess import guessed_columns
from onpath.models.studies.log_motion import first_part, logged_motion
from onpath.models.studies.record_file import log_columns, quantities, read_records, units_of
from onpath.models.studies.table_file import column_names
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.parameters import Parameters
from onpath.models.systems.robots import Robot

MOST_COLUMNS = 200  # names of a file that a page is told


@dataclass(frozen=True, slots=True, eq=False)
class LogUpload:
    """A log from a browser, and the robot that it is of.

    Attributes:
        name, content: of the file.
        robot: name of the robot, with these parameters.
        columns, units: see `log_columns`; those that are missing are guessed.
    """

    name: str
    content: bytes
    robot: str
    parameters: Parameters
    columns: Mapping[str, str]
    units: Mapping[str, str]


@dataclass(frozen=True, slots=True, eq=False)
class ReadLog:
    """What became of a log.

    Attributes:
        found: the log, or why there is none.
        columns: names of the file's columns.
        quantities: as what they are read.
        is_whole: whether it is the whole file, and not only its first law.
    """

    found: ShownLog | Message | Exception
    columns: tuple[str, ...] = ()
    quantities: tuple[LogQuantity, ...] = ()
    is_whole: bool = True


def read_log(upload: LogUpload) -> ReadLog:
    """Read a log. Runs in the process."""
    robot = ROBOTS[upload.robot].make(upload.parameters)
    ending = PurePath(upload.name).suffix.lower()
    with TemporaryDirectory() as folder:
        path = Path(folder, "log" + (ending if ending in ENDINGS else ".csv"))
        path.write_bytes(upload.content)
        try:
            names = column_names(path)[:MOST_COLUMNS]
        except ValueError as error:
            return ReadLog(_reason(error))
        if not names:
            return ReadLog(Message("error.file_empty"))
        wanted = _wanted(robot, names, upload)
        try:
            log, is_whole = _read(path, robot, upload, wanted)
            return ReadLog(log, names, wanted, is_whole)
        except ValueError as error:
            return ReadLog(_reason(error), names, wanted)


def _wanted(robot: Robot, names: tuple[str, ...], upload: LogUpload) -> tuple[LogQuantity, ...]:
    """What is read from the columns: what the page says, else a guess."""
    guess, known = guessed_columns(robot, names), quantities(robot)
    columns = {**guess.columns, **upload.columns}
    units = {**guess.units, **upload.units}
    return tuple(
        LogQuantity(
            name=name,
            column=columns.get(name, ""),
            unit=units.get(name, next(iter(units_of(column)))),
            units=tuple(units_of(column)),
            is_optional=name.startswith("force"),
        )
        for name, column in known.items()
    )


def _read(
    path: Path, robot: Robot, upload: LogUpload, wanted: tuple[LogQuantity, ...]
) -> tuple[ShownLog, bool]:
    """The log, and whether it is the whole file."""
    lacking = [each.name for each in wanted if not each.column and not each.is_optional]
    if lacking:
        raise CodedError("error.log_columns", names=", ".join(lacking))
    columns = {each.name: each.column for each in wanted if each.column}
    units = {each.name: each.unit for each in wanted if each.column}
    records = read_records(path, robot, log_columns(robot, columns, units))
    plant = robot.plant(upload.parameters)
    part = first_part(records)
    motion = logged_motion(part, robot, plant)
    return shown_log(upload.name, upload.robot, motion), len(part) == len(records)


def _reason(error: ValueError) -> Message | Exception:
    return error.message if isinstance(error, Coded) else error
