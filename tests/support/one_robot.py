"""One robot under one law, stepped manually, with every millisecond recorded."""

from __future__ import annotations

from functools import cache, lru_cache
from typing import Any

import numpy as np

from onpath.models.arrays import Array
from onpath.models.closed_loop.loop_kind import Kind
from onpath.models.closed_loop.loops import Loop
from onpath.models.closed_loop.simulation import (
    FREE,
    TICK,
    Push,
    brake_at,
    first_state,
    kernel_of,
    kind_of,
    settings_vector,
)
from onpath.models.closed_loop.translated_loop import translate_loop
from onpath.models.control.settable import with_values
from onpath.models.paths.curves import circle
from onpath.models.paths.distance import path_distance
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.robots import Robot

FOLLOWER, TRACKER = "path_following", "trajectory_tracking"
CURVE = circle(0.05)
FAST = 6.28  # [rad/s], the speed in the scripts of lesson 5
LENGTH = 2.2  # [s], duration of a hold


@lru_cache
def _loop(robot: Robot, kind: Kind) -> Loop:
    return translate_loop(kernel_of(robot, kind))


class Driven:
    """A robot that starts at rest at the right-hand end of the default circle, and its log.

    Args:
        who: name of the law.
        robot: name of the robot.
        settings: parameters that differ from the lab's.
    """

    def __init__(self, who: str = FOLLOWER, robot: str = "five_bar", **settings: object) -> None:
        self.who, self.push, self.time = who, FREE, 0.0
        self.parameters = with_values(ROBOTS[robot].parameters(), settings)
        self.robot = ROBOTS[robot].make(self.parameters)
        kernel = kernel_of(self.robot, kind_of(who, self.parameters, CURVE))
        begin = self.robot.frame.lift(CURVE.at(np.array(0.0)))
        self.state = first_state(self.robot, kernel, CURVE, self.robot.rest(begin))
        self.stopped: float | None = None
        self._layout, self._log = kernel.state, kernel.log
        self._rows = list[Array]()

    # Actions

    def run(self, until: float) -> Driven:
        """Simulate until an instant, [s]; no effect once the robot has been stopped."""
        ticks = round((until - self.time) / TICK)
        if self.stopped is None and ticks > 0:
            kind = kind_of(self.who, self.parameters, CURVE)
            loop = _loop(self.robot, kind)
            settings = settings_vector(self.robot, loop.layouts, self.parameters, CURVE, self.push)
            self.state, rows = loop.run(self.state, settings, CURVE.table(), ticks)
            fields = self._log.unpack(rows)
            fault = self.robot.fault(fields["q"], fields["v"], self.parameters)
            if fault is not None:
                self.stopped = self.time + fault[0] * TICK
            self._rows.append(rows[: None if fault is None else fault[0]])
        self.time = until
        return self

    def set(self, **settings: object) -> Driven:
        """Change parameters from now on."""
        self.parameters = with_values(self.parameters, settings)
        return self

    def hold(self) -> Driven:
        """Apply the brake at the current position."""
        self.push = Push(hold=brake_at(self.robot, CURVE, self.y, self.place))
        return self

    def pull(self, right: float, up: float) -> Driven:
        """Pull from now on towards a point relative to the end-point, [mm]."""
        away = np.array([right, up]) / 1e3
        frame = self.robot.frame
        self.push = Push(hand=self.y + frame.lift(away) - frame.lift(np.zeros(2)))
        return self

    def let_go(self) -> Driven:
        """Release the hand or the brake."""
        self.push = FREE
        return self

    # Current state

    @property
    def q(self) -> Array:
        """Configuration, (n,)."""
        return self._layout.unpack(self.state)["q"]

    @property
    def v(self) -> Array:
        """Velocity of the configuration, (n,)."""
        return self._layout.unpack(self.state)["v"]

    @property
    def y(self) -> Array:
        """Position of the end-point, (p,), [m]."""
        return self.robot.endpoint(self.q)

    @property
    def place(self) -> float:
        """Path parameter theta of the closest point, [rad]."""
        return float(self._layout.unpack(self.state)["theta"][0])

    # Log, one value per millisecond

    def log(self, name: str) -> Array:
        """A field of the log, (ticks, size), in SI units."""
        return self._log.unpack(np.concatenate(self._rows))[name]

    @property
    def distance(self) -> Array:
        """Distance of the actual end-point to the path, (ticks,), [mm]."""
        return 1e3 * path_distance(self.robot.frame, CURVE, self.log("y"))

    @property
    def across(self) -> Array:
        """Transverse error of the controlled output, (ticks,), [mm]."""
        return 1e3 * np.linalg.norm(self.log("xi"), axis=1)

    @property
    def torque(self) -> Array:
        """The larger motor torque, (ticks,), [N m]."""
        return np.abs(self.log("u")).max(axis=1)

    @property
    def deflection(self) -> Array:
        """Deflection of the flexible link's tip, (ticks,), [mm]."""
        return self._measured("deflection")

    @property
    def energy(self) -> Array:
        """Vibration energy of the flexible link, (ticks,), [mJ]."""
        return self._measured("internal_energy")

    def _measured(self, name: str) -> Array:
        """One of `Robot.extras`, (ticks,), in thousandths."""
        found = self.robot.measured(self.log("q"), self.log("v"), self.parameters)
        return 1e3 * found[name][:, 0]


def largest(values: Array, begin: float, end: float) -> float:
    """Largest absolute value between two instants, [s]."""
    return float(np.abs(values[round(begin / TICK) : round(end / TICK)]).max())


def at(values: Array, time: float) -> float:
    """Value at an instant, [s]."""
    return float(values[round(time / TICK)])


@cache
def undisturbed_theta(law: str, **gains: Any) -> Array:
    """Path parameter theta of an undisturbed robot, every millisecond for 5 s."""
    return Driven(law, speed=FAST, **gains).run(5.0).log("theta")[:, 0]


@cache
def held_at(degrees: float, law: str = FOLLOWER, **gains: Any) -> Driven:
    """A robot that the brake catches at an angle of the circle, after at least 3 s."""
    away = np.abs(
        np.exp(1j * undisturbed_theta(law, **gains)[3000:]) - np.exp(1j * np.radians(degrees))
    )
    begin = 3 + 1e-3 * int(np.argmax(away < 0.005))
    return Driven(law, speed=FAST, **gains).run(begin).hold().run(begin + LENGTH)


@cache
def most_and_rest(degrees: float, law: str = FOLLOWER, **gains: Any) -> tuple[float, float]:
    """Largest distance during the hold, and distance at its end, [mm]."""
    distance = held_at(degrees, law, **gains).distance[-round(1e3 * LENGTH) :]
    return float(distance.max()), float(distance[-1])
