"""The class's sketches on one plot, and each on a small numbered one, without names, as HTML."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from onpath.app.classroom.results import Distribution
from onpath.app.common.palette import OF_SIDE, SLATE
from onpath.app.common.templates import render
from onpath.lessons.action_schema import RobotName
from onpath.lessons.measures.thinning import peaks
from onpath.lessons.progress import MOST_POINTS as MOST_OF_TRUTH
from onpath.lessons.progress import Answer, Truth
from onpath.lessons.record import QUANTITIES
from onpath.lessons.schema import Sketch
from onpath.lessons.sides import ROLES
from onpath.lessons.words import Words

WIDTH, HEIGHT, LEFT, BELOW = 640, 380, 50, 36  # size of a plot, [px]
FLOOR = HEIGHT - BELOW - 10  # y of its lowest value, [px]
MOST_POINTS = 40  # of a sketch on it
Numbered = tuple[tuple[int, Answer], ...]


@dataclass(frozen=True, slots=True)
class Picks:
    """Which sketches of the class are shown.

    Attributes:
        picked: their numbers; empty for all.
        numbers: of the sketches of each round, in their order; empty for none.
    """

    picked: tuple[int, ...] = ()
    numbers: tuple[tuple[int, ...], ...] = ()

    def of(self, number: int, sketches: Sequence[Answer]) -> Numbered:
        """The sketches of a round that are shown, in the order of their numbers."""
        known = self.numbers[number] if number < len(self.numbers) else range(1, 1 + len(sketches))
        both = sorted(zip(known, sketches, strict=True), key=lambda each: each[0])
        return tuple(each for each in both if not self.picked or each[0] in self.picked)


ALL = Picks()


@dataclass(frozen=True, slots=True)
class SketchRound:
    """A round in which a curve was asked for: its title, the answers, and how many they are."""

    title: str
    found: Distribution
    said: str


@dataclass(frozen=True, slots=True)
class PlottedLine:
    """A curve on the plot.

    Attributes:
        points: the `points` attribute of an SVG polyline, [px].
        width: [px].
        number: shown at its highest point; empty for none.
    """

    points: str
    colour: str
    width: int
    opacity: float
    number: str = ""

    @property
    def top(self) -> tuple[float, float]:
        """Its highest point, [px]."""
        places = [tuple(map(float, place.split(","))) for place in self.points.split()]
        x, y = min(places, key=lambda place: place[1])
        return x, y


@dataclass(frozen=True, slots=True)
class AxisMark:
    """Labels of a time at x and a value at y, [px], beside the axes."""

    x: int
    y: int
    time: str
    value: str


def sketches_view(
    block: Sketch,
    rounds: Sequence[SketchRound],
    truth: Truth | None,
    robots: Mapping[RobotName, str],
    words: Words,
    large: bool,
    picks: Picks = ALL,
) -> str:
    """All curves of each round on a plot; below it each one small, with its number.

    Args:
        truth: drawn over them; None if it is not revealed.
        large: whether to use large type for a projector.
        picks: which sketches are shown; if some are picked, they carry their numbers in the plot.
    """
    shown = [picks.of(i, each.found.sketches) for i, each in enumerate(rounds)]
    names = [(SLATE.hex, words("class.predicted"))]
    if truth is not None:
        names += [(OF_SIDE[side].hex, robots[role]) for side, role in ROLES.items()]
    plots = [
        (each.title, _lines(block, own, truth, bool(picks.picked)), each.said)
        for each, own in zip(rounds, shown, strict=True)
    ]
    small = shown[-1] if not picks.picked and len(shown[-1]) > 1 else ()
    return render(
        "class/sketches.html",
        block=block,
        title=f"{words(f'quantity.{block.quantity}')} [{QUANTITIES[block.quantity]}]",
        width=WIDTH,
        height=HEIGHT,
        left=LEFT,
        floor=FLOOR,
        marks=_marks(block),
        plots=plots,
        small=[(n, _points(block, own.times, own.values, MOST_POINTS)) for n, own in small],
        names=names,
        facts=rounds[0].said if len(rounds) == 1 else "",
        large=large,
    )


def _lines(
    block: Sketch, sketches: Numbered, truth: Truth | None, are_picked: bool
) -> list[PlottedLine]:
    width, opacity = (4, 0.8) if are_picked else (2, 0.5)
    lines = [
        PlottedLine(
            _points(block, sketch.times, sketch.values, MOST_POINTS),
            SLATE.hex,
            width,
            opacity,
            str(number) if are_picked else "",
        )
        for number, sketch in sketches
    ]
    if truth is not None:
        for side, role in ROLES.items():
            line = _points(block, truth.times, getattr(truth, role), MOST_OF_TRUTH)
            lines.append(PlottedLine(line, OF_SIDE[side].hex, 4, 1.0))
    return lines


def _marks(block: Sketch) -> list[AxisMark]:
    marks: list[AxisMark] = []
    for part in (0.0, 0.25, 0.5, 0.75, 1.0):
        time, value = part * block.seconds, block.bottom + part * (block.top - block.bottom)
        x, y = _at(block, time, value)
        marks.append(AxisMark(round(x), round(y), f"{time:g}", f"{value:g}"))
    return marks


@lru_cache(maxsize=1024)  # the same curves are redrawn every second
def _points(block: Sketch, times: tuple[float, ...], values: tuple[float, ...], most: int) -> str:
    kept = peaks([np.array(values)], most)
    places = [_at(block, times[i], values[i]) for i in kept]
    return " ".join(f"{x:.0f},{y:.0f}" for x, y in places)


def _at(block: Sketch, time: float, value: float) -> tuple[float, float]:
    """Position on the plot, [px]; points outside the axes are clamped to their edge."""
    across = min(max(time / block.seconds, 0.0), 1.0)
    up = min(max((value - block.bottom) / (block.top - block.bottom), 0.0), 1.0)
    return LEFT + across * (WIDTH - LEFT - 20), 10 + (1.0 - up) * (HEIGHT - BELOW - 20)
