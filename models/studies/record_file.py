"""Reads the CSV files of `onpath experiment --csv` and of the lab as records of motion.

The files are untrusted: what is not a table of finite numbers at even times is refused.
"""

from __future__ import annotations

import csv
from itertools import groupby
from math import isfinite
from pathlib import Path

import numpy as np

from onpath.models.arrays import Array
from onpath.models.closed_loop.trajectory import header, measured_names
from onpath.models.studies.identification import smooth_velocities
from onpath.models.studies.linear_model import MotionRecord
from onpath.models.systems.robots import Robot

LONGEST_LINE = 10_000  # characters
MOST_ROWS = 1_000_000
LAWS = ("law", "controller")  # name of the column of the law, now and in earlier versions


def read_records(path: Path, robot: Robot) -> list[tuple[str, MotionRecord]]:
    """The law and the record of each part of the file: rows of one bench and law, one by one.

    Raises:
        ValueError: not such a file, or not of this robot; the message says what is wrong.
        OSError: it cannot be read.
    """
    with path.open(encoding="utf-8", errors="replace", newline="") as file:
        names = _cells(file.readline(LONGEST_LINE), 1)
        law, wanted = _law_column(names), _columns(names, robot)
        rows = list[tuple[tuple[str, ...], list[float]]]()
        for number, line in enumerate(iter(lambda: file.readline(LONGEST_LINE), ""), start=2):
            if number > MOST_ROWS:
                raise ValueError(f"{path}: more than {MOST_ROWS} lines")
            cells = _cells(line, number)
            if len(cells) != len(names):
                raise ValueError(f"line {number}: expected {len(names)} cells, got {len(cells)}")
            numbers = [_number(cells[j], number) for j in wanted]
            rows.append((tuple(cells[1 : law + 1]), numbers))
    if not rows:
        raise ValueError(f"{path}: there are no rows")
    parts = groupby(rows, lambda row: row[0])
    records = [(key[-1], np.array([numbers for _, numbers in part])) for key, part in parts]
    measured = measured_names(robot)[0] in names
    return [(name, _record(name, part, robot, measured)) for name, part in records]


def _cells(line: str, number: int) -> list[str]:
    if len(line) >= LONGEST_LINE:
        raise ValueError(f"line {number} is longer than {LONGEST_LINE} characters")
    try:
        return next(csv.reader([line.rstrip("\r\n")]), list[str]())
    except csv.Error:
        raise ValueError(f"line {number} is not a row of a table") from None


def _number(cell: str, line: int) -> float:
    try:
        value = float(cell)
    except ValueError:
        raise ValueError(f"line {line}: {cell[:20]!r} is not a number") from None
    if not isfinite(value) or abs(value) > 1e9:
        raise ValueError(f"line {line}: {cell[:20]} is out of range")
    return value


def _columns(names: list[str], robot: Robot) -> list[int]:
    """Places of t, q, v, u and the force; of the joint angles as measured, if the file has them."""
    system, known = robot.system, header(robot)
    rates = known[2 + system.n : 2 + 2 * system.n]
    efforts = [n for n in known if n.startswith(("tau", "force"))]
    angles, sensed = list(robot.coordinate_names), measured_names(robot)
    if sensed[0] in names:
        angles[: len(sensed)] = sensed
    wanted = ["t_s", *angles, *rates, *efforts]
    missing = [name for name in wanted if name not in names]
    if missing:
        raise ValueError(f"not a file of the robot {robot.name}: there is no column {missing[0]}")
    return [names.index(name) for name in wanted]


def _law_column(names: list[str]) -> int:
    """Place of the law: the second column, or in a file of the lab the one after the bench."""
    at = 2 if names[1:2] == ["bench"] else 1
    if names[:1] != ["t_s"] or names[at : at + 1] not in ([name] for name in LAWS):
        raise ValueError("line 1: expected a header that begins with t_s, law")
    return at


def _record(law: str, rows: Array, robot: Robot, measured: bool) -> MotionRecord:
    n, m = robot.system.n, robot.system.m
    steps = np.diff(rows[:, 0])
    dt = float(np.median(steps)) if steps.size else 0.0
    if dt <= 0 or np.abs(steps - dt).max() > 0.1 * dt:
        raise ValueError(f"{law[:40]!r}: the times of its rows are not evenly spaced")
    q, v, u, force = np.split(rows[:, 1:], np.cumsum([n, n, m]), axis=1)
    if measured:
        v[:, :m] = smooth_velocities(q[:, :m], dt)
    return MotionRecord(dt, q, v, u, force, measured)
