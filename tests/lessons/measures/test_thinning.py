"""Thinning a curve reduces its points but keeps every peak."""

from __future__ import annotations

import re

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from onpath.app.classroom.class_html import prediction_view
from onpath.app.classroom.results import Distribution
from onpath.app.classroom.sketches_html import MOST_POINTS
from onpath.lessons.given import Answer
from onpath.lessons.measures.thinning import intervals, peaks
from onpath.lessons.progress import Truth
from onpath.lessons.schema import Sketch
from onpath.lessons.words import Words

numbers = st.floats(-1e6, 1e6)
signals = st.integers(1, 900).flatmap(
    lambda n: st.lists(arrays(float, n, elements=numbers), min_size=1, max_size=3)
)


@given(signals, st.integers(20, 200))
def test_every_stretch_keeps_its_least_and_its_greatest(
    curves: list[np.ndarray], most: int
) -> None:
    count = len(curves[0])
    kept = peaks(curves, most)
    assert len(kept) <= most and np.all(np.diff(kept) > 0)
    assert kept[0] == 0 and kept[-1] == count - 1
    whole = [slice(0, count)]
    parts = intervals(count, len(curves), most) if count > most else whole
    assert [i for part in parts for i in range(part.start, part.stop)] == list(range(count))
    for part in whole + parts:
        inside = kept[(kept >= part.start) & (kept < part.stop)]
        for curve in curves:
            assert curve[inside].min() == curve[part].min()
            assert curve[inside].max() == curve[part].max()


def test_one_narrow_peak_is_on_the_class_s_plot() -> None:
    axes = Sketch("?", "distance", seconds=8.0, top=100.0)
    at = tuple(np.linspace(0.0, 8.0, 160).tolist())
    flat = (0.0,) * len(at)
    for place in range(len(at)):
        peak = (*flat[:place], 100.0, *flat[place + 1 :])
        sketches = (Answer(times=at, values=peak),)
        page = prediction_view(
            axes, Distribution((), sketches, 0, 0), Truth("distance", at, peak, flat), True, Words()
        )
        drawn = [line.split() for line in re.findall(r'<polyline points="([^"]*)"', page)]
        tops = [min(float(point.split(",")[1]) for point in line) for line in drawn]
        assert len(drawn) == 3 and tops[0] == tops[1] < tops[2]
        assert len(drawn[0]) <= MOST_POINTS
