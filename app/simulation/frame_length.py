"""The frames of the simulation: 60 a second, each in whole ticks."""

from __future__ import annotations

from onpath.models.systems.parameters import TICK

FRAMES = 60  # per second
FRAME = 1 / FRAMES  # [s]


def frame_length(number: int, together: int = 1) -> float:
    """Simulated time of some frames, beginning with this number, in whole ticks, [s].

    It depends on nothing else, so labs at the usual rate always need equally many ticks, and are
    advanced together.
    """
    end, begin = ((each * round(1 / TICK)) // FRAMES for each in (number + together, number))
    return (end - begin) * TICK
