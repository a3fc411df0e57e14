"""A wanted speed η₂ref(t) that is linear between given times."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

LONGEST = 600.0  # [s]
MOST_POINTS = 1000
FORM = "times and speeds as 0:0, 1:6.28, 4:6.28, [s]:[rad/s]"


@dataclass(frozen=True, slots=True)
class SpeedProfile:
    """A piecewise linear speed; constant before the first and after the last time.

    Two points at the same time are a step.

    Attributes:
        times: not decreasing, [s].
        speeds: [rad/s].

    Raises:
        ValueError: no points or too many, times that decrease, or numbers that are not finite.
    """

    times: tuple[float, ...]
    speeds: tuple[float, ...]

    def __post_init__(self) -> None:
        if not 0 < len(self.times) <= MOST_POINTS or len(self.times) != len(self.speeds):
            raise ValueError(f"profile: expected 1 to {MOST_POINTS} {FORM}")
        if not np.isfinite([*self.times, *self.speeds]).all():
            raise ValueError("profile: all times and speeds must be finite")
        if self.times[0] < 0 or self.times[-1] > LONGEST or min(np.diff(self.times), default=0) < 0:
            raise ValueError(f"profile: times must not decrease, from 0 to {LONGEST:g} s")

    def on_grid(self, dt: float) -> list[tuple[int, float]]:
        """(tick, speed) of its points, with times rounded to ticks of length dt, [s]."""
        return [(round(t / dt), w) for t, w in zip(self.times, self.speeds, strict=True)]

    def after(self, tick: int, dt: float) -> tuple[float, float, float]:
        """From a tick to the next point: speeds at both [rad/s], and the rate's size [rad/s²].

        Args:
            tick: on or between points.
            dt: length of a tick, [s].
        """
        points = self.on_grid(dt)
        before = [point for point in points if point[0] <= tick]
        later = [point for point in points if point[0] > tick]
        (begin, first), (end, last) = (before or points[:1])[-1], (later or points[-1:])[0]
        if not before or not later:
            return first, first, 0.0
        rate = (last - first) / ((end - begin) * dt)
        return first + rate * (tick - begin) * dt, last, abs(rate)


def profile_from(value: str | Iterable[Iterable[float]]) -> SpeedProfile:
    """A profile from text, such as "0:0, 1:6.28", or from (time, speed) pairs.

    Raises:
        ValueError: not of this form; see also `SpeedProfile`.
    """
    try:
        pairs = [one.split(":") for one in value.split(",")] if isinstance(value, str) else value
        points = [(float(time), float(speed)) for time, speed in pairs]
    except (TypeError, ValueError):
        raise ValueError(f"profile: expected {FORM}, got {str(value)[:60]!r}") from None
    return SpeedProfile(tuple(t for t, _ in points), tuple(w for _, w in points))
