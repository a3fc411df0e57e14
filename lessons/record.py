"""What happened in a run, as the checks look at it."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from onpath.lessons.schema import RobotName, Window
from onpath.models.arrays import Array
from onpath.models.systems.parameters import Parameters

Mask = NDArray[np.bool_]
ROBOTS: tuple[RobotName, ...] = ("tracker", "follower")
ROLES: dict[str, RobotName] = {
    "path_following": "follower",
    "trajectory_tracking": "tracker",
}
"""Controller -> robot, as the lessons call it."""
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
"""Name -> unit."""
PLOTS = (
    *("speed", "torques", "across", "across_rate", "place", "rate", "force"),
    *("modes", "deflection", "energy"),
)
"""Names of the plots a scene can ask for."""


@dataclass(frozen=True, slots=True)
class Happening:
    """Something that was done, or that came about.

    Attributes:
        run: how often the lab had been reset before.
        time: simulated, [s].
        name: one of lessons.schema.EventName.
        detail: the parameter, the path, the robot; or empty.
        robots: whom it concerns.
    """

    run: int
    time: float
    name: str
    detail: str = ""
    robots: tuple[RobotName, ...] = ROBOTS


@dataclass(frozen=True, slots=True, eq=False)
class Record:
    """A run since a step began or the last reset.

    Attributes:
        times: shape (n,), [s], rising; each instant lasts until the next one.
        values: robot -> quantity -> shape (n,), in the units of QUANTITIES.
        happenings: since the step began, in order; those before the last reset too.
        run: the present one.
        parameters: as they are now.
        end: when the last instant ends, [s].
        path, robot: names of what is followed and who follows.
    """

    times: Array
    values: dict[RobotName, dict[str, Array]]
    happenings: tuple[Happening, ...]
    run: int
    parameters: Parameters
    end: float
    path: str = "circle"
    robot: str = "five_bar"
    _masks: dict[tuple[RobotName, str], Mask] = field(
        default_factory=dict[tuple[RobotName, str], Mask]
    )

    def chosen(self, robot: RobotName, window: Window) -> Mask:
        """Which instants count, booleans, shape (n,); the latest ones last as long as asked."""
        held = self._during(robot, "hold", "let_go")
        pulled = self._during(robot, "pull", "release")
        chosen: Mask = {
            "always": np.ones(len(self.times), dtype=bool),
            "held": held,
            "pulled": pulled,
            "free": ~(held | pulled),
        }[window.during]
        if window.last > 0:
            steps: Array = chosen * self._steps()
            later: Array = np.cumsum(steps[::-1])[::-1] - steps
            chosen = chosen & (later < window.last - 1e-9)
        return chosen

    def stopped(self, robot: RobotName) -> bool:
        """Whether a robot stands still because the simulation had to stop."""
        return any(
            event.name == "diverged" and event.run == self.run and robot in event.robots
            for event in self.happenings
        )

    def seconds(self, chosen: Mask) -> float:
        """How long the chosen instants last, [s]."""
        return float(self._steps()[chosen].sum())

    def _steps(self) -> Array:
        return np.diff(self.times, append=self.end).clip(0.0)

    def _during(self, robot: RobotName, begin: str, end: str) -> Mask:
        """Instants between two happenings of this run."""
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
