"""The record of a run: named columns over time, written to and read from CSV."""

from __future__ import annotations

import csv
from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import TextIO

import numpy as np
from numpy.typing import NDArray

from onpath.models.arrays import Array
from onpath.models.layout import Layout
from onpath.models.paths.curves import Curve
from onpath.models.paths.distance import path_distance
from onpath.models.systems.robots import Robot


@dataclass(frozen=True, slots=True, eq=False)
class Trajectory:
    """The record of one robot under one control law.

    Attributes:
        controller: name of the control law.
        t: time, shape (n,), [s].
        fields: the log by name (models/closed_loop/loop_vectors.py), each shape (n, size).
        distance: from the actual end-point to the path, shape (n,), [m].
        speed: along the path, shape (n,), [m/s].
        held: whether the brake was on, shape (n,).
        diverged_at: time at which the run was stopped as diverged, [s], or None.
        reason: why it was stopped, or "".
    """

    controller: str
    t: Array
    fields: dict[str, Array]
    distance: Array
    speed: Array
    held: NDArray[np.bool_]
    diverged_at: float | None = None
    reason: str = ""

    def thinned(self) -> Trajectory:
        """The record with one row per millisecond, whatever the tick was."""
        if len(self.t) < 2:
            return self
        dt = self.t[1] - self.t[0]
        every = max(1, round(1e-3 / dt))
        kept = slice(-round(self.t[0] / dt) % every, None, every)  # rows at whole milliseconds
        return replace(
            self,
            t=self.t[kept],
            fields={name: values[kept] for name, values in self.fields.items()},
            distance=self.distance[kept],
            speed=self.speed[kept],
            held=self.held[kept],
        )


def join(controller: str, parts: list[Trajectory]) -> Trajectory:
    """Consecutive parts of a run as one trajectory.

    Raises:
        ValueError: `parts` is empty.
    """
    if not parts:
        raise ValueError(f"{controller}: there is nothing to show")
    return Trajectory(
        controller=controller,
        t=np.concatenate([part.t for part in parts]),
        fields={
            name: np.concatenate([part.fields[name] for part in parts]) for name in parts[0].fields
        },
        distance=np.concatenate([part.distance for part in parts]),
        speed=np.concatenate([part.speed for part in parts]),
        held=np.concatenate([part.held for part in parts]),
    )


def record(
    robot: Robot,
    log: Layout,
    controller: str,
    segments: list[tuple[Array, Curve, bool]],
    dt: float,
    times: Array | None = None,
) -> Trajectory:
    """A trajectory from log rows, one per tick.

    Args:
        log: layout of the rows.
        segments: consecutive (rows, curve, held).
        dt: time between rows, [s].
        times: of the rows, [s]; None: from 0 on.
    """
    rows = np.concatenate([rows for rows, _, _ in segments])
    fields = log.unpack(rows)
    distance = [
        path_distance(robot.frame, curve, log.unpack(part)["y"]) for part, curve, _ in segments
    ]
    held = [np.full(len(part), hold) for part, _, hold in segments]
    return Trajectory(
        controller=controller,
        t=np.arange(len(rows), dtype=float) * dt if times is None else times,
        fields=fields,
        distance=np.concatenate(distance),
        speed=fields["speed"][:, 0],
        held=np.concatenate(held),
    )


def header(robot: Robot) -> list[str]:
    """Column names of the CSV, with units."""
    p, m = robot.system.p, robot.system.m
    return [
        "t_s",
        "controller",
        *robot.coordinate_names,
        *(f"y{i + 1}_m" for i in range(p)),
        "theta_rad",
        "speed_m_s",
        "distance_m",
        *(f"tau{i + 1}_Nm" for i in range(m)),
        *(f"force{i + 1}_N" for i in range(p)),
    ]


def write_csv(file: TextIO, robot: Robot, trajectories: Iterable[Trajectory]) -> None:
    """Write one row per millisecond and control law, with nine significant digits.

    The same trajectories give the same bytes.
    """
    writer = csv.writer(file, lineterminator="\n")
    writer.writerow(header(robot))
    for run in trajectories:
        f = run.fields
        columns = np.column_stack(
            [f["q"], f["y"], f["theta"], run.speed, run.distance, f["u"], f["force"]]
        )
        line = f"%.6g,{run.controller}{',%.9g' * columns.shape[1]}\n"
        columns += 0.0  # turns -0 into 0
        rows = np.column_stack([run.t, columns]).tolist()
        file.writelines(line % tuple(row) for row in rows)


def read_csv(file: TextIO) -> dict[str, dict[str, Array]]:
    """Columns of a file written by `write_csv`: controller -> column name -> array.

    Raises:
        ValueError: not a trajectory file; the message names the line.
    """
    reader = csv.reader(file)
    names = next(reader, list[str]())
    if names[:2] != ["t_s", "controller"]:
        raise ValueError("line 1: expected a header that begins with t_s, controller")
    rows: dict[str, list[list[float]]] = {}
    for line, row in enumerate(reader, start=2):
        try:
            values = [float(cell) for i, cell in enumerate(row) if i != 1]
        except ValueError:
            raise ValueError(f"line {line}: expected numbers, got {row}") from None
        if len(row) != len(names):
            raise ValueError(f"line {line}: expected {len(names)} cells, got {len(row)}")
        rows.setdefault(row[1], []).append(values)
    kept = [name for name in names if name != "controller"]
    return {
        controller: dict(zip(kept, np.array(values).T, strict=True))
        for controller, values in rows.items()
    }
