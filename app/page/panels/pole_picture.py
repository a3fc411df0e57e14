"""The poles of the closed loop as a picture of the complex plane."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from onpath.app.common.templates import render
from onpath.lessons.words import Words
from onpath.models.control.poles import Channel, Complex
from onpath.models.errors import Message

WIDTH, HEIGHT, RIGHT_HALF = 300, 130, 60  # [px]; RIGHT_HALF is right of the imaginary axis
MARGIN = 12  # [px]
STEPS = (1, 2, 5)  # of the marks on the axis, times a power of ten
LEAST = 5.0  # [1/s], smallest range


@dataclass(frozen=True, slots=True)
class PoleMark:
    """A pole at (x, y), [px]; `along` is drawn as a plus, across as a cross."""

    x: float
    y: float
    along: bool


def pole_picture(found: Mapping[str, tuple[Channel, ...] | Message], words: Words) -> str:
    """The picture of all channels' poles as SVG; empty if there are none.

    Both axes have the same scale, so that lines through the origin are those of equal damping.

    Args:
        found: the channels of each law, or why it has none.
    """
    channels = [c for each in found.values() if not isinstance(each, Message) for c in each]
    if not channels:
        return ""
    scale = _scale(np.concatenate([channel.poles for channel in channels]))
    axis, middle = WIDTH - RIGHT_HALF, HEIGHT / 2
    marks = [
        PoleMark(axis + scale * pole.real, middle - scale * pole.imag, channel.name == "along")
        for channel in channels
        for pole in channel.poles.tolist()
    ]
    names = "; ".join(f"{words(f'gains.{c.name}')} {c.pole_words()}" for c in channels)
    return render(
        "panel/poles.html",
        size=(WIDTH, HEIGHT),
        axis=axis,
        middle=middle,
        marks=[mark for mark in marks if MARGIN / 2 <= mark.x <= WIDTH],
        ticks=[(axis - scale * value, f"{-value:g}") for value in _ticks(axis / scale)],
        names=names,
        words=words,
    )


def _scale(poles: Complex) -> float:
    """Pixels per 1/s, so that all poles are seen except for those far to the right."""
    left = max(float(-poles.real.min()), LEAST)
    up = max(float(np.abs(poles.imag).max()), 1e-9)
    room = WIDTH - RIGHT_HALF - MARGIN, HEIGHT / 2 - MARGIN
    return min(room[0] / left, room[1] / up)


def _ticks(largest: float) -> list[float]:
    """Two to five round values up to the largest one."""
    power = 10.0 ** np.floor(np.log10(largest))
    for step in (power * s / 10 for s in (*STEPS, *(10 * s for s in STEPS))):
        if largest / step <= 5:
            return [float(step * i) for i in range(1, int(largest / step) + 1)]
    return [largest]
