"""Drawings that are bent at handles."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.models.paths.spline_bend import handles, pull, pulled
from onpath.models.paths.spline_curves import DEGREE, SplineCurve
from tests.support.drawings import random_drawing

DRAWINGS = st.builds(
    random_drawing, st.integers(0, 999), st.integers(24, 150), closed=st.booleans()
)


@settings(max_examples=30)
@given(DRAWINGS, st.integers(2, 24), st.data())
def test_the_curve_follows_a_handle_and_stays_as_it_is_elsewhere(
    curve: SplineCurve, count: int, data: st.DataObject
) -> None:
    places = handles(curve, count)
    index = data.draw(st.integers(0, len(places) - 1))
    by = np.array(data.draw(st.tuples(*[st.floats(-0.05, 0.05)] * 2)))
    bent = pulled(curve, pull(curve, places, index), by)
    np.testing.assert_allclose(bent.at(places[index]) - curve.at(places[index]), by, atol=1e-12)
    theta = np.linspace(-np.pi, np.pi, 8 * curve.pieces)
    x, width = theta - places[index], 2 * np.pi / curve.pieces
    away = np.abs((x + np.pi) % (2 * np.pi) - np.pi if curve.closed else x)
    apart = np.delete(places, index) - places[index]
    reach = np.abs((apart + np.pi) % (2 * np.pi) - np.pi if curve.closed else apart).min()
    far = away > max(reach, width) + (DEGREE + 1) / 2 * width
    np.testing.assert_array_equal(bent.at(theta)[far], curve.at(theta)[far])
    moved = np.linalg.norm(bent.at(theta) - curve.at(theta), axis=1)
    assert moved.max() <= 1.2 * np.linalg.norm(by) + 1e-12
    if curve.closed:
        np.testing.assert_array_equal(bent.points[:DEGREE], bent.points[-DEGREE:])


@settings(max_examples=30)
@given(st.integers(0, 999), st.integers(2, 24))
def test_handles_lie_where_the_pen_is_down(seed: int, count: int) -> None:
    rng = np.random.default_rng(seed)
    edges = np.sort(rng.uniform(-3, 3, 4))
    whole = random_drawing(seed, 200)
    curve = SplineCurve(False, whole.points, raised=((edges[0], edges[1]), (edges[2], edges[3])))
    places = handles(curve, count)
    assert len(places) == count
    assert (np.diff(places) > 0).all()
    assert [places[0], places[-1]] == [-np.pi, np.pi]
    step = 2 * np.pi / (4 * curve.grid)  # to which the ends of a stroke are known
    inside = [(places > a + step) & (places < b - step) for a, b in curve.raised]
    assert not np.any(inside)
