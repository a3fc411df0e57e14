"""The class's sketches in one plot, and each in a small numbered one, without names, as HTML."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from onpath.app.classroom.plot_frame import HEIGHT, WIDTH, PlotFrame, frame_for
from onpath.app.classroom.results import Distribution
from onpath.app.common.palette import OF_SIDE, SLATE
from onpath.app.common.templates import render
from onpath.lessons.action_schema import RobotName
from onpath.lessons.given import MOST_POINTS as MOST_OF_TRUTH
from onpath.lessons.given import Answer
from onpath.lessons.measures.shapes import shape_of
from onpath.lessons.measures.thinning import peaks
from onpath.lessons.progress import Truth
from onpath.lessons.record import QUANTITIES
from onpath.lessons.schema import Sketch, SketchShape
from onpath.lessons.sides import ROLES
from onpath.lessons.words import Words
from onpath.models.arrays import Array

MOST_POINTS = 40  # of a sketch
FEWEST = 5  # sketches that have a median, which is drawn with the band of the middle half of them
QUARTILES = 0.25, 0.5, 0.75
Numbered = tuple[tuple[int, Answer], ...]


@dataclass(frozen=True, slots=True)
class Picks:
    """The sketches of the class that are shown.

    Attributes:
        picked: numbers of the sketches to show; empty for all.
        numbers: numbers of the sketches of each round, in their order; empty: 1, 2, ….
    """

    picked: tuple[int, ...] = ()
    numbers: tuple[tuple[int, ...], ...] = ()

    def of(self, number: int, sketches: Sequence[Answer]) -> Numbered:
        """The sketches of a round to show, in the order of their numbers."""
        known = self.numbers[number] if number < len(self.numbers) else range(1, 1 + len(sketches))
        both = sorted(zip(known, sketches, strict=True), key=lambda each: each[0])
        return tuple(each for each in both if not self.picked or each[0] in self.picked)


ALL = Picks()


@dataclass(frozen=True, slots=True)
class SketchRound:
    """One of the times a curve was asked for: its title, the answers, and their number in words."""

    title: str
    found: Distribution
    facts: str


@dataclass(frozen=True, slots=True)
class PlottedLine:
    """A curve in the plot.

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
        points = [tuple(map(float, point.split(","))) for point in self.points.split()]
        x, y = min(points, key=lambda point: point[1])
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
    """A plot of all curves for each round, and below it a small, numbered plot of each curve.

    Args:
        truth: drawn over the sketches; None if it is not revealed.
        large: whether to use large type for a projector.
        picks: the sketches to show; picked ones have their numbers in the plot.
    """
    frame = frame_for(large)
    shown = [picks.of(i, each.found.sketches) for i, each in enumerate(rounds)]
    names = [(SLATE.hex, words("class.predicted"))]
    if truth is not None:
        names += [(OF_SIDE[side].hex, robots[role]) for side, role in ROLES.items()]
    bands = [[] if picks.picked else _band(block, frame, sketches) for sketches in shown]
    names += [(SLATE.hex, words("class.median"))] if any(bands) else []
    plots = [
        (each.title, _lines(block, frame, sketches, truth, bool(picks.picked)), each.facts, band)
        for each, sketches, band in zip(rounds, shown, bands, strict=True)
    ]
    small = shown[-1] if not picks.picked and len(shown[-1]) > 1 else ()
    return render(
        "class/sketches.html",
        block=block,
        title=f"{words(f'quantity.{block.quantity}')} [{QUANTITIES[block.quantity]}]",
        width=WIDTH,
        height=HEIGHT,
        frame=frame,
        marks=_marks(block, frame),
        plots=plots,
        small=[
            (n, _points(block, frame, each.times, each.values, MOST_POINTS)) for n, each in small
        ],
        names=names,
        groups=[_groups(block, i, each.found, picks, words) for i, each in enumerate(rounds)],
        facts=rounds[0].facts if len(rounds) == 1 else "",
        large=large,
    )


def _groups(block: Sketch, number: int, found: Distribution, picks: Picks, words: Words) -> str:
    """How many have drawn each shape that the author names, with one of them as an example."""
    drawn = dict[SketchShape | None, list[int]]()
    for at, sketch in replace(picks, picked=()).of(number, found.sketches) if block.shapes else ():
        drawn.setdefault(shape_of(block, sketch), []).append(at)
    ordered = sorted(drawn.items(), key=lambda each: (each[0] is None, -len(each[1])))
    return " ".join(
        words("class.drew_other", count=len(numbers), example=numbers[0])
        if shape is None
        else words("class.drew", count=len(numbers), name=shape.name, example=numbers[0])
        for shape, numbers in ordered
    )


def quartiles(sketches: Sequence[Answer], seconds: float) -> tuple[Array, Array]:
    """The quartiles of the curves at equal times.

    Returns:
        Times, (n,), [s], and the lower quartile, the median and the upper one then, (3, n).
    """
    times = np.linspace(0.0, seconds, MOST_POINTS + 1)
    values = [np.interp(times, each.times, each.values) for each in sketches]
    return times, np.quantile(np.array(values), QUARTILES, axis=0)


def _band(block: Sketch, frame: PlotFrame, sketches: Numbered) -> list[str]:
    """The outline of the middle half of the curves, and their median; nothing for a few."""
    if len(sketches) < FEWEST:
        return []
    times, (low, middle, high) = quartiles([each for _, each in sketches], block.seconds)
    outline = [*zip(times, low, strict=True), *zip(times[::-1], high[::-1], strict=True)]
    lines = outline, list(zip(times, middle, strict=True))
    places = [[_position(block, frame, *map(float, each)) for each in line] for line in lines]
    return [" ".join(f"{x:.0f},{y:.0f}" for x, y in line) for line in places]


def _lines(
    block: Sketch,
    frame: PlotFrame,
    sketches: Numbered,
    truth: Truth | None,
    are_picked: bool,
) -> list[PlottedLine]:
    width, opacity = (4, 0.8) if are_picked else (2, 0.5)
    lines = [
        PlottedLine(
            points=_points(block, frame, sketch.times, sketch.values, MOST_POINTS),
            colour=SLATE.hex,
            width=width,
            opacity=opacity,
            number=str(number) if are_picked else "",
        )
        for number, sketch in sketches
    ]
    if truth is not None:
        for side, role in ROLES.items():
            points = _points(block, frame, truth.times, getattr(truth, role), MOST_OF_TRUTH)
            lines.append(PlottedLine(points, OF_SIDE[side].hex, width=4, opacity=1.0))
    return lines


def _marks(block: Sketch, frame: PlotFrame) -> list[AxisMark]:
    marks: list[AxisMark] = []
    for part in (0.0, 0.25, 0.5, 0.75, 1.0):
        time, value = part * block.seconds, block.bottom + part * (block.top - block.bottom)
        x, y = _position(block, frame, time, value)
        marks.append(AxisMark(round(x), round(y), f"{time:g}", f"{value:g}"))
    return marks


@lru_cache(maxsize=1024)  # the same curves are redrawn every second
def _points(
    block: Sketch,
    frame: PlotFrame,
    times: tuple[float, ...],
    values: tuple[float, ...],
    most: int,
) -> str:
    kept = peaks([np.array(values)], most)
    points = [_position(block, frame, times[i], values[i]) for i in kept]
    return " ".join(f"{x:.0f},{y:.0f}" for x, y in points)


def _position(block: Sketch, frame: PlotFrame, time: float, value: float) -> tuple[float, float]:
    """Position on the plot, [px]; points outside the axes are moved to their edge."""
    return frame.position(time / block.seconds, (value - block.bottom) / (block.top - block.bottom))
