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
from onpath.app.page.lesson_chart import together
from onpath.lessons.measures.thinning import intervals, peaks
from onpath.lessons.progress import Answer, Truth
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


times = st.lists(st.floats(0, 8), min_size=2, max_size=60, unique=True).map(sorted)
lines = times.flatmap(
    lambda at: st.tuples(
        st.just(tuple(at)), st.lists(numbers, min_size=len(at), max_size=len(at)).map(tuple)
    )
)


@given(st.lists(lines, min_size=1, max_size=3))
def test_a_chart_of_several_curves_has_every_point_of_each(
    curves: list[tuple[tuple[float, ...], tuple[float, ...]]],
) -> None:
    at, *drawn = together(8.0, *curves)
    assert np.all(np.diff(at) > 0) and at[0] == 0.0 and at[-1] == 8.0
    for (own, values), line in zip(curves, drawn, strict=True):
        assert np.array_equal(line[np.searchsorted(at, own)], values)
        assert np.isnan(line[(at < own[0]) | (at > own[-1])]).all()


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
