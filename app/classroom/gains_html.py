"""Everyone's gains as points in a diagram, without names, as HTML."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass
from math import sqrt

from onpath.app.classroom.class_sync import GAINS
from onpath.app.classroom.plot_frame import HEIGHT, WIDTH, PlotFrame, frame_for
from onpath.app.common.templates import render
from onpath.lessons.labels import setting_label
from onpath.lessons.words import Words
from onpath.models.control.settable import specs
from onpath.models.systems.catalogue import FIVE_BAR

PAIRS = (("K1", "K2"), ("K4", "K5"), ("K1", "K3"), ("K1", "K5"))
"""Gains along the two axes; each spring with its damping comes first."""
SPRINGS = (("K1", "K2"), ("K4", "K5"))
"""Pairs of a spring and its damping, with a border between swinging and creeping."""
POINTS = 60  # number of points on the border of the stable region


@dataclass(frozen=True, slots=True)
class Dot:
    """Students with the same gains: position and radius, [px], and their number."""

    x: float
    y: float
    radius: float
    count: int


@dataclass(frozen=True, slots=True)
class Scale:
    """Converts gains to positions; values beyond the range of a slider are drawn at its end."""

    across: tuple[float, float]
    up: tuple[float, float]
    frame: PlotFrame

    def position(self, x: float, y: float) -> tuple[float, float]:
        """Position of a point, [px]."""
        return self.frame.position(
            *(
                (value - low) / (high - low)
                for value, (low, high) in ((x, self.across), (y, self.up))
            )
        )


def gains_view(
    pair: tuple[str, str],
    gains: Iterable[tuple[float, ...]],
    words: Words,
    large: bool = False,
) -> str:
    """A point for each student; students with the same gains share a larger one.

    Args:
        pair: names of the gains along the two axes.
        gains: each student's `Member.gains`; empty if the lab is not known yet.
        large: whether to use large type for a projector.
    """
    known = [each for each in gains if each]
    at = [GAINS.index(name) for name in pair]
    counted = Counter((each[at[0]], each[at[1]]) for each in known)
    parameters = FIVE_BAR.parameters()
    declared = specs(parameters)
    ranges = [(declared[name].low, declared[name].high) for name in pair]
    scale = Scale(across=ranges[0], up=ranges[1], frame=frame_for(large, titled=True))
    dots = [_dot(scale, values, count) for values, count in counted.items()]
    marks = [
        (*scale.position(*(low + part * (high - low) for low, high in ranges)), values)
        for part in (0.0, 0.25, 0.5, 0.75, 1.0)
        for values in [tuple(f"{low + part * (high - low):g}" for low, high in ranges)]
    ]
    return render(
        "class/gains.html",
        titles=[f"{setting_label(n, parameters, words)} [{declared[n].unit}]" for n in pair],
        dots=dots,
        marks=marks,
        border=_border(scale) if pair in SPRINGS else "",
        width=WIDTH,
        height=HEIGHT,
        frame=scale.frame,
        students=len(known),
        words=words,
        large=large,
    )


def _dot(scale: Scale, gains: tuple[float, float], count: int) -> Dot:
    x, y = scale.position(*gains)
    return Dot(x=x, y=y, radius=5 + 3 * sqrt(count), count=count)


def _border(scale: Scale) -> str:
    """Damping at which a spring neither swings nor creeps, as points of an SVG polyline."""
    most = min(scale.across[1], (scale.up[1] / 2) ** 2)
    springs = [most * (i / POINTS) ** 2 for i in range(POINTS + 1)]
    points = [scale.position(spring, 2 * sqrt(spring)) for spring in springs]
    return " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
