"""Logs of an arm as its own controller would write them: late, uneven, noisy, in its units."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from scipy.interpolate import CubicSpline

from onpath.models.arrays import Array
from onpath.models.closed_loop.trajectory import Trajectory
from onpath.models.paths.path_design import presets
from onpath.models.studies.experiments import experiments, run
from onpath.models.studies.log_identification import identified_system
from onpath.models.studies.parameter_estimate import DELAY, Estimate, estimate
from onpath.models.studies.record_file import log_columns, quantities, read_records
from onpath.models.systems.catalogue import ROBOTS

DRY = 0.04  # [N m], dry friction of every joint
STUCK = 0.05  # [rad], range of a motion that counts as none
WHEEL = 0.1  # [m], radius of the wheel that moves a slide


@dataclass(frozen=True)
class Logger:
    """How a log is written.

    Attributes:
        rate: rows per second.
        uneven: share of the mean step by which times scatter.
        late: delay of the torques, [s].
        angle_noise, torque_noise: standard deviations, [rad] and [N m].
        counts: of the encoders per turn; 0: exact. A slide is moved by a wheel.
    """

    rate: float = 500.0
    uneven: float = 0.6
    late: float = 0.013
    angle_noise: float = 2e-4
    torque_noise: float = 0.01
    counts: int = 0

    def rows(
        self, motion: Trajectory, seed: int, slides: Sequence[bool] = ()
    ) -> tuple[Array, Array, Array]:
        """Times [s], coordinates [rad, m] and torques [N m] of a free motion.

        Args:
            slides: which coordinates are lengths; none by default.
        """
        wheel = np.where(slides, WHEEL, 1.0) if len(slides) else 1.0
        rng = np.random.default_rng(seed)
        t = np.arange(0.15, motion.t[-1] - 0.15, 1 / self.rate)
        t = t + self.uneven / self.rate * rng.uniform(-0.5, 0.5, len(t))
        q = CubicSpline(motion.t, motion.fields["q"])(t)
        q += wheel * self.angle_noise * rng.normal(size=q.shape)
        if self.counts:
            step = wheel * 2 * np.pi / self.counts
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


@dataclass(frozen=True)
class TrueLog:
    """The log of an arm that is known.

    Attributes:
        rows: times [s], angles [rad] and torques [N m].
        true: the robot's parameters, the dry friction c1, c2, ... of its motors, and the delay.
    """

    rows: tuple[Array, Array, Array]
    true: Mapping[str, float]


def random_log(robot: str, seed: int, sticks: bool = True) -> TrueLog | None:
    """A log of 10 s with random motion, friction, encoders, noise, rows and delay.

    Args:
        sticks: whether motors stick by Karnopp's model, up to twice their dry friction; else that
            passes smoothly through standstill.

    Returns:
        None if the motors stick for ever.
    """
    rng = np.random.default_rng(seed)
    dry = float(rng.uniform(0.01, 0.06))
    values: dict[str, float | str] = {"duration": 10.0, "hold_from": 0.0, "hold_to": 0.0}
    values |= {"speed": float(rng.uniform(3, 7)), "profile_period": float(rng.uniform(2, 4))}
    values |= {"speed_profile": str(rng.choice(["constant", "stop_and_go", "sine", "ramp_up"]))}
    values |= {"coulomb": dry, "stiction": dry * float(rng.uniform(1, 2)) if sticks else 0.0}
    preset = str(rng.choice(["clover", "ellipse", "rounded square", "circle"]))
    chosen = experiments(robot)["obstruction"].with_values(values)
    chosen = chosen.along(presets()[preset].curve, preset)
    logger = Logger(
        rate=float(np.exp(rng.uniform(np.log(100), np.log(1000)))),
        uneven=float(rng.uniform(0, 0.95)),
        late=float(rng.uniform(-0.025, 0.025)),
        angle_noise=float(rng.uniform(0, 5e-4)),
        torque_noise=float(rng.uniform(0, 0.03)),
        counts=int(rng.integers(2000, 20000)),
    )
    motion, system = run(chosen, "path_following"), chosen.robot().system
    if np.ptp(motion.fields["q"], axis=0).max() < STUCK or motion.stopped_at is not None:
        return None
    plant = chosen.robot().plant(chosen.parameters).tolist()
    true = dict(zip(system.parameter_names, plant, strict=True))
    source = ROBOTS[robot].source
    for i, joint in enumerate(source.chain.joints if source else ()):
        true[f"b{i + 1}"] = joint.damping
    true |= {f"c{i + 1}": dry for i in range(system.m)} | {DELAY: logger.late}
    slides = [name.endswith("_m") for name in system.coordinate_names]
    return TrueLog(logger.rows(motion, seed, slides), true)


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


def estimate_of(rows: tuple[Array, Array, Array], robot: str, plant: Array) -> Estimate:
    """The estimate from a log that went through a file."""
    entry = ROBOTS[robot]
    made = entry.make(entry.parameters())
    names = [name for name in quantities(made) if not name.startswith("force")]
    with TemporaryDirectory() as folder:
        path = Path(folder, "log.csv")
        table = np.column_stack(rows)
        np.savetxt(path, table, "%.9g", ",", header=",".join(names), comments="")
        read = read_records(path, made, log_columns(made, {n: n for n in names}, {}))
    system, geometry = identified_system(entry) if entry.source else (made.system, plant)
    return estimate(system, [record for _, record in read], geometry)


def shares_allowed(robot: str, log: TrueLog) -> dict[str, float]:
    """Error of each estimate from a log that has an interval, relative to half of that."""
    entry = ROBOTS[robot]
    plant = entry.make(entry.parameters()).plant(entry.parameters())
    result = estimate_of(log.rows, robot, plant)
    shares = dict[str, float]()
    told = [*result.found, *([result.delay] if result.delay else [])]
    for each in (each for each in told if np.isfinite(each.high)):
        true = log.true[each.name] + sum(share * log.true[name] for name, share in each.others)
        shares[each.name] = 2 * abs(each.value - true) / (each.high - each.low)
    return shares
