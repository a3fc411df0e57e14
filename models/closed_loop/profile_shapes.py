"""The speed profiles among the parameters: shapes that are scaled by the wanted speed."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from onpath.models.closed_loop.speed_profile import SpeedProfile
from onpath.models.systems.parameters import Parameters

SWING = 0.5
"""Amplitude of the sine, as a share of its mean."""
PIECES = 32
"""Straight pieces per period of the sine; their error is within 0.5 % of its amplitude."""
SHAPES = {
    "ramp_up": ((0.0, 1.0), (0.0, 1.0)),
    "sine": (
        tuple((np.arange(PIECES + 1) / PIECES).tolist()),
        tuple((1 + SWING * np.sin(2 * np.pi * np.arange(PIECES + 1) / PIECES)).tolist()),
    ),
    "stop_and_go": ((0.0, 0.1, 0.5, 0.6, 1.0), (0.0, 1.0, 1.0, 0.0, 0.0)),
}
"""Times as shares of `profile_period`, and speeds as shares of `speed`; "constant" has none."""
ONCE = "ramp_up"


def profile_of(parameters: Parameters) -> SpeedProfile | None:
    """The profile η₂ref(t) from the start of a run, [rad/s]; None if it is constant.

    With the speed ω and the period T, the wanted speed is

        ramp_up:      ω t / T up to T, then ω;
        sine:         ω (1 + sin(2π t / T) / 2), in `PIECES` straight pieces a period;
        stop_and_go:  from 0 to ω in T / 10, ω up to T / 2, to 0 in T / 10, 0 up to T; and again.

    A task to reach a position has none.
    """
    if parameters.task != "speed" or parameters.speed_profile not in SHAPES:
        return None
    return _profile(parameters.speed_profile, parameters.speed, parameters.profile_period)


@lru_cache(maxsize=64)  # asked for in every frame
def _profile(shape: str, speed: float, period: float) -> SpeedProfile:
    times, shares = SHAPES[shape]
    return SpeedProfile(
        tuple(period * t for t in times),
        tuple(speed * share for share in shares),
        0.0 if shape == ONCE else period,
    )
