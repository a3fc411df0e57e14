"""What a real arm has logged, as a lab keeps it, to be drawn over its plots."""

from __future__ import annotations

import dataclasses
from base64 import b64decode, b64encode
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from onpath.models.studies.log_motion import LoggedMotion, read_logged, thinned
from onpath.models.systems.robots import Robot, RobotEntry

MOST_ROWS = 1200
LEAST_STEP = 1 / 60  # [s], between two of them
LONGEST_NAME = 200  # [characters] of a file's name
MOST_COLUMNS = 100


@dataclass(frozen=True, slots=True, eq=False)
class ShownLog:
    """A log.

    Attributes:
        file: name of its file.
        robot: name of the robot that it is of; with any other it is not shown.
        motion: of the end-point, in at most `MOST_ROWS` rows.
    """

    file: str
    robot: str
    motion: LoggedMotion

    def fits(self, robot: Robot) -> bool:
        """Whether it is of this robot."""
        sizes = self.motion.y.shape[1], self.motion.u.shape[1]
        return robot.name == self.robot and sizes == (robot.system.p, robot.system.m)


def shown_log(file: str, robot: str, motion: LoggedMotion) -> ShownLog:
    """A log of any length, in the rows that a lab keeps."""
    return ShownLog(file[-LONGEST_NAME:], robot, thinned(motion, MOST_ROWS, LEAST_STEP))


def read_shown_log(
    file: Path,
    entry: RobotEntry,
    columns: Mapping[str, str | int],
    units: Mapping[str, str | float],
) -> ShownLog:
    """The log in a file.

    Args:
        entry: the robot that it is of.
        columns, units: see `read_motions`.

    Raises:
        CodedError: the file is refused; the message names it, and line and column.
        OSError: it cannot be read.
    """
    parameters = entry.parameters()
    robot = entry.make(parameters)
    motion = read_logged(file, robot, robot.plant(parameters), columns, units)
    return shown_log(file.name, entry.name, motion)


def log_data(log: ShownLog) -> dict[str, Any]:
    """A log as JSON data, with numbers of single precision."""
    values = {name: getattr(log.motion, name) for name in _ARRAYS}
    return {
        "file": log.file,
        "robot": log.robot,
        "rows": len(log.motion.t),
        **{name: b64encode(x.astype("<f4").tobytes()).decode() for name, x in values.items()},
    }


def log_from(data: Any) -> ShownLog | None:
    """Inverse of `log_data`; None for anything that is no log."""
    try:
        rows = int(data["rows"])
        if not 0 < rows <= MOST_ROWS:
            return None
        arrays = {name: _array(data[name], rows) for name in _ARRAYS}
        t = arrays.pop("t")[:, 0]
        file, robot = str(data["file"])[-LONGEST_NAME:], str(data["robot"])
    except (KeyError, TypeError, ValueError):
        return None
    is_moving = np.isfinite(arrays["y"]).all(axis=1).any()  # rows of gaps are NaN
    if not is_moving or not np.isfinite(t).all() or (np.diff(t) < 0).any():
        return None
    return ShownLog(file, robot, LoggedMotion(t=t, **arrays))


def _array(text: str, rows: int) -> np.ndarray:
    values = np.frombuffer(b64decode(text, validate=True), "<f4").reshape(rows, -1)
    if values.shape[1] > MOST_COLUMNS or np.isinf(values).any():
        raise ValueError("no numbers of a log")
    return values.astype(float)


_ARRAYS = tuple(f.name for f in dataclasses.fields(LoggedMotion))
