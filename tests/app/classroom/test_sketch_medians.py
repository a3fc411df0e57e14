"""A class's curves have a median only with its band, and only if there are five of them or more."""

from __future__ import annotations

import re

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.app.classroom.results import Distribution
from onpath.app.classroom.sketches_html import (
    Picks,
    SketchRound,
    quartiles,
    sketches_view,
)
from onpath.lessons.given import Answer
from onpath.lessons.schema import Sketch
from onpath.lessons.words import ENGLISH

SKETCH = Sketch(question="?", quantity="distance", seconds=8.0, top=60.0)
heights = st.lists(st.floats(0, 60), min_size=3, max_size=3)


def drawn(values: list[float]) -> Answer:
    """A curve from 0 s to 8 s."""
    return Answer(times=(0.0, 5.0, 8.0), values=tuple(values))


def view(curves: list[Answer], picks: Picks) -> str:
    found = Distribution(counts=(), sketches=tuple(curves), skipped=0, waiting=0)
    rounds = [SketchRound("", found, "")]
    return sketches_view(SKETCH, rounds, None, {}, ENGLISH, large=False, picks=picks)


@given(st.lists(heights, min_size=1, max_size=9))
@settings(max_examples=20)
def test_half_of_the_curves_lie_within_the_band(curves: list[list[float]]) -> None:
    times, (low, middle, high) = quartiles([drawn(each) for each in curves], 8.0)
    for at in (0, 25, 40):
        values = sorted(np.interp(times[at], (0.0, 5.0, 8.0), each) for each in curves)
        half = len(values) / 2
        assert sum(each <= middle[at] + 1e-9 for each in values) >= half
        assert sum(each >= middle[at] - 1e-9 for each in values) >= half
        within = [low[at] - 1e-9 <= each <= high[at] + 1e-9 for each in values]
        assert sum(within) >= half - 1 and low[at] <= middle[at] <= high[at]


def test_a_few_or_picked_curves_have_no_median() -> None:
    curves = [drawn([0.0, 10.0 * i, 5.0]) for i in range(5)]
    for count, picked, has in ((4, (), False), (5, (), True), (5, (1, 2), False)):
        page = view(curves[:count], Picks(picked))
        assert ("<polygon" in page) == ("stroke-dasharray" in page) == has
        assert (ENGLISH("class.median") in page) == has
    (line,) = re.findall(r'<polyline points="([^"]*)"[^>]*dasharray', view(curves, Picks()))
    (band,) = re.findall(r'<polygon points="([^"]*)"', view(curves, Picks()))
    assert len(band.split()) == 2 * len(line.split())
