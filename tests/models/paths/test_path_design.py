"""Paths as a user makes them, and every reason for which one is refused."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import assume, event, given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from onpath.app.lab.path_editor import BLEND, PathEditor
from onpath.models.arrays import Array
from onpath.models.paths.curve_blend import aligned
from onpath.models.paths.curve_faults import ambiguities, curve_faults, strand_faults
from onpath.models.paths.curve_fit import closed_through, control_points, open_through
from onpath.models.paths.curves import Curve, chebyshev_curve, circle, ellipse, fourier, segment
from onpath.models.paths.path_checks import LEAST_MARGIN, STRANDS_APART, TUBE
from onpath.models.paths.path_design import MOST_POINTS, REACH, PathDesign, presets
from onpath.models.systems.five_bar_robot import RIGID_FIVE_BAR

ROBOT = RIGID_FIVE_BAR
GOOD = list(presets())
RINGS = [n for n in GOOD if presets()[n].curve.closed and n != "figure of eight"]


def reasons(curve: Curve) -> list[str]:
    return [str(fault.reason) for fault in curve_faults(ROBOT.margin, curve)]


def doubts(curve: Curve) -> list[str]:
    return [str(fault.reason) for fault in ambiguities(curve)]


def teardrop(sharpness: float) -> Curve:
    """An ellipse-like curve whose sharpest bend has the radius b^2 / a."""
    a = 0.06
    return ellipse((a, math.sqrt(a * sharpness)))


# What is refused, and why


@pytest.mark.parametrize("name", GOOD)
def test_presets_are_good_paths(name: str) -> None:
    design = presets()[name]
    assert design.name == name and reasons(design.curve) == []
    assert design.curve.nearest(design.points)[1].max() < 1e-6


def test_of_the_presets_only_the_figure_of_eight_is_ambiguous_where_it_crosses() -> None:
    for name in presets():
        if name != "figure of eight":
            assert ambiguities(presets()[name].curve) == []
    found = ambiguities(presets()["figure of eight"].curve)
    assert len(found) == 1 and "crosses itself" in str(found[0].reason)
    assert np.linalg.norm(found[0].points, axis=1).max() < 1e-6  # in the middle, and only there


@pytest.mark.parametrize("offset", [0.0, 0.02, -0.03])
def test_path_leaves_the_workspace_where_the_arm_ends(offset: float) -> None:
    # the arm, stretched, reaches a circle of 0.4 m about (-0.2, -0.2)
    middle = np.array([-0.2, -0.2]) + 0.4 * np.array([np.cos(0.8 + offset), np.sin(0.8 + offset)])
    outside = circle(0.02, centre=(float(middle[0]), float(middle[1])))
    faults = curve_faults(ROBOT.margin, outside)
    where = next(f.points for f in faults if "leaves the workspace" in str(f.reason))
    assert np.all(np.hypot(*(where + 0.2).T) >= 0.4 - 1e-9)
    theta = outside.sample(240)
    beyond = np.hypot(*(outside.at(theta) + 0.2).T) >= 0.4
    assert len(where) == beyond.sum()


@settings(max_examples=40, deadline=None)
@given(st.floats(0.0, 2 * math.pi), st.one_of(st.floats(0.012, 0.06), st.floats(0.36, 0.42)))
def test_singular_configurations_are_kept_clear_of(angle: float, reach: float) -> None:
    # |sin(q1 - q2)| at distance d from the base, by the cosine rule
    middle = reach * np.array([np.cos(angle), np.sin(angle)]) - 0.2
    small = circle(0.009, centre=(float(middle[0]), float(middle[1])))
    d = np.hypot(*(small.at(small.sample(240)) + 0.2).T)
    gap = np.arccos(np.clip((0.08 - d**2) / 0.08, -1, 1))
    margin = np.abs(np.sin(gap))
    assume(np.abs(margin - LEAST_MARGIN).min() > 1e-6 and np.abs(d - 0.4).min() > 1e-6)
    near = any("singular" in reason for reason in reasons(small))
    event(f"near: {near}")
    assert near == bool(np.any((margin < LEAST_MARGIN) & (d < 0.4)))


@pytest.mark.parametrize(("radius", "refused"), [(TUBE * 1.05, False), (TUBE * 0.95, True)])
def test_bend_must_be_as_wide_as_the_tube(radius: float, refused: bool) -> None:
    for curve in (circle(radius), teardrop(radius)):
        found = curve_faults(ROBOT.margin, curve)
        assert [("bends too sharply" in str(f.reason)) for f in found] == [True] * refused
    if refused:  # at the sharp ends only
        where = found[0].points
        assert np.all(np.abs(where[:, 0]) > 0.05)


def test_cusp_is_refused() -> None:
    # a deltoid: three cusps
    a = 0.02
    cosine, sine = np.array([[2 * a, 0], [a, 0]]), np.array([[0, 2 * a], [0, -a]])
    found = {
        str(f.reason).split(",")[0]: f.points
        for f in curve_faults(ROBOT.margin, fourier(np.zeros(2), cosine, sine))
    }
    assert any("cusp" in reason for reason in found)


def test_numbers_that_are_not_finite_are_refused() -> None:
    assert "not numbers" in reasons(circle(math.nan))[0]


def test_a_crossing_of_an_open_path_is_found_too() -> None:
    # a loop in the ribbon: x = T1 - 1.6 T3-like, y = T2
    loop = chebyshev_curve(np.array([[0, 0], [0.01, 0], [0, 0.03], [0.03, 0]]))
    assert any("crosses itself" in doubt for doubt in doubts(loop))
    assert reasons(segment((-0.05, 0.0), (0.05, 0.02))) == []


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 10**6), st.booleans(), st.integers(4, 14))
def test_strands_cross_where_two_of_their_segments_do(seed: int, closed: bool, count: int) -> None:
    z = np.random.default_rng(seed).uniform(-1, 1, (count, 2))
    line = np.vstack([z, z[:1]]) if closed else z
    s = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))])
    pairs = 0
    for i in range(len(line) - 1):
        for j in range(i + 2, len(line) - 1):
            if min(s[j] - s[i], s[-1] - s[j] + s[i] if closed else np.inf) < STRANDS_APART:
                continue
            sides = [
                np.linalg.det(np.stack([q - line[a], line[a + 1] - line[a]]))
                for a, q in ((i, line[j]), (i, line[j + 1]), (j, line[i]), (j, line[i + 1]))
            ]
            pairs += sides[0] * sides[1] < 0 and sides[2] * sides[3] < 0
    found = [len(fault.points) for fault in strand_faults(z, closed) if fault.check == "crosses"]
    assert sum(found) == pairs


# Editing


@pytest.mark.parametrize("name", GOOD)
def test_moving_a_point_moves_the_path_there_and_not_elsewhere(name: str) -> None:
    design = presets()[name]
    before, points = design.curve.at(np.linspace(-3, 3, 50)), design.points.copy()
    index = len(points) - 1
    target = points[index] + [0.004, -0.003]
    moved = design.moved(index, target)
    assert moved.name == "edited" and np.array_equal(moved.points[index], target)
    assert np.array_equal(np.delete(moved.points, index, 0), np.delete(points, index, 0))
    assert moved.curve.nearest(target[None])[1][0] < 1.5e-3
    far = np.linalg.norm(points - points[index], axis=1).argmax()
    assert moved.curve.nearest(points[[far]])[1][0] < 1.5e-3
    assert np.array_equal(design.points, points)
    assert np.array_equal(design.curve.at(np.linspace(-3, 3, 50)), before)


@settings(max_examples=40, deadline=None)
@given(st.sampled_from(GOOD), st.integers(0, 30), st.floats(allow_nan=True, allow_infinity=True))
def test_a_point_is_not_moved_to_an_invalid_place(name: str, index: int, x: float) -> None:
    design = presets()[name]
    if index >= len(design.points) or not math.isfinite(x):
        with pytest.raises(ValueError, match="control point"):
            design.moved(index, np.array([x, 0.0]))
    else:
        try:
            moved = design.moved(index, np.array([x, 0.0]))
        except ValueError as error:
            assert "path" in str(error)
        else:
            assert np.abs(moved.points).max() <= REACH
            assert np.isfinite(moved.curve.coefficients).all()


@pytest.mark.parametrize("name", GOOD)
def test_added_point_lies_on_the_path_and_hardly_changes_it(name: str) -> None:
    design = presets()[name]
    for index in range(len(design.points)):
        more = design.added(index)
        assert len(more.points) == len(design.points) + 1
        new = [p for p in more.points if np.abs(design.points - p).sum(1).min() > 1e-9]
        assert len(new) == 1 and design.curve.nearest(np.array(new))[1][0] < 1e-6
        sample = more.curve.at(more.curve.sample(64))
        assert design.curve.nearest(sample)[1].max() < 3e-3
        less = more.removed([np.array_equal(p, new[0]) for p in more.points].index(True))
        assert np.array_equal(less.points, design.points)


def test_there_is_a_least_and_a_greatest_number_of_points() -> None:
    for name, least in (("circle", 3), ("segment", 2)):
        design = presets()[name]
        while len(design.points) > least:
            design = design.removed(len(design.points) - 1)
        with pytest.raises(ValueError, match=f"at least {least}"):
            design.removed(0)
    design = presets()["circle"]
    for k in range(MOST_POINTS - len(design.points)):
        design = design.added(k % len(design.points))
    with pytest.raises(ValueError, match=f"at most {MOST_POINTS}"):
        design.added(0)


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 10**6), st.floats(-3, 3), st.sampled_from([1, -1]))
def test_alignment_changes_the_parameter_and_not_the_curve(
    seed: int, shift: float, sense: int
) -> None:
    rng = np.random.default_rng(seed)
    falling = 1e-2 / np.arange(1, 5)[:, None] ** 2
    a, b = falling * rng.normal(size=(2, 4, 2))
    base = fourier(rng.normal(size=2), a, b)
    k = np.arange(1, 5)[:, None]
    turned_a = np.cos(k * shift) * a + sense * np.sin(k * shift) * b
    turned_b = sense * np.cos(k * shift) * b - np.sin(k * shift) * a
    turned = fourier(base.series[0, 0], turned_a, turned_b)
    back = aligned(turned, base)
    grid = base.sample(360)  # whole degrees, as alignment goes
    points, given_points = back.at(grid), turned.at(grid)
    orders = [np.roll(given_points[::s], k, axis=0) for s in (1, -1) for k in range(360)]
    assert min(np.abs(order - points).max() for order in orders) < 1e-12
    # nothing else on the grid is nearer to `base`, not even what undoes the turning
    half_degree = math.radians(0.5) ** 2 * (base.at(grid, 1) ** 2).sum()
    assert ((points - base.at(grid)) ** 2).sum() <= 1.01 * half_degree


# The editor


def test_edit_blends_in_over_its_time_without_a_jump() -> None:
    editor = PathEditor(ROBOT, presets()["circle"])
    assert editor.commit(presets()["ellipse"])
    theta = np.linspace(-np.pi, np.pi, 40)
    before, steps = editor.curve.at(theta), 0
    while editor.curve is not presets_curve(editor):
        editor.advance(1 / 60)
        after = editor.curve.at(theta)
        assert np.abs(after - before).max() < 0.002
        assert np.array_equal(editor.table, editor.curve.table())
        before, steps = after, steps + 1
        assert steps < 100
    assert steps == math.ceil(BLEND * 60 - 1e-9)
    assert not editor.advance(1 / 60)


def presets_curve(editor: PathEditor) -> Curve:
    return editor.design.curve


def test_change_of_kind_is_told_once_as_a_jump() -> None:
    editor = PathEditor(ROBOT, presets()["circle"])
    editor.commit(presets()["segment"])
    assert [editor.advance(0.01) for _ in range(3)] == [True, False, False]
    assert not editor.curve.closed


def test_settling_lets_go_of_what_was_proposed() -> None:
    editor = PathEditor(ROBOT, presets()["circle"])
    assert editor.propose(presets()["ellipse"])
    editor.advance(BLEND / 2)
    editor.settle()
    assert editor.curve is editor.blend.target is editor.design.curve
    assert editor.blend.before is None and not editor.advance(BLEND)
    assert editor.curve is editor.design.curve


FAR = PathDesign("far", circle(0.3), control_points(circle(0.3), 8))
"""Out of the robot's reach."""


def test_refused_edit_leaves_the_path_and_marks_the_places() -> None:
    editor = PathEditor(ROBOT, presets()["circle"])
    design = editor.design
    assert not editor.commit(FAR)
    assert editor.design is design and editor.proposed is None
    assert any("leaves the workspace" in str(fault.reason) for fault in editor.faults)
    for _ in range(40):
        editor.advance(1 / 60)
    assert editor.curve is design.curve
    assert editor.commit(presets()["ellipse"]) and editor.faults == []


def test_selection_is_of_a_point_that_exists() -> None:
    editor = PathEditor(ROBOT, presets()["clover"])
    last = len(editor.design.points) - 1
    editor.select(last)
    assert editor.selected == last
    editor.commit(presets()["segment"])
    assert editor.selected is None
    for index in (-1, 2, 99, None):
        editor.select(index)
        assert editor.selected is None


def test_version_changes_with_everything_that_is_drawn() -> None:
    editor = PathEditor(ROBOT, presets()["circle"])
    bad: PathDesign = FAR
    seen = [editor.version]
    for act in (
        lambda: editor.select(1),
        lambda: editor.propose(presets()["ellipse"]),
        lambda: editor.advance(0.01),
        lambda: editor.finish(),
        lambda: editor.commit(bad),
        lambda: editor.undo(),
        lambda: editor.redo(),
    ):
        act()
        assert editor.version > seen[-1]
        seen.append(editor.version)


# The tube: its width


def wavy(seed: int, size: float) -> Curve:
    """A closed curve of up to five harmonics about the middle of the workspace."""
    rng = np.random.default_rng(seed)
    shrink = size / np.arange(1, 6)[:, None] ** 2
    cosine, sine = rng.normal(size=(2, 5, 2)) * shrink
    cosine[0, 0] += 0.04
    sine[0, 1] += 0.04
    return fourier(np.zeros(2), cosine, sine)


def overtaken(curve: Curve, depth: float) -> NDArray[np.bool_]:
    """Where a point at that distance from the curve, on either side, is nearer to another strand.

    Returns:
        For 150 points of the curve.
    """
    theta = curve.sample(150)
    first = curve.at(theta, 1)
    normal = np.stack([-first[:, 1], first[:, 0]], axis=1)
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    sides = [curve.nearest(curve.at(theta) + side * depth * normal)[1] for side in (1, -1)]
    return np.min(sides, axis=0) < depth - 1e-6


def peanut(waist: float, bulge: float) -> Curve:
    """A closed curve with a waist in the middle, [m]."""
    theta = np.linspace(-np.pi, np.pi, 64, endpoint=False)
    height = waist / 2 + bulge * np.cos(theta) ** 2
    return closed_through(np.column_stack([0.08 * np.cos(theta), np.sin(theta) * height]))


@pytest.mark.thorough
@settings(max_examples=60, deadline=None)
@given(
    st.one_of(
        st.builds(wavy, st.integers(0, 10**6), st.floats(0.0, 0.02)),
        st.builds(peanut, st.floats(0.001, 0.04), st.floats(0.015, 0.03)),
    )
)
def test_in_the_tube_of_an_accepted_path_the_closest_point_is_unique(curve: Curve) -> None:
    faults = curve_faults(everywhere, curve) + ambiguities(curve)
    found = {str(fault.reason) for fault in faults}
    narrow = any("two strands" in reason for reason in found)
    event(f"accepted: {not found}, only narrow: {narrow and len(found) == 1}")
    if not found:
        assert not overtaken(curve, 0.98 * TUBE).any()
    elif narrow and len(found) == 1:
        assert overtaken(curve, TUBE).any()


def everywhere(z: Array) -> Array:
    """A robot that reaches all points equally well."""
    return np.ones(len(z))


@pytest.mark.parametrize(("waist", "narrow"), [(0.015, True), (0.017, False)])
def test_a_waist_is_narrow_if_the_tube_is_wider(waist: float, narrow: bool) -> None:
    assert curve_faults(everywhere, peanut(waist, 0.02)) == []
    found = ambiguities(peanut(waist, 0.02))
    assert bool(found) == narrow
    if narrow:
        assert "two strands" in str(found[0].reason)
        assert np.all(np.abs(found[0].points[:, 0]) < 0.03)


def test_the_strands_of_an_open_path_are_kept_apart_too() -> None:
    hairpin = open_through(
        np.array([[-0.06, 0.0], [0.05, 0.0], [0.06, 0.006], [0.05, 0.012], [-0.06, 0.012]])
    )
    assert any("two strands" in doubt for doubt in doubts(hairpin))
