"""Drawings with handles: bent where they are dragged, and nowhere else."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.interpolate import CubicSpline

from onpath.models.paths.curve_faults import curve_faults
from onpath.models.paths.curves import PERIOD
from onpath.models.paths.drawing_design import DrawingDesign, drawn, from_curve
from onpath.models.paths.nearest_path import nearest_path
from onpath.models.paths.path_design import MOST_POINTS, REACH
from onpath.models.paths.spline_curves import GRAIN, SplineCurve
from onpath.models.paths.spline_fit import spline_through
from onpath.models.systems.catalogue import FIVE_BAR
from tests.support.drawings import random_drawing, scrawl

SEEDS = st.integers(0, 10**6)


def some_drawing(seed: int) -> DrawingDesign:
    kind = np.random.default_rng(seed).integers(3)
    curve = scrawl(seed) if kind == 2 else random_drawing(seed, closed=bool(kind))
    design = from_curve(curve)
    assert isinstance(design, DrawingDesign)
    return design


def gaps(design: DrawingDesign, index: int) -> tuple[float, float]:
    """Distances to the neighbours of a handle; an end has the one at its other side, too."""
    theta = design.theta
    if design.curve.closed:
        around = np.concatenate([theta[-1:] - PERIOD, theta, theta[:1] + PERIOD])
        before, after = np.diff(around)[index : index + 2].tolist()
        return before, after
    found = np.diff(theta)[max(index - 1, 0) : index + 1]
    return float(found[0]), float(found[-1])


@pytest.mark.thorough
@settings(max_examples=40, deadline=None)
@given(SEEDS)
def test_a_handle_follows_the_hand_and_bends_only_up_to_its_neighbours(seed: int) -> None:
    rng, drawing = np.random.default_rng(seed), some_drawing(seed)
    for _ in range(int(rng.integers(4))):
        drawing = drawing.added(int(rng.integers(len(drawing.points))))
    design = drawing
    assert isinstance(design, DrawingDesign)
    index = int(rng.integers(len(design.points)))
    wanted = np.clip(design.points[index] + rng.normal(scale=0.01, size=2), -REACH, REACH)
    moved = design.moved(index, wanted)
    assert isinstance(moved, DrawingDesign) and isinstance(moved.curve, SplineCurve)
    assert np.abs(moved.points[index] - wanted).max() < GRAIN
    assert np.array_equal(moved.points, moved.curve.at(moved.theta))
    sample = design.curve.sample(4000)
    bent = np.linalg.norm(moved.curve.at(sample) - design.curve.at(sample), axis=1) > 3 * GRAIN
    before, after = gaps(design, index)
    least = 6 * PERIOD / moved.curve.pieces  # of the widest function of a narrow bump
    away = sample - design.theta[index]
    if design.curve.closed:
        away = (away + np.pi) % PERIOD - np.pi
    inside = (away > -max(before, least) - least) & (away < max(after, least) + least)
    assert not (bent & ~inside).any()
    back = moved.moved(index, design.points[index])
    assert np.abs(back.curve.at(sample) - design.curve.at(sample)).max() < 3 * GRAIN


@settings(max_examples=12, deadline=None)
@given(SEEDS)
def test_a_corner_is_carried_along_as_it_is(seed: int) -> None:
    rng = np.random.default_rng(seed)
    count = int(rng.integers(3, 6))
    angle = PERIOD * (np.arange(2 * count) / (2 * count) + rng.random())
    radius = np.where(np.arange(2 * count) % 2, rng.uniform(0.4, 0.6), 1.0) * 0.06
    star = radius[:, None] * np.column_stack([np.cos(angle), np.sin(angle)])
    design = from_curve(spline_through([star], closed=True))
    assert isinstance(design, DrawingDesign)
    index = int(rng.integers(len(design.points)))
    moved = design.moved(index, design.points[index] + rng.normal(scale=0.01, size=2))
    pieces = design.first.pieces
    theta = PERIOD * (np.arange(pieces)[:, None] + np.linspace(0, 1, 9)) / pieces - np.pi
    bends = np.abs(design.curve.curvature(theta)).max(axis=1)
    for gap in (-gaps(design, index)[0], gaps(design, index)[1]):
        between = design.theta[index] + np.linspace(0, gap, 200)
        place = ((between + np.pi) * pieces / PERIOD)[:, None] - np.flatnonzero(bends > 1 / 4e-3)
        inside = (place + 2) % pieces < 5  # of the control points that act on a tight bend
        assume((~inside.any(axis=1)).mean() * abs(gap) * pieces / PERIOD > 1.0)
    shift = moved.curve.at(theta) - design.curve.at(theta)
    tight = bends > 1 / 2e-3
    assert tight.any() and np.ptp(shift, axis=1)[tight].max() < 3 * GRAIN


@pytest.mark.thorough
@settings(max_examples=30, deadline=None)
@given(SEEDS)
def test_more_and_fewer_handles_leave_the_drawing_as_it_is(seed: int) -> None:
    rng, design = np.random.default_rng(seed), some_drawing(seed)
    curve = design.curve
    for _ in range(12):
        index = int(rng.integers(len(design.points)))
        change = design.added if rng.random() < 0.6 else design.removed
        try:
            design = change(index)
        except ValueError:
            assert len(design.points) in (2, 3, MOST_POINTS)
            continue
        assert isinstance(design, DrawingDesign) and design.curve is curve
        assert np.array_equal(design.points, curve.at(design.theta))
        assert (np.diff(design.theta) > 0).all() and np.abs(design.theta).max() <= np.pi


def test_a_drawing_has_a_least_and_a_greatest_number_of_handles() -> None:
    for closed, least in ((True, 3), (False, 2)):
        design = from_curve(random_drawing(1, closed=closed))
        for _ in range(MOST_POINTS - len(design.points)):
            design = design.added(0)
        with pytest.raises(ValueError, match=f"at most {MOST_POINTS}"):
            design.added(0)
        for _ in range(MOST_POINTS - least):
            design = design.removed(len(design.points) - 1)
        with pytest.raises(ValueError, match=f"at least {least}"):
            design.removed(0)
        with pytest.raises(ValueError, match="control point"):
            design.moved(least, np.zeros(2))


@pytest.mark.thorough
@settings(max_examples=20, deadline=None)
@given(SEEDS, st.booleans())
def test_a_stroke_is_followed_as_it_was_drawn(seed: int, closed: bool) -> None:
    """However the hand trembles, by a third of a millimetre."""
    rng = np.random.default_rng(seed)
    if closed:
        t = np.linspace(0, 2 * np.pi * 0.99, 400)
        radius = 0.05 + 0.01 * np.cos(rng.integers(2, 5) * t + rng.uniform(0, 6))
        meant = radius[:, None] * np.column_stack([np.cos(t), np.sin(t)])
    else:
        corners = np.column_stack([np.linspace(-0.07, 0.07, 7), rng.uniform(-0.03, 0.03, 7)])
        meant = CubicSpline(np.arange(7), corners)(np.linspace(0, 6, 400))
    meant = meant[:: int(rng.choice([-1, 1]))]
    design = drawn(meant + rng.normal(scale=3e-4, size=meant.shape))
    curve = design.curve
    assert isinstance(curve, SplineCurve) and design.name == "drawn"
    assert curve.closed == (closed or bool(curve.raised)) and not (closed and curve.raised)
    assert np.sqrt((curve.nearest(meant)[1] ** 2).mean()) < 5e-4
    theta = curve.nearest(meant[[100, 120]])[0]
    assert theta[0] < theta[1]  # in the direction of the hand


@pytest.mark.parametrize("closed", [True, False])
def test_stroke_loses_its_tremor_and_keeps_its_shape(closed: bool) -> None:
    rng = np.random.default_rng(0)
    angle = np.linspace(-np.pi, np.pi if closed else 1.0, 300)
    line = 0.06 * np.column_stack([np.cos(angle), np.sin(angle)])
    curve = drawn(line + 3e-4 * rng.normal(size=line.shape)).curve
    assert isinstance(curve, SplineCurve) and curve.closed and bool(curve.raised) != closed
    inside = curve.sample()
    inside = inside if closed else inside[curve.draws(inside)][40:-40]
    radius = np.linalg.norm(curve.at(inside), axis=1)
    assert radius.std() < 2e-4
    assert radius == pytest.approx(0.06, rel=0.05)
    steady = drawn(line).curve
    assert isinstance(steady, SplineCurve)
    assert curve.duration < 1.1 * steady.duration  # as quickly: the tremor has left no bends


BAD_STROKES = [
    np.zeros((0, 2)),
    np.zeros((1, 2)),
    np.zeros((50, 2)),
    np.full((5, 2), np.nan),
    np.array([[0, 0], [np.inf, 0], [0.1, 0.1]]),
    np.array([[0, 0], [0.001, 0], [0.002, 0.001]]),
    np.zeros(4),
]


@pytest.mark.parametrize("stroke", BAD_STROKES, ids=str)
def test_an_invalid_stroke_is_refused_with_a_reason(stroke: np.ndarray) -> None:
    with pytest.raises(ValueError, match=r"path|stroke"):
        drawn(stroke)


@pytest.mark.parametrize("seed", range(3))
def test_the_nearest_drawing_can_be_followed_and_is_as_near_as_is_said(seed: int) -> None:
    large = replace(scrawl(seed), points=3 * scrawl(seed).points)
    margin = FIVE_BAR.make(FIVE_BAR.parameters()).margin
    assert curve_faults(margin, large)
    found = nearest_path(margin, large)
    assert found is not None and not curve_faults(margin, found)
    far = found.nearest(large.at(large.sample()))[1].max()
    assert 0.01 < far <= found.deviation + 1e-6 < far + 3 * large.deviation + 5e-3
