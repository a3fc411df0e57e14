"""An arena: the same trials for all laws, with the same model, motors, limits and random numbers.

Every law enters twice where it can: with torques that are cut at the limit, and with the remedy
across_first, which is not part of any law. A trial has a robot, a path, an obstruction and a
condition, and is an `Experiment`: `onpath experiment` repeats it.
"""

from __future__ import annotations

import dataclasses
import math
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from types import MappingProxyType
from typing import Any
from zlib import crc32

import msgspec
import numpy as np
from numpy.typing import NDArray

from onpath.models.arrays import Array
from onpath.models.closed_loop.kernel import Kernel
from onpath.models.closed_loop.loops import Loop
from onpath.models.closed_loop.trajectory import Trajectory
from onpath.models.control.laws.registry import LAWS, law_named
from onpath.models.control.settable import specs
from onpath.models.errors import Message, message_of
from onpath.models.paths.curve_faults import curve_faults
from onpath.models.studies.experiments import Experiment, experiments, run
from onpath.models.studies.path_text import curve_from_text
from onpath.models.systems.catalogue import ROBOTS

ROBOT_NAMES = ("five_bar", "two_link_arm")
PATHS = ("circle", "ellipse", "rounded square")
CONDITIONS = ("exact", "payload", "noise", "slow")
OBSTRUCTIONS = ("pull", "brake", "hand", "wall", "weak")
OFF = 0.005  # [m] from which on a robot counts as off its path
RESERVE = 1.5  # ratio of the torque limit to what undisturbed path following needs
WEAK = 0.6  # ratio of the limit of weak motors to that limit; it is 0.9 times what is needed
LASTS, RATE = 5.0, 2.0  # duration of a pull, [s], and growth of its force, [N/s]
ACTS, AFTER = 1.0, 2.0  # duration of the other obstructions, and of the run after them, [s]
EVERY = 20  # [ms] between the points of a run that is shown
MOST_LOOPS = 16
NO_SETTINGS: Mapping[str, Any] = MappingProxyType({})

Row = tuple[str, bool | None]
"""A row of the table: a law, and whether the remedy acts; None if it commands torques."""


@dataclass(frozen=True, slots=True)
class Trial:
    """What happens to every law.

    Attributes:
        number: in the order of the trials.
        robot, path, obstruction, condition: their names.
        values: parameters and schedule by name, as for `onpath experiment --set`.
        released: time at which the obstruction ends, [s]; None if it lasts.
    """

    number: int
    robot: str
    path: str
    obstruction: str
    condition: str
    values: Mapping[str, Any]
    released: float | None

    def settings(self, remedy: bool) -> dict[str, Any]:
        """The values, with what happens at the torque limit."""
        return {**self.values, "at_limit": "across_first" if remedy else "cut"}

    def experiment(self, remedy: bool) -> Experiment:
        """The experiment of a trial."""
        plain = experiments(self.robot)["obstruction"]
        moved = plain.along(curve_from_text(self.path, plain.schedule.r), self.path)
        return moved.with_values(self.settings(remedy))


@dataclass(frozen=True, slots=True, eq=False)
class Result:
    """One law in one trial; measures that do not apply to the trial are None.

    Attributes:
        law: name of the law.
        remedy: whether across_first acts at the torque limit; None for a law that commands torques.
        trial: the trial.
        force_N: force of the hand, pulling across, at which the robot is first 5 mm off its path;
            infinity if it never is.
        distance_m: largest distance to the path.
        delay_s: by how much it is late at the end, at the wanted speed; negative: early.
        energy_J: largest work of the end-point on the hand, brake or wall.
        overshoot_m: largest distance after the release, from the first minimum below 5 mm on;
            infinity if it does not come back.
        stopped_at_s: time at which the run was stopped as diverged, or None.
        reason: why.
        shown: (t [s], distance [m], z1, z2 [m]) at the largest distance in each 20 ms, (k, 4).
    """

    law: str
    remedy: bool | None
    trial: Trial
    force_N: float | None = None
    distance_m: float | None = None
    delay_s: float | None = None
    energy_J: float | None = None
    overshoot_m: float | None = None
    stopped_at_s: float | None = None
    reason: str | Message = ""
    shown: Array = dataclasses.field(default_factory=lambda: np.zeros((0, 4)))

    @property
    def row(self) -> Row:
        """The row of the table that it belongs to."""
        return self.law, self.remedy

    def data(self) -> dict[str, Any]:
        """What the run has given, as numbers and texts."""
        reason = self.reason
        told = msgspec.to_builtins(reason) if isinstance(reason, Message) else reason
        measures = {name: getattr(self, name) for name in (*STEPS, "stopped_at_s")}
        return {**measures, "reason": told, "shown": self.shown.tolist()}


def result_from(data: Mapping[str, Any], row: Row, trial: Trial) -> Result:
    """The inverse of `Result.data`."""
    told, shown = data["reason"], np.array(data["shown"]).reshape(-1, 4)
    reason = told if isinstance(told, str) else msgspec.convert(told, Message)
    values: dict[str, Any] = {**data, "reason": reason, "shown": shown}
    return Result(*row, trial, **values)


STEPS = {
    "force_N": 0.01,
    "distance_m": 1e-5,
    "delay_s": 0.01,
    "energy_J": 1e-4,
    "overshoot_m": 1e-5,
}
"""Measure -> resolution to which it is shown and ranked."""
MEASURES = tuple(STEPS)
LARGER_IS_BETTER = ("force_N",)


@dataclass(frozen=True, slots=True)
class Cell:
    """A measure of a row.

    Attributes:
        worst: its worst value over the runs that were not stopped, None if there is none.
        median: its median over them.
        rank: place among the rows of the robot, from 1; equal values share one. Rows with a run
            that was stopped come after all others.
        of: number of the worst run in the results.
    """

    worst: float | None
    median: float | None
    rank: int
    of: int | None


def trials_of(
    robots: Sequence[str], rounds: int, seed: int, settings: Mapping[str, Any] = NO_SETTINGS
) -> list[list[Trial]]:
    """The trials of each round: every obstruction of every robot once.

    The first round is on the circle with an exact model. Paths and conditions of the other rounds
    are random, and so are places and directions of all obstructions. A robot's trials depend
    neither on the other robots nor on the number of rounds.

    Args:
        seed: 0 or more.
        settings: parameters of the robots in all trials, by name, unless a trial draws them.

    Raises:
        ValueError: an unknown parameter, or a robot that can follow none of the paths.
    """
    found, number = list[list[Trial]](), 0
    for round_number in range(rounds):
        trials = list[Trial]()
        for robot in robots:
            for which, obstruction in enumerate(OBSTRUCTIONS):
                numbers = [seed, crc32(robot.encode()), round_number, which]
                draw, number = np.random.default_rng(numbers), number + 1
                trial = _trial(number, robot, obstruction, draw, plain=round_number == 0)
                trials.append(dataclasses.replace(trial, values={**settings, **trial.values}))
        found.append(trials)
    return found


def _trial(
    number: int, robot: str, obstruction: str, draw: np.random.Generator, plain: bool
) -> Trial:
    """A random trial; a plain one is on the circle, with an exact model."""
    possible, paths = _possible(robot, obstruction), paths_of(robot)
    path = paths[0 if plain else int(draw.integers(len(paths)))]
    condition = "exact" if plain else possible[int(draw.integers(len(possible)))]
    given, released = _drawn(robot, path, obstruction, condition, draw)
    return Trial(
        number=number,
        robot=robot,
        path=path,
        obstruction=obstruction,
        condition=condition,
        values=given,
        released=released,
    )


def paths_of(robot: str) -> list[str]:
    """The paths of `PATHS` that a robot can follow.

    Raises:
        ValueError: there is none.
    """
    known = ROBOTS[robot].make(ROBOTS[robot].parameters())
    curves = {each: curve_from_text(each, known.radius) for each in PATHS}
    paths = [each for each in PATHS if not curve_faults(known.margin, curves[each])]
    if not paths:
        raise ValueError(f"{robot}: it can follow none of {', '.join(PATHS)}")
    return paths


def _possible(robot: str, obstruction: str) -> list[str]:
    """The conditions. A payload alone may keep a robot off its path, so a pull has none."""
    loaded = "payload" in specs(ROBOTS[robot].parameters) and obstruction != "pull"
    return [each for each in CONDITIONS if loaded or each != "payload"]


def _drawn(
    robot: str, path: str, obstruction: str, condition: str, draw: np.random.Generator
) -> tuple[dict[str, float], float | None]:
    """The values of a random trial, and when its obstruction ends."""
    entry = ROBOTS[robot]
    curve, speed = curve_from_text(path, entry.radius), entry.parameters().speed
    begin = float(np.round(draw.uniform(0.5, 1.5), 3))
    sign, angle = float(draw.choice((-1, 1))), float(draw.uniform(-np.pi, np.pi))
    reach, noise = float(draw.uniform(0.02, 0.04)), float(draw.integers(10_000))
    end, share = begin + ACTS, WEAK if obstruction == "weak" else 1.0
    theta = speed * begin
    place, first = curve.at(np.array(theta)), curve.at(np.array(theta + 0.2), 1)
    hand = place + reach * np.array([np.cos(angle), np.sin(angle)])
    wall = curve.at(np.array(theta + 0.2))
    acting: dict[str, dict[str, float]] = {
        "pull": {"pull_from": 0.5, "pull_to": 0.5 + LASTS, "pull_rate": sign * RATE},
        "brake": {"hold_from": begin, "hold_to": end},
        "hand": {"push_from": begin, "push_to": end, "push_z1": hand[0], "push_z2": hand[1]},
        "wall": {"wall_from": begin, "wall_to": end, "wall_z1": wall[0], "wall_z2": wall[1]}
        | {"wall_angle": float(np.arctan2(-first[1], -first[0]))},
        "weak": {},
    }
    under: dict[str, dict[str, float]] = {
        "exact": {},
        "payload": {"payload": _on(robot, "payload")},
        "noise": {"sensor_noise": 1e-4, "encoder_counts": 4000.0, "seed": noise},
        "slow": {"control_rate": 100.0},
    }
    lasts = 0.5 + LASTS if obstruction == "pull" else end + AFTER
    values = {"hold_from": 0.0, "hold_to": 0.0, "duration": lasts, **acting[obstruction]}
    values |= {"start_along": float(speed * np.linalg.norm(curve.at(np.array(0.0), 1)))}
    values |= {"torque_limit": share * _limit(robot, path), **under[condition]}
    released = end if obstruction in ("brake", "hand", "wall") else None
    short = {name: float(f"{value:.4g}") for name, value in values.items()}
    return {n: int(x) if x.is_integer() else x for n, x in short.items()}, released


def _on(robot: str, name: str) -> float:
    return float(specs(ROBOTS[robot].parameters)[name].on or 0.0)


@lru_cache(maxsize=64)
def _limit(robot: str, path: str) -> float:
    """The torque limit of a robot on a path: `RESERVE` times what path following needs there."""
    usual = experiments(robot)["obstruction"]
    plain = usual.along(curve_from_text(path, usual.schedule.r), path)
    free = plain.with_values({"hold_from": 0, "hold_to": 0, "duration": 2, "ramp": 10})
    moved = run_under(free, "path_following")
    strength = np.array(plain.robot().system.strength)
    least = float((np.abs(moved.fields["u"]) / strength).max())
    return min(RESERVE * least, specs(plain.parameters)["torque_limit"].high)


def entrants(robot: str, asked: Sequence[str] = (), only: bool = False) -> list[Row]:
    """The rows of a robot: the laws asked for, then OnPath's laws that move along a path.

    Args:
        only: whether to leave out OnPath's laws that were not asked for.
    """
    machine = ROBOTS[robot].make(ROBOTS[robot].parameters())
    composite = getattr(ROBOTS[robot].parameters(), "output", "") == "composite"
    rows = list[Row]()
    for name in dict.fromkeys([*asked, *(() if only else LAWS)]):
        law = law_named(name)
        if law.origin is not None and name not in asked:
            continue
        if not (law.travels and law.suits(machine.system)):
            continue
        if law.commands_acceleration:
            rows += [(name, False), (name, True)]
        elif not composite:
            rows.append((name, None))
    return rows


def run_under(experiment: Experiment, law: str) -> Trajectory:
    """Run an experiment under a law, in a compiled loop that is kept.

    Raises:
        ValueError: see `experiments.run`.
    """
    return run(experiment, law, _loop)


@lru_cache(maxsize=MOST_LOOPS)
def _loop(kernel: Kernel) -> Loop:
    """The fastest loop of a kernel."""
    from onpath.models.closed_loop.translated_loop import fastest_loop  # loads LLVM

    return fastest_loop(kernel)


def result_of(row: Row, trial: Trial) -> Result:
    """The result of a row in a trial. An error in the law counts as a stop at the start."""
    law, remedy = row
    experiment = trial.experiment(bool(remedy))
    try:
        moved = run_under(experiment, law)
    except ValueError as error:
        return Result(law, remedy, trial, stopped_at_s=0.0, reason=message_of(error))
    return measured(law, remedy, trial, experiment, moved)


def measured(
    law: str, remedy: bool | None, trial: Trial, experiment: Experiment, moved: Trajectory
) -> Result:
    """The measures of a run."""
    z = experiment.robot().frame.planar(moved.fields["y"])
    rows = np.column_stack([moved.t, moved.distance, z])
    shown = rows[[part[rows[part, 1].argmax()] for part in _parts(len(rows))]]
    result = Result(law=law, remedy=remedy, trial=trial, shown=shown)
    distance, force, y = moved.distance, moved.fields["force"], moved.fields["y"]
    off = distance > OFF
    if trial.obstruction == "pull" and off.any():  # what a stronger pull does is not measured
        return dataclasses.replace(result, force_N=float(np.linalg.norm(force[off.argmax()])))
    if moved.stopped_at is not None:
        return dataclasses.replace(result, stopped_at_s=moved.stopped_at, reason=moved.reason)
    if trial.obstruction == "pull":
        return dataclasses.replace(result, force_N=np.inf)
    steps = np.diff(y, axis=0, append=y[-1:])
    given = -np.cumsum((force * steps).sum(1))
    speed, theta = experiment.parameters.speed, moved.fields["theta"][:, 0]
    delay = float(moved.t[-1] - (theta[-1] - theta[0]) / speed)
    released = trial.released
    return dataclasses.replace(
        result,
        distance_m=float(distance.max()),
        delay_s=delay,
        energy_J=None if released is None else max(float(given.max()), 0.0),
        overshoot_m=None if released is None else _overshoot(distance[moved.t >= released]),
    )


def _parts(count: int) -> list[NDArray[np.int_]]:
    """Consecutive rows, at most `EVERY` in each part."""
    rows = np.arange(count)
    return [rows[begin : begin + EVERY] for begin in range(0, count, EVERY)]


def _overshoot(distance: Array) -> float:
    """The largest distance from the first minimum below `OFF` on; infinity if there is none."""
    back = (distance <= OFF) & (np.diff(distance, append=np.inf) >= 0)
    return float(distance[back.argmax() :].max()) if back.any() else np.inf


def table(rows: Sequence[Row], results: Sequence[Result]) -> dict[Row, dict[str, Cell]]:
    """The cells of the rows of one robot.

    Args:
        results: of all rows in the same trials.
    """
    stops = {row: stopped(row, results) > 0 for row in rows}
    cells: dict[Row, dict[str, Cell]] = {row: {} for row in rows}
    for name in MEASURES:
        worst = {row: _worst(row, name, results) for row in rows}
        keys = {row: (stops[row], *_badness(name, worst[row][0])) for row in rows}
        order = sorted(keys.values())
        for row in rows:
            value, median, of = worst[row]
            cells[row][name] = Cell(value, median, order.index(keys[row]) + 1, of)
    return cells


def _badness(name: str, value: float | None) -> tuple[bool, float]:
    """Sort key of a measure, the best first; a missing value comes last."""
    if value is None:
        return True, 0.0
    steps = abs(value) if math.isinf(value) else float(round(abs(value) / STEPS[name]))
    return False, -steps if name in LARGER_IS_BETTER else steps


def complete(
    rows: Mapping[str, Sequence[Row]], results: Sequence[Result]
) -> dict[str, list[Result]]:
    """The results by robot, of the trials that all of its rows have finished."""
    found = dict[str, list[Result]]()
    for robot, wanted in rows.items():
        own = [each for each in results if each.trial.robot == robot]
        count = Counter(each.trial.number for each in own)
        kept = [each for each in own if count[each.trial.number] == len(wanted)]
        if kept:
            found[robot] = sorted(kept, key=lambda each: each.trial.number)
    return found


def stopped(row: Row, results: Sequence[Result]) -> int:
    """How many runs of a row were stopped."""
    return sum(each.stopped_at_s is not None for each in results if each.row == row)


def _worst(
    row: Row, name: str, results: Sequence[Result]
) -> tuple[float | None, float | None, int | None]:
    """The worst value of a measure in a row, its median, and the number of the worst result."""
    runs = {i: getattr(each, name) for i, each in enumerate(results) if each.row == row}
    values: dict[int, float] = {i: value for i, value in runs.items() if value is not None}
    if not values:
        return None, None, None
    choose = min if name in LARGER_IS_BETTER else max
    of = choose(values, key=lambda i: abs(values[i]))
    return values[of], float(np.median([*values.values()])), of
