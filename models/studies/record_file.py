"""Reads the CSV files of `onpath experiment --csv` and of the lab as records of motion."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby
from pathlib import Path

import numpy as np

from onpath.models.arrays import Array
from onpath.models.closed_loop.trajectory import header
from onpath.models.errors import CodedError
from onpath.models.studies.linear_model import MotionRecord
from onpath.models.studies.table_file import Table, read_table
from onpath.models.systems.robots import Robot

LAWS = ("law", "controller")  # name of the column of the law, now and in earlier versions
UNEVEN = 0.1  # deviation of a time step from the others, relative to them, that is refused


def read_records(path: Path, robot: Robot) -> list[tuple[str, MotionRecord]]:
    """The law and the record of each part of the file: rows of one bench and law, one by one.

    The law is "" in a file without a column of that name. Its other columns may stand in any order.

    Raises:
        CodedError: not such a file, or not of this robot; the message says where and why.
        OSError: it cannot be read.
    """
    table = _table(path, robot)
    laws = next((table.texts[name] for name in LAWS if name in table.texts), None)
    keys = list(zip(*table.texts.values(), strict=True)) or [()] * len(table.lines)
    records = list[tuple[str, MotionRecord]]()
    for _, part in groupby(range(len(keys)), key=keys.__getitem__):
        rows = list(part)
        lines = table.lines[rows[0] : rows[-1] + 1]
        law = laws[rows[0]] if laws else ""
        records.append((law, _record(table.numbers[rows], lines, robot)))
    return records


def _table(path: Path, robot: Robot) -> Table:
    try:
        return read_table(path, _columns(robot), ("bench", *LAWS))
    except CodedError as error:
        if error.message.code != "error.table_no_column":
            raise
        raise CodedError(
            "error.record_of_another_robot", robot=robot.name, reason=error.message
        ) from None


def _columns(robot: Robot) -> list[str]:
    """Names of t, q, v, u and the force."""
    system, known = robot.system, header(robot)
    rates = known[2 + system.n : 2 + 2 * system.n]
    efforts = [n for n in known if n.startswith(("tau", "force"))]
    return ["t_s", *robot.coordinate_names, *rates, *efforts]


def _record(rows: Array, lines: Sequence[int], robot: Robot) -> MotionRecord:
    """The record of some rows.

    Args:
        lines: their lines in the file.

    Raises:
        CodedError: their times are not evenly spaced.
    """
    n, m = robot.system.n, robot.system.m
    steps = np.diff(rows[:, 0])
    if not steps.size:
        raise CodedError("error.record_of_one_row", line=str(lines[0]))
    dt = float(np.median(steps))
    uneven = np.flatnonzero(np.abs(steps - dt) > UNEVEN * dt if dt > 0 else steps <= 0)
    if uneven.size:
        at = int(uneven[0])
        step, usual = f"{steps[at]:.6g}", f"{dt:.6g}"
        raise CodedError("error.record_uneven", line=str(lines[at + 1]), step=step, usual=usual)
    q, v, u, force = np.split(rows[:, 1:], np.cumsum([n, n, m]), axis=1)
    return MotionRecord(dt, q, v, u, force)
