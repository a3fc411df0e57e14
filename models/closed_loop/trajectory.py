"""The record of a run: named columns over time, written to CSV."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import TextIO

import numpy as np
from numpy.typing import NDArray

from onpath.models.arrays import Array
from onpath.models.control.laws.registry import law_named
from onpath.models.layout import Layout
from onpath.models.paths.curves import Curve
from onpath.models.paths.distance import drawn_distance
from onpath.models.robot_files.guesses import Guess
from onpath.models.systems.guessed_numbers import with_mark
from onpath.models.systems.robots import Robot

MEASURED = "measured"


@dataclass(frozen=True, slots=True, eq=False)
class Trajectory:
    """The record of one robot under one control law.

    Attributes:
        law: name of the control law.
        t: time, shape (n,), [s].
        fields: the log by name (models/closed_loop/loop_vectors.py), each shape (n, size); where
            sensors are not exact also `MEASURED`, the joint angles that they read, [rad].
        distance: from the actual end-point to the path, shape (n,), [m]; 0 where the pen is raised.
        speed: along the path, shape (n,), [m/s].
        held: whether the brake was on, shape (n,).
        stopped_at: time at which the run was stopped as diverged, [s], or None.
        reason: the reason for the stop, or "".
        level_set: whether the first component of ξ is s(y), [m²], instead of a distance, [m].
        label: the law's label, which is known even where the law is not.
    """

    law: str
    t: Array
    fields: dict[str, Array]
    distance: Array
    speed: Array
    held: NDArray[np.bool_]
    stopped_at: float | None = None
    reason: str = ""
    level_set: bool = False
    label: str = ""

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


def join(law: str, parts: list[Trajectory]) -> Trajectory:
    """Consecutive parts of a run as one trajectory.

    Raises:
        ValueError: `parts` is empty.
    """
    if not parts:
        raise ValueError(f"{law}: there is nothing to show")
    return Trajectory(
        law=law,
        t=np.concatenate([part.t for part in parts]),
        fields={
            name: np.concatenate([part.fields[name] for part in parts]) for name in parts[0].fields
        },
        distance=np.concatenate([part.distance for part in parts]),
        speed=np.concatenate([part.speed for part in parts]),
        held=np.concatenate([part.held for part in parts]),
        level_set=parts[-1].level_set,
        label=parts[-1].label,
    )


def record(
    robot: Robot,
    log: Layout,
    law: str,
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
    distance = list[Array]()
    for part, curve, _ in segments:
        some = log.unpack(part)
        theta = some[law_named(law).aim][:, 0]
        distance.append(drawn_distance(robot.frame, curve, some["y"], theta))
    held = [np.full(len(part), hold) for part, _, hold in segments]
    return Trajectory(
        law=law,
        t=np.arange(len(rows), dtype=float) * dt if times is None else times,
        fields=fields,
        distance=np.concatenate(distance),
        speed=fields["speed"][:, 0],
        held=np.concatenate(held),
        label=law_named(law).label,
    )


def measured_names(robot: Robot) -> list[str]:
    """Names of the columns of the measured joint angles."""
    units = (name.rpartition("_") for name in robot.system.coordinate_names[: robot.system.joints])
    return [f"{name}_measured_{unit}" for name, _, unit in units]


def header(
    robot: Robot,
    level_set: bool = False,
    sides: bool = False,
    measured: bool = False,
    guesses: Sequence[Guess] = (),
) -> list[str]:
    """Column names of the CSV, with units, and marks such as " (guessed: mass)".

    xi1 is in [m], or in [m²] with `level_set`, and its rate accordingly. The references
    are the reference point of laws with a clock, and the wanted speed. The distance is that of the
    actual end-point and does not depend on the law.

    Args:
        level_set: whether xi1 is a level set.
        sides: whether there is a column for the side.
        measured: whether there are columns for the measured joint angles.
        guesses: about the robot; what rests on them is marked.
    """
    p, m = robot.system.p, robot.system.m
    units = (name.rpartition("_") for name in robot.system.coordinate_names)
    xi = [(f"xi{i + 1}", "m2" if level_set and i == 0 else "m") for i in range(p - 1)]
    names = [
        "t_s",
        *["side"] * sides,
        "law",
        *robot.system.coordinate_names,
        *(f"{name}_rate_{unit}_s" for name, _, unit in units),
        *(f"y{i + 1}_m" for i in range(p)),
        "theta_rad",
        "theta_rate_rad_s",
        *(f"{name}_{unit}" for name, unit in xi),
        *(f"{name}_rate_{unit}_s" for name, unit in xi),
        "theta_ref_rad",
        "theta_rate_ref_rad_s",
        "distance_m",
        *(f"tau{i + 1}_Nm" for i in range(m)),
        *(f"force{i + 1}_N" for i in range(p)),
        "held",
        *(measured_names(robot) if measured else ()),
    ]
    return [with_mark(name, guesses) for name in names]


def without_mark(column: str) -> str:
    """The name of a column without the mark of what it rests on."""
    return column.partition(" (guessed")[0]


def numbers_of(robot: Robot, run: Trajectory, measured: bool) -> Array:
    """The columns of the CSV after that of the law, see `header`, one row per millisecond.

    Args:
        measured: whether there are columns for the measured joint angles.
    """
    f = run.fields
    names = ("q", "v", "y", "theta", "theta_rate", "xi", "xi_rate", "theta_ref", "speed_ref")
    seen = [f[name] for name in names]
    sensed = [f.get(MEASURED, f["q"][:, : robot.system.joints])] if measured else []  # exact: q
    held = run.held.astype(float)
    return np.column_stack([*seen, run.distance, f["u"], f["force"], held, *sensed])


def write_csv(
    file: TextIO,
    robot: Robot,
    trajectories: Iterable[Trajectory],
    sides: Sequence[str] | None = None,
    guesses: Sequence[Guess] = (),
) -> None:
    """Write one row per millisecond and control law, with nine significant digits.

    The same trajectories give the same bytes.

    Args:
        sides: the side of each trajectory, for a column of its own; None for no such column.
        guesses: about the robot; see `header`.
    """
    writer = csv.writer(file, lineterminator="\n")
    runs = list(trajectories)
    read = any(MEASURED in run.fields for run in runs)
    level_set = any(run.level_set for run in runs)
    writer.writerow(header(robot, level_set, sides is not None, read, guesses))
    for number, run in enumerate(runs):
        columns = numbers_of(robot, run, read)
        law = f'"{run.law}"' if "," in run.law else run.law
        name = law if sides is None else f"{sides[number]},{law}"
        line = f"%.9g,{name}{',%.9g' * columns.shape[1]}\n"
        columns += 0.0  # turns -0 into 0
        rows = np.column_stack([run.t, columns]).tolist()
        file.writelines(line % tuple(row) for row in rows)
