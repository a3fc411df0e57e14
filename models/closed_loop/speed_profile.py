"""A wanted speed η₂ref(t) that is linear between given times, once or periodically."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from onpath.models.systems.parameter_specs import MINUS

LONGEST = 600.0  # [s]
MOST_POINTS = 1000
FORM = "times and speeds as 0:0, 1:6.28, 4:6.28, [s]:[rad/s]"


@dataclass(frozen=True, slots=True)
class Leg:
    """A part of a profile in which the speed is linear.

    Attributes:
        begin, end: first tick, and first tick of the next part; None if there is no next part.
        first, last: speeds there, [rad/s].
        rate: size of the speed's rate, [rad/s²].
    """

    begin: int
    end: int | None
    first: float
    last: float
    rate: float

    def at(self, tick: int) -> float:
        """The speed at a tick of this part, [rad/s]."""
        if self.end is None:
            return self.first
        return self.first + (self.last - self.first) * (tick - self.begin) / (self.end - self.begin)


@dataclass(frozen=True, slots=True)
class SpeedProfile:
    """A piecewise linear speed; constant before the first and after the last time.

    Two points at the same time are a step.

    Attributes:
        times: not decreasing, [s].
        speeds: [rad/s].
        period: time after which it repeats, not before its last point, [s]; 0: never.

    Raises:
        ValueError: no points or too many, times that decrease, or numbers that are not finite.
    """

    times: tuple[float, ...]
    speeds: tuple[float, ...]
    period: float = 0.0

    def __post_init__(self) -> None:
        if not 0 < len(self.times) <= MOST_POINTS or len(self.times) != len(self.speeds):
            raise ValueError(f"profile: expected 1 to {MOST_POINTS} {FORM}")
        if not np.isfinite([*self.times, *self.speeds, self.period]).all():
            raise ValueError("profile: all times and speeds must be finite")
        if self.times[0] < 0 or self.times[-1] > LONGEST or min(np.diff(self.times), default=0) < 0:
            raise ValueError(f"profile: times must not decrease, from 0 to {LONGEST:g} s")
        if self.period and not self.times[-1] <= self.period <= LONGEST:
            raise ValueError(f"profile: the period must be its last time or later, {LONGEST:g} s")

    def leg(self, tick: int, dt: float) -> Leg:
        """The part that a tick is in, or begins.

        Args:
            tick: 0 or later.
            dt: length of a tick, [s]; times are rounded to ticks.
        """
        ticks, speeds = _on_grid(self, dt)
        lap = round(self.period / dt)
        base = tick // lap * lap if lap else 0
        here = bisect_right(ticks, tick - base)
        if here == 0:
            first = speeds[0]
            return Leg(begin=base, end=base + ticks[0], first=first, last=first, rate=0.0)
        begin, first = base + ticks[here - 1], speeds[here - 1]
        if here == len(ticks):
            return Leg(
                begin=begin, end=base + lap if lap else None, first=first, last=first, rate=0.0
            )
        end, last = base + ticks[here], speeds[here]
        rate = abs(last - first) / ((end - begin) * dt)
        return Leg(begin=begin, end=end, first=first, last=last, rate=rate)


@lru_cache(maxsize=64)
def _on_grid(profile: SpeedProfile, dt: float) -> tuple[list[int], tuple[float, ...]]:
    """Times of the points as ticks, and their speeds."""
    return [round(t / dt) for t in profile.times], profile.speeds


def profile_from(value: str | Iterable[Iterable[float]]) -> SpeedProfile:
    """A profile from text, such as "0:0, 1:6.28", or from (time, speed) pairs.

    Raises:
        ValueError: not of this form; see also `SpeedProfile`.
    """
    try:
        pairs = _pairs(value) if isinstance(value, str) else value
        points = [(float(time), float(speed)) for time, speed in pairs]
    except (TypeError, ValueError):
        raise ValueError(f"profile: expected {FORM}, got {str(value)[:60]!r}") from None
    return SpeedProfile(tuple(t for t, _ in points), tuple(w for _, w in points))


def _pairs(text: str) -> list[list[str]]:
    return [one.split(":") for one in text.replace(MINUS, "-").split(",")]
