"""The record of a run that the checks evaluate."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from onpath.lessons.action_schema import RobotName
from onpath.lessons.task_schema import Better, Once, Window
from onpath.models.arrays import Array
from onpath.models.systems.parameters import Parameters

Mask = NDArray[np.bool_]
ROBOTS: tuple[RobotName, ...] = ("tracker", "follower")
QUANTITIES: dict[str, str] = {
    "distance": "mm",
    "lag": "mm",
    "speed": "mm/s",
    "rate": "rad/s",
    "place": "rad",
    "across": "mm",
    "across_rate": "mm/s",
    "torque": "N m",
    "force": "N",
    "deflection": "mm",
    "energy": "mJ",
}
"""Quantity -> unit."""
PLOTS = (
    *("phase", "speed", "torques", "across", "across_rate", "place", "rate", "force"),
    *("modes", "deflection", "energy"),
)
"""Names of the plots that a scene may show."""


@dataclass(frozen=True, slots=True)
class Happening:
    """An event of a run.

    Attributes:
        run: number of resets before it.
        time: simulated time, [s].
        name: one of lessons.task_schema.EventName.
        detail: name of the parameter, the path or the robot; or empty.
        robots: the robots concerned.
    """

    run: int
    time: float
    name: str
    detail: str = ""
    robots: tuple[RobotName, ...] = ROBOTS


@dataclass(frozen=True, slots=True, eq=False)
class Record:
    """The record since a step began or since the last reset, whichever is later.

    Attributes:
        times: shape (n,), [s], increasing; each instant lasts until the next one.
        values: robot -> quantity -> shape (n,), in the units of QUANTITIES.
        happenings: all events since the step began, in order, including those before the last
            reset.
        run: number of the current run.
        parameters: their current values.
        end: end of the last instant, [s].
        path, robot: names of the path and of the robot model.
        laws: current control law of each side; a side without one has that of a new lab.
        length: returns the length of the path, [mm].
        changed: returns the names of the settings that differ from the step's setup, as in `Only`.
        before: values measured earlier; see `lessons.measures.earlier_run`.
    """

    times: Array
    values: dict[RobotName, dict[str, Array]]
    happenings: tuple[Happening, ...]
    run: int
    parameters: Parameters
    end: float
    path: str = "circle"
    robot: str = "five_bar"
    laws: dict[str, str] = field(default_factory=dict[str, str])
    length: Callable[[], float] = float
    changed: Callable[[], tuple[str, ...]] = tuple
    before: Mapping[Better | Once, float] = field(default_factory=dict[Better | Once, float])
    _masks: dict[tuple[RobotName, str], Mask] = field(
        default_factory=dict[tuple[RobotName, str], Mask]
    )

    def chosen(self, robot: RobotName, window: Window) -> Mask:
        """The instants that a window selects, shape (n,).

        `window.during` selects by hold and pull; `window.last` is the number of latest seconds to
        keep.
        """
        held = self._during(robot, "hold", "let_go")
        pulled = self._during(robot, "pull", "release")
        free = ~(held | pulled)
        chosen: Mask = {
            "always": np.ones(len(self.times), dtype=bool),
            "held": held,
            "pulled": pulled,
            "free": free,
            "released": free & np.logical_or.accumulate(~free),
        }[window.during]
        if window.last > 0:
            steps: Array = chosen * self._steps()
            later: Array = np.cumsum(steps[::-1])[::-1] - steps
            chosen = chosen & (later < window.last - 1e-9)
        return chosen

    def stopped(self, robot: RobotName) -> bool:
        """Whether the simulation of a robot was stopped in this run because it diverged."""
        return any(
            event.name == "diverged" and event.run == self.run and robot in event.robots
            for event in self.happenings
        )

    def seconds(self, chosen: Mask) -> float:
        """Total duration of the chosen instants, [s]."""
        return float(self._steps()[chosen].sum())

    def _steps(self) -> Array:
        """Duration of every instant, shape (n,), [s]."""
        return np.diff(self.times, append=self.end).clip(0.0)

    def _during(self, robot: RobotName, begin: str, end: str) -> Mask:
        """Instants between two kinds of events in this run, shape (n,)."""
        if (robot, begin) not in self._masks:
            mask = np.zeros(len(self.times), dtype=bool)
            since: float | None = None
            for event in self.happenings:
                if event.run != self.run or robot not in event.robots:
                    continue
                if event.name == begin and since is None:
                    since = event.time
                elif event.name == end and since is not None:
                    mask |= (self.times >= since) & (self.times < event.time)
                    since = None
            if since is not None:
                mask |= self.times >= since
            self._masks[robot, begin] = mask
        return self._masks[robot, begin]
