"""Logs of an arm as its own controller would write them: late, uneven, noisy, in its units."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

import numpy as np
from scipy.interpolate import CubicSpline

from onpath.models.arrays import Array
from onpath.models.closed_loop.trajectory import Trajectory
from onpath.models.paths.path_design import presets
from onpath.models.studies.experiments import experiments, run

DRY = 0.04  # [N m], dry friction of every joint


@dataclass(frozen=True)
class Logger:
    """How a log is written.

    Attributes:
        rate: rows per second.
        uneven: share of the mean step by which times scatter.
        late: delay of the torques, [s].
        angle_noise, torque_noise: standard deviations, [rad] and [N m].
        counts: of the encoders per turn; 0: exact.
    """

    rate: float = 500.0
    uneven: float = 0.6
    late: float = 0.013
    angle_noise: float = 2e-4
    torque_noise: float = 0.01
    counts: int = 0

    def rows(self, motion: Trajectory, seed: int) -> tuple[Array, Array, Array]:
        """Times [s], angles [rad] and torques [N m] of a free motion."""
        rng = np.random.default_rng(seed)
        t = np.arange(0.15, motion.t[-1] - 0.15, 1 / self.rate)
        t = t + self.uneven / self.rate * rng.uniform(-0.5, 0.5, len(t))
        q = CubicSpline(motion.t, motion.fields["q"])(t)
        q += self.angle_noise * rng.normal(size=q.shape)
        if self.counts:
            step = 2 * np.pi / self.counts
            q = step * np.floor(q / step + 0.5)
        u, edges = motion.fields["u"], np.append(motion.t, motion.t[-1] + 1e-3)
        whole = 1e-3 * np.concatenate([np.zeros((1, u.shape[1])), np.cumsum(u, axis=0)])
        ends = np.append(t, t[-1] + 1 / self.rate)
        sums = [np.interp(ends - self.late, edges, each) for each in whole.T]
        means = np.stack([np.diff(each) / np.diff(ends) for each in sums], axis=1)
        return t, q, means + self.torque_noise * rng.normal(size=means.shape)


@cache
def motion_of(robot: str, preset: str = "clover", dry: float = DRY) -> tuple[Trajectory, Array]:
    """A free motion of 10 s with changing speed, and the robot's true parameters."""
    values: dict[str, float | str] = {"duration": 10.0, "hold_from": 0.0, "hold_to": 0.0}
    values |= {"speed": 5.0, "speed_profile": "stop_and_go", "profile_period": 3.3, "coulomb": dry}
    chosen = experiments(robot)["obstruction"].with_values(values)
    chosen = chosen.along(presets()[preset].curve, preset)
    return run(chosen, "path_following"), chosen.robot().plant(chosen.parameters)


def with_switching_friction(motion: Trajectory, dry: float) -> Trajectory:
    """The same motion with motors that also overcome a dry friction c sign(q'), [N m]."""
    rates = motion.fields["v"][:, : motion.fields["u"].shape[1]]
    torques = motion.fields["u"] + dry * np.sign(rates)
    return replace(motion, fields={**motion.fields, "u": torques})


COLUMNS = {"t": "Zeit [ms]", "q1": "Achse 1 [°]", "q2": "Achse 2 [°]"}
COLUMNS |= {"tau1": "Strom 1 [A]", "tau2": "Strom 2 [A]"}
UNITS: Mapping[str, str | float] = {"t": "ms", "q1": "deg", "q2": "deg", "tau1": 0.5, "tau2": -2.0}


def write_log(path: Path, t: Array, q: Array, u: Array, encoding: str = "utf-16") -> None:
    """A log in the units of `UNITS` with decimal commas, and a column of no use."""
    lines = [";".join([*COLUMNS.values(), "Zustand"])]
    numbers = np.column_stack([1e3 * (1.7e9 + t), np.degrees(q), u / [0.5, -2.0]])
    for row in numbers:
        text = [f"{row[0]:.3f}", *(f"{x:.9g}" for x in row[1:])]
        lines.append(";".join([*(each.replace(".", ",") for each in text), "läuft"]))
    path.write_text("\n".join(lines) + "\n", encoding=encoding)
