"""Reads the CSV files of `onpath experiment --csv` and of the lab as records of motion."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby
from pathlib import Path

import numpy as np

from onpath.models.arrays import Array
from onpath.models.closed_loop.trajectory import header, measured_names
from onpath.models.errors import CodedError
from onpath.models.studies.identification import smooth_velocities
from onpath.models.studies.linear_model import MotionRecord
from onpath.models.studies.table_file import Table, read_table
from onpath.models.systems.robots import Robot

LAW = "law"  # name of its column
UNEVEN = 0.1  # largest relative deviation of a time step from the others


def read_records(path: Path, robot: Robot) -> list[tuple[str, MotionRecord]]:
    """The law and the record of each part of the file: consecutive rows of one side and law.

    The law is "" in a file without a column of that name. The columns may be in any order.

    Raises:
        CodedError: the file has another form or is of another robot; the message tells the details.
        OSError: it cannot be read.
    """
    measured, table = _table(path, robot)
    laws = table.texts.get(LAW)
    keys = list(zip(*table.texts.values(), strict=True)) or [()] * len(table.lines)
    records = list[tuple[str, MotionRecord]]()
    for _, part in groupby(range(len(keys)), key=keys.__getitem__):
        rows = list(part)
        lines = table.lines[rows[0] : rows[-1] + 1]
        law = laws[rows[0]] if laws else ""
        records.append((law, _record(table.numbers[rows], lines, robot, measured)))
    return records


def _table(path: Path, robot: Robot) -> tuple[bool, Table]:
    """Whether the file has measured joint angles, and its table, with these if possible."""
    missing: CodedError | None = None
    for measured in (True, False):
        try:
            return measured, read_table(path, _columns(robot, measured), ("side", LAW))
        except CodedError as error:
            if error.message.code != "error.table_no_column":
                raise
            missing = error
    assert missing is not None
    raise CodedError("error.record_of_another_robot", robot=robot.name, reason=missing.message)


def _columns(robot: Robot, measured: bool) -> list[str]:
    """Names of the columns of t, q, v, u and the force, with measured or true joint angles."""
    system, known = robot.system, header(robot)
    rates = known[2 + system.n : 2 + 2 * system.n]
    efforts = [n for n in known if n.startswith(("tau", "force"))]
    angles = list(robot.system.coordinate_names)
    if measured:
        angles[: system.joints] = measured_names(robot)
    return ["t_s", *angles, *rates, *efforts]


def _record(rows: Array, lines: Sequence[int], robot: Robot, measured: bool) -> MotionRecord:
    """The record of some rows.

    Args:
        lines: their lines in the file.
        measured: whether the joint angles are measured; their rates are then filtered.

    Raises:
        CodedError: their times are not evenly spaced.
    """
    n, m = robot.system.n, robot.system.m
    steps = np.diff(rows[:, 0])
    if not steps.size:
        raise CodedError("error.record_of_one_row", line=str(lines[0]))
    dt = float(np.median(steps))
    if dt <= 0:
        raise CodedError("error.record_times", line=str(lines[1]))
    uneven = np.flatnonzero(np.abs(steps - dt) > UNEVEN * dt)
    if uneven.size:
        at = int(uneven[0])
        step, usual = f"{steps[at]:.6g}", f"{dt:.6g}"
        raise CodedError("error.record_uneven", line=str(lines[at + 1]), step=step, usual=usual)
    q, v, u, force = np.split(rows[:, 1:], np.cumsum([n, n, m]), axis=1)
    if measured:
        joints = robot.system.joints
        v[:, :joints] = smooth_velocities(q[:, :joints], dt)
    return MotionRecord(dt=dt, q=q, v=v, u=u, force=force, measured=measured)
