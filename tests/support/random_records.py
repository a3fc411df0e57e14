"""Random checks and records of runs, for comparing what evaluates them."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from onpath.lessons.action_schema import RobotName
from onpath.lessons.record import QUANTITIES, ROBOTS, Happening, Record
from onpath.lessons.task_schema import Bound, Check, Compare, Event, Only, Order, Setting, Stat
from onpath.models.systems.catalogue import ROBOTS as CATALOGUE

EVENTS = ("hold", "let_go", "pull", "release", "set", "path", "reset", "diverged")
STATS: tuple[Stat, ...] = ("max", "min", "mean", "rms", "final", "settling", "overshoot")
DURING = ("always", "held", "pulled", "free", "released")
CHANGED = ("K1", "K2", "stiction", "path", "left")
GAINS = (5e-7, 0.005, 400.0, 600.1, 600.7, 1600.5)
PLACES = ("left", "right", "path", "robot", "length", "K1", "K2", "task", "encoder_counts")


def some_record(rng: np.random.Generator) -> Record:
    """A record of up to 400 instants, mostly a 60th of a second long."""
    count = int(rng.choice([0, 1, 5, 30, 150, 400]))
    steps = np.where(rng.random(count) < 0.9, 1 / 60, rng.choice([0.1, 0.05, 0.017], count))
    times = np.concatenate([[0.0], np.cumsum(steps)])[:count]
    own = list(QUANTITIES)[: int(rng.integers(1, len(QUANTITIES) + 1))]
    entry = CATALOGUE["five_bar"]
    gains: dict[str, Any] = {name: float(rng.choice(GAINS)) for name in ("K1", "K2")}
    counts = int(rng.choice([0, 2000]))
    changed = tuple(map(str, rng.choice(CHANGED, int(rng.integers(3)), replace=False)))
    return Record(
        times=times,
        values=some_columns(rng, count, own),
        happenings=some_happenings(rng, times, float(steps.sum())),
        run=1,
        parameters=replace(entry.parameters(), **gains, encoder_counts=counts),
        end=float(times[-1] + rng.choice([1 / 60, 0.0, 0.1])) if count else 0.0,
        path=str(rng.choice(["circle", "ellipse", "edited"])),
        laws={"left": str(rng.choice(["trajectory_tracking", "set_point"]))},
        length=lambda: 314.159,
        changed=lambda: changed,
    )


def some_columns(
    rng: np.random.Generator, count: int, names: list[str]
) -> dict[RobotName, dict[str, np.ndarray]]:
    """Quantities of both robots; sometimes those of one are a multiple of the other's."""
    scale = float(rng.choice([1e-4, 1.0, 50.0]))
    tracker, follower = ({name: some_values(rng, count, scale) for name in names} for _ in range(2))
    if rng.random() < 0.2:
        divisor = float(rng.choice([1.0, 1.5, 1000.0, 1000.5]))
        follower = {name: values / divisor for name, values in tracker.items()}
    return {"tracker": tracker, "follower": follower}


def some_values(rng: np.random.Generator, count: int, scale: float) -> np.ndarray:
    """Numbers, some of them with few digits, so that roundings meet ties and bounds."""
    values = scale * rng.normal(size=count)
    if rng.random() < 0.3:  # it settles, or just does not
        left = rng.choice([0.045, 0.055, 0.065]) * np.abs(values).max(initial=0.0)
        values[count // 2 :] = left
    return np.where(rng.random(count) < 0.3, np.round(4 * values) / 4, values)


def some_happenings(
    rng: np.random.Generator, instants: np.ndarray, end: float
) -> tuple[Happening, ...]:
    """Events of this run and of the one before, some of them at an instant of the record."""
    times = rng.uniform(0, end + 0.1, int(rng.integers(0, 9)))
    if len(instants):
        times = np.where(rng.random(len(times)) < 0.5, rng.choice(instants, len(times)), times)
    times.sort()
    names = rng.choice(EVENTS, len(times), p=[0.2, 0.2, 0.2, 0.2, 0.1, 0.05, 0.03, 0.02])
    return tuple(
        Happening(
            run=int(rng.random() < 0.8),
            time=float(time),
            name=str(name),
            detail=str(rng.choice(["K1", "K2"])) if name == "set" else "",
            robots=ROBOTS if rng.random() < 0.7 else (ROBOTS[int(rng.integers(2))],),
        )
        for time, name in zip(times, names, strict=True)
    )


def some_check(rng: np.random.Generator) -> Check:
    """A check of any kind."""
    kind = rng.choice(
        ["bound", "compare", "event", "order", "setting", "only"],
        p=[0.45, 0.2, 0.1, 0.1, 0.1, 0.05],
    )
    robot: Any = ROBOTS[int(rng.integers(2))]
    quantity, stat = str(rng.choice(list(QUANTITIES))), STATS[int(rng.integers(len(STATS)))]
    during: Any = str(rng.choice(DURING))
    last = float(rng.choice([0.0, 0.1, 0.1005, 0.5, 2.0]))
    least = float(rng.choice([0.05, 0.1000005, 0.105, 0.25, 1.0, 2.5]))
    window: dict[str, Any] = {"during": during, "last": last, "least": least}
    bounds: dict[str, Any] = {**some_bounds(rng)}
    if kind == "bound":
        return Bound(**window, quantity=quantity, robot=robot, stat=stat, **bounds)
    if kind == "compare":
        ratio = float(rng.choice([1.0, 1.5, 30.0]))
        return Compare(**window, quantity=quantity, larger=robot, stat=stat, ratio=ratio)
    event: Any = str(rng.choice(EVENTS))
    name = "K1" if event == "set" and rng.random() < 0.5 else ""
    if kind == "event":
        since = tuple(map(str, rng.choice(["reset", "set", "set:K2", event], int(rng.integers(3)))))
        return Event(event=event, name=name, times=int(rng.integers(1, 4)), since=since)
    if kind == "order":
        return Order(events=tuple(map(str, rng.choice([*EVENTS[:5], "set:K1"], 3))))
    if kind == "only":
        return Only(tuple(map(str, rng.choice(CHANGED, 3, replace=False))))
    return some_setting(rng, bounds)


def some_setting(rng: np.random.Generator, bounds: dict[str, float]) -> Setting:
    """A check of a setting that the five-bar robot has."""
    name = str(rng.choice(PLACES))
    wanted: dict[str, Any] = {
        "left": "set_point",
        "right": "path_following",
        "path": str(rng.choice(["ellipse", "own"])),
        "robot": "five_bar",
        "task": "speed",
        "K1": int(rng.choice([600, 0])),
        "K2": 1600.5,
        "encoder_counts": int(rng.choice([0, 2001])),
    }
    if name in wanted and rng.random() < 0.7:
        return Setting(name=name, equals=wanted[name])
    return Setting(name=name, **bounds)


def some_bounds(rng: np.random.Generator) -> dict[str, float]:
    """One bound or two."""
    low, high = sorted(float(each) for each in rng.choice([-20, -1, 0, 0.003, 0.5, 12, 600], 2))
    ways = int(rng.integers(3))
    return ({} if ways == 0 else {"above": low}) | ({} if ways == 1 else {"below": high})
