"""Paths through strokes: near to what was drawn, round, slow in bends, and up between strokes."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import KDTree

from onpath.models.arrays import Array
from onpath.models.errors import CodedError
from onpath.models.paths.curves import PERIOD
from onpath.models.paths.path_checks import LEAST_RADIUS
from onpath.models.paths.spline_curves import SplineCurve
from onpath.models.paths.spline_fit import (
    CAP,
    HASTE,
    MOST_RAISED,
    QUICK,
    SWING,
    raised_share,
    spline_through,
)

SIZE = 0.1  # [m], of the drawings


def scribble(seed: int) -> Array:
    """A smooth signature of random loops, 100 mm wide."""
    rng, t = np.random.default_rng(seed), np.linspace(0.0, 1.0, 300)
    waves = [
        (rng.normal(size=2) * (0.03, 0.08), rng.uniform(2, 7), rng.uniform(0, 6, 2))
        for _ in range(5)
    ]
    x, y = (
        sum(size[k] * np.sin(PERIOD * rate * t + phase[k]) for size, rate, phase in waves)
        for k in (0, 1)
    )
    z = np.stack([2 * t + x, y], axis=-1)
    return SIZE * z / np.ptp(z, axis=0).max()


def polygon(seed: int) -> Array:
    """Straight lines between random corners."""
    rng = np.random.default_rng(seed)
    z = rng.uniform(size=(rng.integers(3, 9), 2))
    return SIZE * z / np.ptp(z, axis=0).max()


def dense(line: Array) -> Array:
    """Points of a polyline, 0.05 mm apart."""
    s = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))])
    at = np.arange(0.0, s[-1], 5e-5)
    return np.stack([np.interp(at, s, each) for each in line.T], axis=-1)


def farthest(points: Array, line: Array) -> float:
    """The largest distance of points from those of a line, [m]."""
    return float(np.max(KDTree(line).query(points)[0]))


def speeds(curve: SplineCurve, theta: Array) -> Array:
    """Speed at the usual rate of θ, [m/s]."""
    return np.linalg.norm(curve.at(theta, 1), axis=-1) * PERIOD / curve.duration


@settings(max_examples=5)
@given(st.integers(0, 2**32), st.booleans())
def test_a_signature_is_followed_within_two_per_cent_and_can_be(seed: int, smooth: bool) -> None:
    stroke = scribble(seed) if smooth else polygon(seed)
    curve = spline_through([stroke])
    theta = curve.sample(16 * curve.grid)
    seen, line = curve.at(theta), dense(stroke)
    apart = max(farthest(seen, line), farthest(line, seen))
    assert apart <= 0.02 * SIZE and curve.deviation == pytest.approx(apart, abs=1e-4)
    bends = np.abs(curve.curvature(theta))
    assert bends.max() < 1.02 / LEAST_RADIUS
    speed = speeds(curve, theta)
    assert speed.max() < 1.1 * QUICK and (bends * speed).max() < 2.5 * SWING
    assert np.linalg.norm(curve.at(np.array([-np.pi]))[0] - stroke[0]) < 1e-3 * SIZE
    assert curve.raised == ()


def test_a_circle_is_passed_at_the_speed_of_the_usual_one() -> None:
    angle = np.linspace(0.0, PERIOD, 100, endpoint=False)
    curve = spline_through([0.05 * np.stack([np.cos(angle), np.sin(angle)], axis=-1)], closed=True)
    assert curve.duration == pytest.approx(1.0, rel=0.01)
    assert speeds(curve, curve.sample()) == pytest.approx(QUICK, rel=0.02)
    assert np.linalg.norm(curve.at(curve.sample()), axis=-1) == pytest.approx(0.05, abs=1e-4)


@pytest.mark.thorough
@settings(max_examples=8)
@given(st.integers(0, 2**32), st.integers(1, 6), st.booleans())
def test_between_strokes_the_pen_is_up_and_else_it_draws_them(
    seed: int, count: int, repeated: bool
) -> None:
    rng = np.random.default_rng(seed)
    strokes = [0.4 * polygon(seed + k) + rng.uniform(0, 0.1, 2) for k in range(count)]
    curve = spline_through(strokes, repeated=repeated)
    assert len(curve.raised) == count - (not curve.closed)
    if curve.closed:
        assert repeated and raised_share(curve) <= MOST_RAISED
    theta = curve.sample(16 * curve.grid)
    down = curve.draws(theta)
    lines = [dense(stroke) for stroke in strokes]
    assert farthest(curve.at(theta[down]), np.vstack(lines)) <= curve.deviation + 1e-4
    assert farthest(np.vstack(lines), curve.at(theta[down])) <= curve.deviation + 1e-4
    assert curve.deviation <= 0.02 * np.ptp(np.vstack(strokes), axis=0).max()
    assert speeds(curve, theta).max() < 1.1 * HASTE * QUICK
    edges = [-np.pi, *(edge for link in curve.raised for edge in link), np.pi]
    assert not curve.closed or edges[-2] == pytest.approx(np.pi, abs=2e-4)
    for k, stroke in enumerate(strokes):
        ends = curve.at(np.array(edges[2 * k : 2 * k + 2]))
        assert np.linalg.norm(ends - stroke[[0, -1]], axis=-1).max() < 1.5e-3


@pytest.mark.thorough
@settings(max_examples=20)
@given(st.floats(0.0, 25.0))
def test_a_cusp_is_round_and_no_loop_appears(degrees: float) -> None:
    half = np.deg2rad(degrees) / 2
    legs = 0.08 * np.array([[-np.sin(half), -np.cos(half)], [np.sin(half), -np.cos(half)]])
    curve = spline_through([np.array([legs[0], [0.0, 0.0], legs[1]])])
    theta = curve.sample(16 * curve.grid)
    seen = curve.at(theta)
    assert curve.deviation <= 2 * CAP[1] and np.abs(curve.curvature(theta)).max() < 1.02 / 5e-4
    tip = int(seen[:, 1].argmax())
    assert (np.diff(seen[:tip, 1]) > -1e-6).all() and (np.diff(seen[tip:, 1]) < 1e-6).all()


@pytest.mark.thorough
@settings(max_examples=5)
@given(st.integers(0, 2**32))
def test_more_points_of_the_same_lines_change_nothing(seed: int) -> None:
    stroke = polygon(seed)
    between = np.linspace(0.0, 1.0, 50, endpoint=False)[:, None]
    more = [a + between * (b - a) for a, b in pairwise(stroke)]
    first, second = spline_through([stroke]), spline_through([np.vstack([*more, stroke[-1:]])])
    there, here = (each.at(each.sample(4096)) for each in (first, second))
    assert max(farthest(there, here), farthest(here, there)) < 1e-4


@pytest.mark.parametrize(
    "strokes",
    [
        [],
        [np.zeros((5, 2))],
        [np.array([[0.0, 0.0], [0.01, 0.0]])],
        [np.array([[0.0, 0.0], [np.nan, 0.1], [0.1, 0.1]])],
    ],
)
def test_what_is_no_line_is_refused(strokes: list[Array]) -> None:
    with pytest.raises((CodedError, ValueError)):
        spline_through(strokes)


def test_what_was_given_has_no_lines_between_strokes() -> None:
    strokes = [np.array([[-0.05, y], [0.05, y]]) for y in (-0.02, 0.0, 0.03)]
    curve = spline_through(strokes)
    assert curve.given is not None
    steps = np.diff(curve.given, axis=0)
    assert np.isnan(steps).any(axis=1).sum() == 2 * (len(strokes) - 1)
    assert np.nanmax(np.abs(steps[:, 1])) == 0
    assert "nan" not in curve._repr_svg_() and curve._repr_svg_().count("<polyline") == 6
