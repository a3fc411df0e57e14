"""The events of an experiment over time: start, brake, hand, wall, and wanted speed."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from onpath.models.closed_loop.obstacles import DIRECTIONS, FARTHEST, Wall
from onpath.models.closed_loop.speed_profile import SpeedProfile, profile_from
from onpath.models.systems.parameter_specs import number_of

_TIMES = ("hold", "push", "wall", "pull")


@dataclass(frozen=True, slots=True)
class Schedule:
    """The settings of an experiment besides the robot's parameters.

    Attributes:
        r: radius of the path, [m].
        duration: [s].
        start_z1, start_z2: position of the end-point at the start, in the path's plane, [m]; None:
            as in the experiment.
        start_along, start_across: its velocity at the start along the path's tangent and normal (to
            the left) at the closest point, [m/s].
        clock_offset: lead of the reference point of a law with a clock over the closest point at
            the start, [rad].
        hold_from, hold_to: interval in which a brake holds the end-point, [s]; equal: never.
        hold_at: θ at which the brake acts, for hold_to - hold_from, when the end-point passes there
            for the first time after hold_from, [rad]; None: it acts at hold_from, wherever it is.
        hold_direction: "along" the path's tangent, "across" it, or "both", in the path's plane.
        push_from, push_to: interval in which a hand pulls at the end-point, [s]; equal: never.
        push_z1, push_z2: position of the hand in the path's plane, [m].
        pull_from, pull_to: interval in which a hand goes along with the end-point and pulls it
            across the path with a growing force, [s]; equal: never.
        pull_rate: growth of its force, to the left of the path if positive, [N/s]; the force grows
            up to that of the hand, see models/systems/forces.py.
        wall_from, wall_to: interval in which there is a wall, [s]; equal: never.
        wall_z1, wall_z2: a point of its surface, in the path's plane, [m].
        wall_angle: angle of its normal, which points to the free side, with the first axis, [rad].
        reverse_at: time at which the wanted speed changes its sign, [s]; 0: never.
        profile: the wanted speed over time, instead of the parameters `speed` and `ramp`, or None.

    Raises:
        ValueError: a value is out of range, or an interval ends before it begins.
    """

    r: float = 0.05
    duration: float = 4.0
    start_z1: float | None = None
    start_z2: float | None = None
    start_along: float = 0.0
    start_across: float = 0.0
    clock_offset: float = 0.0
    hold_from: float = 0.0
    hold_to: float = 0.0
    hold_at: float | None = None
    hold_direction: str = "along"
    reverse_at: float = 0.0
    push_from: float = 0.0
    push_to: float = 0.0
    push_z1: float = 0.0
    push_z2: float = 0.0
    pull_from: float = 0.0
    pull_to: float = 0.0
    pull_rate: float = 5.0
    wall_from: float = 0.0
    wall_to: float = 0.0
    wall_z1: float = 0.0
    wall_z2: float = 0.0
    wall_angle: float = 0.0
    profile: SpeedProfile | None = None

    def __post_init__(self) -> None:
        _within("r", self.r, 0.005, 0.12, "m")
        _within("duration", self.duration, 0.01, 600.0, "s")
        _within("reverse_at", self.reverse_at, 0.0, 600.0, "s")
        _within("hold_at", self.hold_at or 0.0, -np.pi, np.pi, "rad")
        _within("pull_rate", self.pull_rate, -100.0, 100.0, "N/s")
        for name in ("clock_offset", "wall_angle"):
            _within(name, getattr(self, name), -2 * np.pi, 2 * np.pi, "rad")
        for name in ("start_along", "start_across"):
            _within(name, getattr(self, name), -2.0, 2.0, "m/s")
        for what in ("start", "push", "wall"):
            for name in (f"{what}_z1", f"{what}_z2"):
                _within(name, getattr(self, name) or 0.0, -FARTHEST, FARTHEST, "m")
        for what in _TIMES:
            _window(what, getattr(self, f"{what}_from"), getattr(self, f"{what}_to"))
        if self.hold_direction not in DIRECTIONS:
            choices = ", ".join(DIRECTIONS)
            raise ValueError(f"hold_direction: {self.hold_direction!r} is not one of {choices}")
        if max(self.push_from, self.pull_from) < min(self.push_to, self.pull_to):
            raise ValueError("pull_from: there is one hand, which pushes at that time")
        if self.profile is not None and self.reverse_at:
            raise ValueError("reverse_at: the profile already says when the speed changes")

    def hand(self) -> tuple[float, float]:
        """Position of the hand in the path's plane, [m]."""
        return self.push_z1, self.push_z2

    def wall(self) -> Wall:
        """The wall, while there is one."""
        return Wall(self.wall_z1, self.wall_z2, self.wall_angle)

    def ticks(self, what: str, dt: float) -> range:
        """The ticks of an interval: "hold", "push", "pull" or "wall".

        Args:
            dt: length of a tick, [s].
        """
        begin, end = getattr(self, f"{what}_from"), getattr(self, f"{what}_to")
        return range(round(begin / dt), round(end / dt))


NAMES = tuple(f.name for f in dataclasses.fields(Schedule))


def with_values(schedule: Schedule, values: Mapping[str, Any]) -> Schedule:
    """The schedule with values set by name, all at once.

    Args:
        values: name -> value, or value as text.

    Raises:
        ValueError: a bad value, or one that nothing uses; the message names it.
    """
    found = dataclasses.replace(schedule, **{name: _read(name, v) for name, v in values.items()})
    for name in values:
        _check_used(found, name)
    return found


def _check_used(schedule: Schedule, name: str) -> None:
    """Refuse details of an event that never happens, and an event that begins after the end.

    Raises:
        ValueError: it is one of these.
    """
    what, _, detail = name.partition("_")
    end = f"the run ends at {schedule.duration:g} s"
    if name == "reverse_at" and schedule.reverse_at >= schedule.duration:
        raise ValueError(f"reverse_at ({schedule.reverse_at:g} s): {end}")
    if what not in _TIMES:
        return
    begin, until = getattr(schedule, f"{what}_from"), getattr(schedule, f"{what}_to")
    if detail not in ("from", "to") and begin == until:
        raise ValueError(f"{name}: it needs an interval, {what}_from and {what}_to")
    if begin < until and begin >= schedule.duration:
        raise ValueError(f"{what}_from ({begin:g} s): {end}")


def _read(name: str, value: Any) -> Any:
    if name == "hold_direction":
        return str(value)
    if name == "profile":
        return value if value is None or isinstance(value, SpeedProfile) else profile_from(value)
    return number_of(name, value)


def _window(what: str, begin: float, end: float) -> None:
    _within(f"{what}_from", begin, 0.0, 600.0, "s")
    _within(f"{what}_to", end, 0.0, 600.0, "s")
    if end < begin:
        raise ValueError(f"{what}_to ({end:g} s) lies before {what}_from ({begin:g} s)")


def _within(name: str, value: float, low: float, high: float, unit: str) -> None:
    if not low <= value <= high:  # NaN fails too
        raise ValueError(f"{name}: {value} is not between {low:g} and {high:g} {unit}")
