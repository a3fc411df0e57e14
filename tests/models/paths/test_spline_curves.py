"""Curves of many pieces, against SciPy's B-splines and sums over dense points."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.interpolate import BSpline

from onpath.models.arrays import Array
from onpath.models.paths.curve_blend import blend
from onpath.models.paths.curve_data import curve_from
from onpath.models.paths.curves import PERIOD, circle
from onpath.models.paths.distance import closest_parameter, path_distance
from onpath.models.paths.frames import Plane
from onpath.models.paths.space_curves import saddle
from onpath.models.paths.spline_curves import DEGREE, MOST_PIECES, TABLE_POINTS, SplineCurve


@st.composite
def splines(draw: st.DrawFn) -> SplineCurve:
    """A random walk of 3 to 512 pieces, closed or open."""
    pieces = draw(st.one_of(st.integers(3, 12), st.integers(3, MOST_PIECES)))
    rng, closed = np.random.default_rng(draw(st.integers(0, 2**32))), draw(st.booleans())
    points = 0.01 * rng.normal(size=(pieces + DEGREE, 2)).cumsum(axis=0)
    if closed:
        points[pieces:] = np.resize(points[:pieces], (DEGREE, 2))
        points[:DEGREE] = np.resize(points[:pieces], (DEGREE, 2))
    return SplineCurve(closed, points)


@given(splines(), st.integers(0, 2**32))
def test_splines_are_those_of_scipy(curve: SplineCurve, seed: int) -> None:
    theta = np.random.default_rng(seed).uniform(-np.pi, np.pi, 50)
    width = PERIOD / curve.pieces
    knots = -np.pi + width * np.arange(-DEGREE, curve.pieces + DEGREE + 1)
    oracle = BSpline(knots, curve.points, DEGREE)
    for order, values in enumerate(curve.all_orders(theta)):
        expected = np.asarray(oracle(theta, nu=order))
        size = 1e-12 * np.abs(curve.points).max() * width**-order
        np.testing.assert_allclose(values, expected, atol=10 * size, rtol=0)
        np.testing.assert_array_equal(curve.at(theta, order), values)


@given(splines())
def test_closed_splines_repeat_and_open_ones_go_on_straight(curve: SplineCurve) -> None:
    beyond = np.pi + np.linspace(0.0, 1.0, 7)
    if curve.closed:
        size = np.abs(curve.points).max()
        np.testing.assert_allclose(
            curve.at(beyond), curve.at(beyond - PERIOD), atol=1e-12 * size * curve.pieces
        )
        return
    end, tangent = curve.at(np.array(np.pi)), curve.at(np.array(np.pi), 1)
    line = end + (beyond - np.pi)[:, None] * tangent
    np.testing.assert_allclose(curve.at(beyond), line, atol=1e-9)
    assert not curve.at(beyond[1:], 2).any() and not curve.at(beyond[1:], 3).any()


@pytest.mark.thorough
@given(splines(), st.integers(0, 2**32))
def test_closest_points_and_lengths_are_those_of_dense_points(
    curve: SplineCurve, seed: int
) -> None:
    dense = curve.at(np.linspace(-np.pi, np.pi, 200 * curve.pieces + 1))
    line = float(np.linalg.norm(np.diff(dense, axis=0), axis=1).sum())
    assert abs(curve.length() - line) <= 0.01 * line
    begin, end = sorted(np.random.default_rng(seed).integers(0, len(dense), 2).tolist())
    between = np.linalg.norm(np.diff(dense[begin : end + 1], axis=0), axis=1).sum()
    ends = np.linspace(-np.pi, np.pi, len(dense))[[begin, end]]
    assert abs(float(np.diff(curve.arc(ends))[0]) - between) <= 0.01 * line
    if curve.closed:
        assert np.allclose(curve.arc(ends[:1] + PERIOD) - curve.arc(ends[:1]), line, rtol=0.01)
    y = dense[:: 40 * curve.pieces] + np.random.default_rng(seed).normal(size=(6, 2)) * 0.02
    apart = np.linalg.norm(dense - y[:, None], axis=-1).min(axis=1)
    step = np.linalg.norm(np.diff(dense, axis=0), axis=1).max()
    found, distance = curve.nearest(y)
    assert (distance <= apart + 1e-12).all()
    assert not curve.closed or (distance >= apart - step).all()
    assert np.allclose(np.linalg.norm(curve.at(found) - y, axis=1), distance)
    assert (path_distance(Plane(), curve, y) <= apart + 1e-9).all()
    nearest = curve.at(np.array([closest_parameter(Plane(), curve, y[0])]))
    assert np.linalg.norm(nearest - y[0]) <= apart[0] + 1e-12


@given(splines())
def test_a_table_is_padded_and_data_restores_the_curve(curve: SplineCurve) -> None:
    table = curve.table().reshape(TABLE_POINTS, 2)
    assert np.array_equal(table[: len(curve.points)], curve.points)
    assert not table[len(curve.points) :].any()
    again = curve_from(curve.data())
    assert isinstance(again, SplineCurve) and again.closed is curve.closed
    assert np.array_equal(again.points, curve.points)
    assert curve.conic() is None and curve.plan.dimension == 2
    assert isinstance(curve_from(circle(0.05).data()), type(circle(0.05)))


@pytest.mark.parametrize("closed", [True, False])
def test_a_saddle_over_a_spline_rises_as_over_a_series(closed: bool) -> None:
    points = np.random.default_rng(1).normal(size=(40 + DEGREE, 2))
    if closed:
        points[-DEGREE:] = points[:DEGREE]
    theta = np.linspace(-np.pi, np.pi, 500)
    height = saddle(SplineCurve(closed, points), 0.03).at(theta)[:, 2]
    wanted = np.cos(2 * theta) if closed else 2 * (theta / np.pi) ** 2 - 1
    np.testing.assert_allclose(height, 0.03 * wanted, atol=1e-9)


@pytest.mark.parametrize(
    ("closed", "points"),
    [
        (False, np.zeros((DEGREE, 2))),
        (False, np.zeros((TABLE_POINTS + 1, 2))),
        (False, np.full((9, 2), np.nan)),
        (True, np.arange(18.0).reshape(9, 2)),
    ],
)
def test_what_is_no_spline_is_refused(closed: bool, points: Array) -> None:
    with pytest.raises(ValueError, match="points: "):
        SplineCurve(closed, points)


@given(splines(), st.floats(0.1, 20.0), st.floats(-0.02, 0.02))
def test_a_rise_and_a_blend_keep_how_a_drawing_is_passed(
    curve: SplineCurve, duration: float, rise: float
) -> None:
    drawing = replace(curve, duration=duration, raised=((-1.0, 0.5),))
    for made in (saddle(drawing, rise), blend(curve, drawing, 0.5)):
        assert isinstance(made, SplineCurve)
        assert made.duration == duration and made.raised == drawing.raised
