"""Reads records of motion: CSV files of OnPath, and logs of real arms.

The columns of a log have the names, or places, and units that its user states; those of arrays of
NumPy or MATLAB are named as in `quantities`, unless the user names them. Rows need not be evenly
spaced in time; they are then interpolated. At a gap, another record begins. A row that repeats the
one before counts once. The angles are measured, and their rates are filtered.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import groupby, pairwise, permutations
from math import pi
from pathlib import Path

import numpy as np

from onpath.models.arrays import Array
from onpath.models.closed_loop.trajectory import header, measured_names
from onpath.models.errors import CodedError
from onpath.models.studies.array_file import is_array_file
from onpath.models.studies.identification import BUMP, FEWEST, smooth_velocities, step_means
from onpath.models.studies.linear_model import MotionRecord
from onpath.models.studies.table_file import Table, read_table
from onpath.models.systems.parameter_specs import unknown_name
from onpath.models.systems.robots import Robot

LAW = "law"  # name of its column
MISSING = ("error.table_no_column", "error.table_no_names")
EVEN = 1e-3  # largest relative deviation of the time steps that is taken for rounding
GAP = 0.05  # [s], longest time without a row that is no gap
FAR = 1e6  # largest absolute value of angles, torques and forces (SI)
ANGLES = {"rad": 1.0, "deg": pi / 180, "rev": 2 * pi}
LENGTHS = {"m": 1.0, "cm": 1e-2, "mm": 1e-3}
UNITS: Mapping[str, Mapping[str, float]] = {
    "s": {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9},
    "rad": ANGLES,
    "m": LENGTHS,
    "Nm": {"Nm": 1.0, "mNm": 1e-3, "Ncm": 1e-2},
    "N": {"N": 1.0, "mN": 1e-3, "kN": 1e3},
    "m1.5": {"m1.5": 1.0},  # of the modes of a flexible link
}
"""SI unit of a quantity -> the units in which a log may have it, in SI units."""


def quantities(robot: Robot) -> dict[str, str]:
    """Names of what a log has to contain -> the column's name in files of OnPath.

    For instance "t" -> "t_s", "q1" -> "q1_rad", "tau1" -> "tau1_Nm", "force1" -> "force1_N".
    """
    system = robot.system
    efforts = [name for name in header(robot) if name.startswith(("tau", "force"))]
    columns = ["t_s", *system.coordinate_names, *efforts]
    return {name.rpartition("_")[0]: name for name in columns}


@dataclass(frozen=True, slots=True)
class LogColumns:
    """The columns of a real arm's log.

    Attributes:
        names: name of each of the `quantities` in the file.
        named: those of the quantities whose columns the user has named.
        scales: factor of each to SI units.
    """

    names: Mapping[str, str]
    named: frozenset[str]
    scales: Mapping[str, float]


def log_columns(
    robot: Robot, columns: Mapping[str, str | int], units: Mapping[str, str | float]
) -> LogColumns:
    """The columns of a log.

    Args:
        columns: the file's names of some of the `quantities`; the others have the names of files
            of OnPath.
        units: unit of some of the quantities, or its factor to SI units; others are in SI units.

    Raises:
        CodedError: an unknown quantity or unit, or an impossible factor.
    """
    known = quantities(robot)
    for name in (*columns, *units):
        if name not in known:
            raise unknown_name(name, list(known), "quantity")
    scales = {name: _scale(name, units.get(name, 1.0), known[name]) for name in known}
    named = {name: str(column) for name, column in columns.items()}
    return LogColumns({**known, **named}, frozenset(columns), scales)


def units_of(column: str) -> Mapping[str, float]:
    """The units in which a log may have a column of OnPath, such as "q1_rad", and their sizes."""
    return UNITS[column.rpartition("_")[2]]


def _scale(name: str, unit: str | float, usual: str) -> float:
    possible = units_of(usual)
    if unit in possible:
        return possible[str(unit)]
    try:
        factor = float(unit)
    except ValueError:
        raise unknown_name(str(unit), list(possible), f"unit of {name}") from None
    if not 1e-12 <= abs(factor) <= 1e12:  # NaN fails too
        raise CodedError("error.log_factor", name=name, value=f"{factor:g}")
    return factor


def read_records(
    path: Path, robot: Robot, log: LogColumns | None = None
) -> list[tuple[str, MotionRecord]]:
    """The law and the record of each part of the file: consecutive rows of one side and law, with
    no gap between them.

    The law is "" in a file without a column of that name. The columns may be in any order.

    Args:
        log: the columns of a real arm's log; None: it is a file of OnPath.

    Raises:
        CodedError: the file has another form or is of another robot; the message names line and
            column.
        OSError: it cannot be read.
    """
    if log is None and is_array_file(path):
        log = log_columns(robot, {}, {})
    if log is not None and is_array_file(path):
        log = replace(log, names={n: c if n in log.named else n for n, c in log.names.items()})
    measured, table = _own(path, robot) if log is None else (True, _log(path, robot, log))
    time = "t_s" if log is None else log.names["t"]
    laws = table.texts.get(LAW)
    keys = list(zip(*table.texts.values(), strict=True)) or [()] * len(table.lines)
    records = list[tuple[str, MotionRecord]]()
    for _, part in groupby(range(len(keys)), key=keys.__getitem__):
        rows = list(part)
        law = laws[rows[0]] if laws else ""
        begin = float(table.numbers[rows[0], 0])
        _check_times(table.numbers[rows, 0], table.lines[rows[0] : rows[-1] + 1], time)
        for piece in _between_gaps(table.numbers[rows, 0]):
            numbers = table.numbers[rows[piece]]
            record = _record(numbers, robot, measured, time)
            records.append((law, replace(record, start=float(numbers[0, 0]) - begin)))
    return records


def _between_gaps(times: Array) -> list[slice]:
    """The rows between gaps, without pieces of less than `FEWEST` if there are longer ones."""
    steps = np.diff(times)
    usual = float(np.median(steps)) if steps.size else 0.0
    ends = [0, *(np.flatnonzero(steps > max(GAP, usual)) + 1).tolist(), len(times)]
    pieces = [(end - begin, slice(begin, end)) for begin, end in pairwise(ends)]
    least = min(FEWEST, max(count for count, _ in pieces))
    return [piece for count, piece in pieces if count >= least]


def _own(path: Path, robot: Robot) -> tuple[bool, Table]:
    """Whether a file of OnPath has measured joint angles, and its table, with these if possible."""
    missing: CodedError | None = None
    for measured in (True, False):
        try:
            return measured, read_table(path, _columns(robot, measured), ("side", LAW))
        except CodedError as error:
            if error.message.code not in MISSING:
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


def _log(path: Path, robot: Robot, log: LogColumns) -> Table:
    """The table of a real arm's log in SI units, with the columns of `_own`; the rates are 0.

    Without columns of forces there are none.
    """
    forces = [name for name in log.names if name.startswith("force")]
    motion = [name for name in log.names if name not in forces]
    try:
        table = _quantities(path, log, [*motion, *forces])
    except CodedError as error:
        if error.message.code not in MISSING or log.named.intersection(forces):
            raise
        table = _quantities(path, log, motion)
    n, m, rows = robot.system.n, robot.system.m, len(table.lines)
    numbers = np.zeros((rows, 1 + 2 * n + m + robot.system.p))
    numbers[:, : 1 + n] = table.numbers[:, : 1 + n]
    efforts = table.numbers[:, 1 + n :]
    numbers[:, 1 + 2 * n : 1 + 2 * n + efforts.shape[1]] = efforts
    return Table(numbers, table.texts, table.lines)


def _quantities(path: Path, log: LogColumns, wanted: Sequence[str]) -> Table:
    """Some quantities of a log, in SI units; times from the first row on.

    Raises:
        CodedError: see `read_records`.
    """
    columns = [log.names[name] for name in wanted]
    table = _without_repeated(read_table(path, columns, (LAW,), time=log.names["t"]))
    numbers = table.numbers.copy()
    numbers[:, 0] -= numbers[0, 0]
    numbers *= [log.scales[name] for name in wanted]
    far = np.argwhere(np.abs(numbers[:, 1:]) > FAR)
    if len(far):
        row, column = int(far[0, 0]), int(far[0, 1])
        value = f"{table.numbers[row, 1 + column]:g}"
        line, name = str(table.lines[row]), columns[1 + column]
        raise CodedError("error.table_large_number", line=line, column=name, text=value)
    return Table(numbers, table.texts, table.lines)


def _without_repeated(table: Table) -> Table:
    """The table without rows whose numbers are those of the row before."""
    numbers = table.numbers
    kept = np.append(True, (numbers[1:] != numbers[:-1]).any(axis=1))
    if kept.all():
        return table
    rows = np.flatnonzero(kept).tolist()
    texts = {name: [each[i] for i in rows] for name, each in table.texts.items()}
    return Table(numbers[kept], texts, [table.lines[i] for i in rows])


def _record(rows: Array, robot: Robot, measured: bool, time: str) -> MotionRecord:
    """The record of some rows, evenly spaced.

    Args:
        measured: whether the joint angles are measured; their rates are then filtered.
        time: name of the column of times, for messages.

    Raises:
        CodedError: there are too few rows.
    """
    n, m, joints = robot.system.n, robot.system.m, robot.system.joints
    dt = _step(rows[:, 0], time)
    times = rows[:, 0]
    q, v, u, force = np.split(rows[:, 1:], np.cumsum([n, n, m]), axis=1)
    errors, noise = _errors(times, q[:, :joints]), None
    if np.abs(np.diff(times) - dt).max() > EVEN * dt:
        whole = round((times[-1] - times[0]) / dt)
        grid: Array = np.linspace(float(times[0]), float(times[-1]), whole + 1)
        dt = float(grid[1] - grid[0])
        q, v = _interpolated(times, q, grid), _interpolated(times, v, grid)
        u, force = _means(times, u, grid), _means(times, force, grid)
        errors = _interpolated(times, errors, grid)
    if measured:
        v[:, :joints] = smooth_velocities(q[:, :joints], dt)
        noise = np.zeros_like(q), np.zeros_like(v)
        noise[0][:, :joints], noise[1][:, :joints] = errors, smooth_velocities(errors, dt)
    return MotionRecord(dt=dt, q=q, v=v, u=u, force=force, measured=measured, noise=noise)


def _errors(times: Array, angles: Array) -> Array:
    """Random errors as large as those of measured angles, shape (rows, joints).

    How large these are follows from the distance of each row from the cubic through its four
    neighbours, whose weights are w: with independent errors of the variance σ², that has the
    variance σ² (1 + Σ w²).

    Source: Gasser, Sroka and Jennen-Steinmetz, Biometrika 73, 1986, with straight lines.
    """
    rows = len(times)
    if rows < 5:
        return np.zeros_like(angles)
    near = np.arange(2, rows - 2)[:, None] + [-2, -1, 1, 2]
    away, weights = times[near] - times[2:-2, None], np.ones((rows - 4, 4))
    for i, j in permutations(range(4), 2):
        weights[:, i] *= away[:, j] / (away[:, j] - away[:, i])
    apart = angles[2:-2] - np.einsum("ki,kij->kj", weights, angles[near])
    size = np.sqrt(np.mean(apart**2 / (1 + (weights**2).sum(axis=1))[:, None], axis=0))
    errors = size * np.random.default_rng(0).normal(size=angles.shape)
    return np.asarray(errors, dtype=float)


def _check_times(times: Array, lines: Sequence[int], column: str) -> None:
    """Raise CodedError if times do not grow, or there is only one."""
    steps = np.diff(times)
    if not steps.size:
        raise CodedError("error.record_of_one_row", line=str(lines[0]))
    bad = np.flatnonzero(steps <= 0)
    if bad.size:
        raise CodedError("error.record_times", line=str(lines[int(bad[0]) + 1]), column=column)


def _step(times: Array, column: str) -> float:
    """The median time step.

    Raises:
        CodedError: see `_record`.
    """
    dt = float(np.median(np.diff(times)))
    if dt > BUMP / FEWEST * (1 + EVEN):
        step, most = f"{1e3 * dt:.3g}", f"{1e3 * BUMP / FEWEST:g}"
        raise CodedError("error.record_coarse", column=column, step=step, most=most)
    return dt


def _interpolated(times: Array, values: Array, grid: Array) -> Array:
    """Smooth values at other times; Akima's curve does not swing where two times nearly meet."""
    from scipy.interpolate import Akima1DInterpolator  # slow to import

    return np.asarray(Akima1DInterpolator(times, values)(grid), dtype=float)


def _means(times: Array, values: Array, grid: Array) -> Array:
    """Means over the steps of a grid of values that are means from row to row."""
    dt = grid[1] - grid[0]
    ends, edges = np.append(times, times[-1] + dt), np.append(grid, grid[-1] + dt)
    return step_means(ends, values, edges)
