"""Laws of the paths: exact conics, exact derivatives, fits, the global search."""

from __future__ import annotations

from collections.abc import Callable
from xml.etree import ElementTree

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from onpath.models.arrays import Array
from onpath.models.paths.curve_blend import blend
from onpath.models.paths.curve_fit import (
    FAR,
    closed_through,
    control_points,
    deviation_remark,
    fitted,
    open_through,
)
from onpath.models.paths.curves import (
    HARMONICS,
    ORDERS,
    TABLE_SHAPE,
    Curve,
    chebyshev_curve,
    circle,
    ellipse,
    segment,
)

THETA = np.linspace(-np.pi, np.pi, 41)


def some_open_curve(seed: int) -> Curve:
    rng = np.random.default_rng(seed)
    coefficients = (
        0.02 * rng.normal(size=(HARMONICS + 1, 2)) / np.arange(1, HARMONICS + 2)[:, None] ** 2
    )
    coefficients[1, 0] += 0.06
    return chebyshev_curve(coefficients)


def dense(curve: Curve, beyond: float = 0.0, count: int = 4001) -> Array:
    return curve.at(np.linspace(-np.pi - beyond, np.pi + beyond, count))


def distance_to(curve: Curve, points: Array) -> Array:
    """By brute force, to about 1e-5 m."""
    return np.linalg.norm(points[:, None] - dense(curve)[None], axis=-1).min(axis=1)


def test_circle_and_ellipse_are_exact() -> None:
    x, y = ellipse((0.06, 0.03), (0.01, -0.02)).at(THETA).T
    assert x == pytest.approx(0.01 + 0.06 * np.cos(THETA), abs=1e-16)
    assert y == pytest.approx(-0.02 + 0.03 * np.sin(THETA), abs=1e-16)
    assert circle(0.05).curvature(THETA) == pytest.approx(np.full(41, 20.0))
    assert circle(0.05).length() == pytest.approx(0.1 * np.pi)


def test_segment_runs_from_start_to_end_and_on() -> None:
    line = segment((-0.01, 0.02), (0.03, 0.05))
    ends = line.at(np.array([-np.pi, np.pi, 2 * np.pi]))
    assert ends == pytest.approx(np.array([[-0.01, 0.02], [0.03, 0.05], [0.05, 0.065]]))
    assert line.length() == pytest.approx(0.05)
    assert line.curvature(THETA) == pytest.approx(np.zeros(41), abs=1e-9)


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("closed", [True, False])
@pytest.mark.parametrize("order", range(ORDERS - 1))
def test_derivatives_are_derivatives(
    random_curve: Callable[[int], Curve], seed: int, closed: bool, order: int
) -> None:
    curve, h = random_curve(seed) if closed else some_open_curve(seed), 1e-5
    theta = THETA if closed else np.concatenate([THETA[1:-1], [-4.0, 3.5, 9.0]])
    slope = (curve.at(theta + h, order) - curve.at(theta - h, order)) / (2 * h)
    exact = curve.at(theta, order + 1)
    assert np.abs(slope - exact).max() < 1e-6 * max(1.0, np.abs(exact).max())


def test_open_curve_goes_on_along_its_tangents() -> None:
    curve = some_open_curve(3)
    for end in (-np.pi, np.pi):
        theta = end + np.sign(end) * np.array([0.0, 1e-9, 0.5, 2.0])
        steps = curve.at(theta) - curve.at(theta[:1])
        assert steps == pytest.approx((theta - end)[:, None] * curve.at(theta[:1], 1))
        assert np.all(curve.at(theta[1:], 2) == 0)


def test_table_is_the_series_by_columns() -> None:
    curve = some_open_curve(1)
    x = THETA[7] / np.pi
    basis = np.concatenate([np.cos(np.arange(13) * np.arccos(x)), np.zeros(12)])
    rows = curve.table().reshape(TABLE_SHAPE, order="F") @ basis
    assert rows.reshape(ORDERS, 2) == pytest.approx(
        np.array([curve.at(THETA[7], order) for order in range(ORDERS)])
    )


@pytest.mark.parametrize("curve", [ellipse((0.07, 0.03)), segment((0, 0), (0.1, 0))])
def test_a_curve_and_its_table_are_stored_once_after_a_blend_too(curve: Curve) -> None:
    """While a path is dragged, a history keeps a curve for each frame."""
    for each in (curve, blend(curve, curve, 0.5)):
        assert np.shares_memory(each.table(), each.coefficients)


@pytest.mark.thorough
@given(st.integers(0, 10_000), st.booleans())
def test_nearest_point_is_nearest(seed: int, closed: bool) -> None:
    rng = np.random.default_rng(seed)
    curve = closed_through(star(rng)) if closed else some_open_curve(seed)
    points = rng.uniform(-0.12, 0.12, (20, 2))
    theta, distance = curve.nearest(points)
    assert distance == pytest.approx(np.linalg.norm(points - curve.at(theta), axis=1))
    assert np.all(distance <= distance_to(curve, points) + 1e-9)


def star(rng: np.random.Generator, corners: int = 8) -> Array:
    """Corners of a polygon about the origin, in order."""
    angle = np.linspace(-np.pi, np.pi, corners, endpoint=False) + rng.uniform(-0.2, 0.2, corners)
    radius = rng.uniform(0.045, 0.06, corners)
    return radius[:, None] * np.column_stack([np.cos(angle), np.sin(angle)])


@given(st.integers(0, 10_000))
def test_closed_fit_passes_near_its_points_at_even_speed(seed: int) -> None:
    points = star(np.random.default_rng(seed))
    curve = closed_through(points)
    assert distance_to(curve, points).max() < 5e-4
    assert curve.at(np.array(-np.pi)) == pytest.approx(curve.at(np.array(np.pi)))
    speed = np.linalg.norm(curve.at(curve.sample(), 1), axis=1)
    assert np.ptp(speed) < 0.2 * speed.mean()


def test_closed_fit_of_a_circle_is_that_circle() -> None:
    angle = np.linspace(0, 2 * np.pi, 24, endpoint=False)
    curve = closed_through(0.05 * np.column_stack([np.cos(angle), np.sin(angle)]))
    assert np.linalg.norm(dense(curve), axis=1) == pytest.approx(np.full(4001, 0.05), rel=1e-4)


def test_open_fit_starts_and_ends_where_its_points_do() -> None:
    x = np.linspace(-0.06, 0.06, 6)
    points = np.column_stack([x, 0.02 * np.sin(40 * x)])
    curve = open_through(points)
    assert not curve.closed
    assert distance_to(curve, points).max() < 5e-4
    assert curve.at(np.array([-np.pi, np.pi])) == pytest.approx(points[[0, -1]], abs=5e-4)
    straight = open_through(points[[0, -1]])
    assert np.abs(straight.curvature(THETA)).max() < 1e-9


def test_control_points_give_the_curve_back() -> None:
    curve = closed_through(star(np.random.default_rng(5)))
    again = closed_through(control_points(curve, 16))
    assert distance_to(curve, dense(again, count=201)).max() < 1e-3
    points = control_points(some_open_curve(2), 6)
    gaps = [some_open_curve(2).nearest(points)[0][i] for i in (0, -1)]
    assert gaps == pytest.approx([-np.pi, np.pi], abs=1e-3)


@pytest.mark.parametrize("fit", [closed_through, open_through])
@pytest.mark.parametrize(
    "points, reason",
    [
        ([[0.0, 0.0]], "at least"),
        ([[0.01, 0.01]] * 9, "at least"),
        ([[0.0, 0.0], [0.001, 0.0], [0.0, 0.001], [0.001, 0.001]], "too short"),
        ([[0.0, 0.0], [np.nan, 0.1], [0.1, 0.0]], "finite"),
        ([[0.0, 0.0, 0.0], [0.1, 0.1, 0.0], [0.2, 0.0, 0.0]], "shape"),
    ],
)
def test_points_that_do_not_form_a_path_are_refused(
    fit: Callable[[Array], Curve], points: list[list[float]], reason: str
) -> None:
    with pytest.raises(ValueError, match=reason):
        fit(np.array(points))


def test_conic_is_recognised_and_vanishes_on_its_curve() -> None:
    for half_axes in ((0.05, 0.05), (0.06, 0.02), (0.03, 0.08)):
        for angle in (0.0, 0.5, -2.0):
            curve = ellipse(half_axes, (0.01, 0.02), angle)
            conic = curve.conic()
            assert conic is not None
            centre, (g11, g22, g12), constant = conic
            x, y = (curve.at(THETA) - centre).T
            assert g11 * x**2 + 2 * g12 * x * y + g22 * y**2 == pytest.approx(constant)
            assert g11 * g22 - g12**2 == pytest.approx(1.0)
    conic = circle(0.05).conic()
    assert conic is not None
    assert conic[1] == pytest.approx([1.0, 1.0, 0.0]) and conic[2] == pytest.approx(0.05**2)


def test_an_ellipse_is_turned_about_its_centre() -> None:
    turned, upright = ellipse((0.06, 0.02), (0.01, 0.02), 0.7), ellipse((0.06, 0.02))
    c, s = np.cos(0.7), np.sin(0.7)
    expected = upright.at(THETA) @ np.array([[c, s], [-s, c]]) + [0.01, 0.02]
    assert turned.at(THETA) == pytest.approx(expected, abs=1e-15)
    assert np.array_equal(ellipse((0.06, 0.02), angle=0.0).series, upright.series)


def test_other_curves_are_no_conics(random_curve: Callable[[int], Curve]) -> None:
    assert random_curve(0).conic() is None
    assert segment((0, 0), (0.1, 0)).conic() is None


@given(st.floats(0, 1))
def test_blend_moves_every_point_along_a_line(fraction: float) -> None:
    old, new = circle(0.05), ellipse((0.07, 0.03), (0.0, 0.01))
    between = blend(old, new, fraction)
    for order in range(ORDERS):
        expected = (1 - fraction) * old.at(THETA, order) + fraction * new.at(THETA, order)
        assert between.at(THETA, order) == pytest.approx(expected, abs=1e-15)


@pytest.mark.parametrize("count", [500, 5_000, 50_000])
@pytest.mark.parametrize("fit", [closed_through, open_through])
def test_points_may_be_as_dense_as_they_like(fit: Callable[[Array], Curve], count: int) -> None:
    angle = np.linspace(0, 2 * np.pi if fit is closed_through else 4.0, count, endpoint=False)
    curve = fit(0.05 * np.column_stack([np.cos(angle), np.sin(angle)]))
    assert np.linalg.norm(dense(curve), axis=1) == pytest.approx(np.full(4001, 0.05), abs=2e-6)


def polygon_distance(z: Array, corners: Array) -> Array:
    """Distances of points from a closed polygon, (n, 2) and (k, 2) -> (n,)."""
    way = np.roll(corners, -1, axis=0) - corners
    share = np.einsum("nki,ki->nk", z[:, None] - corners, way) / (way**2).sum(1)
    nearest = corners + np.clip(share, 0, 1)[..., None] * way
    return np.linalg.norm(z[:, None] - nearest, axis=2).min(1)


@pytest.mark.thorough
@given(st.integers(0, 10_000))
def test_a_fitted_curve_tells_how_far_it_is_from_the_lines_between_its_points(seed: int) -> None:
    corners = star(np.random.default_rng(seed))
    curve = fitted(corners, closed=True)
    beside = polygon_distance(dense(curve, count=400), corners).max()
    ends = zip(corners, np.roll(corners, -1, axis=0), strict=True)
    places = np.concatenate([np.linspace(a, b, 60) for a, b in ends])
    expected = max(beside, curve.nearest(places)[1].max())
    assert curve.deviation == pytest.approx(expected, abs=1e-4)
    assert np.array_equal(curve.series, closed_through(corners).series)


def test_a_user_is_told_of_corners_that_are_cut_and_of_nothing_else() -> None:
    square = 0.05 * np.array([[1, 1], [-1, 1], [-1, -1], [1, -1]])
    remark = deviation_remark(fitted(square, closed=True))
    assert remark is not None and "18.8 mm" in str(remark)
    ends = zip(square, np.roll(square, -1, axis=0), strict=True)
    sides = np.concatenate([np.linspace(a, b, 50, endpoint=False) for a, b in ends])
    assert 1e-3 < fitted(sides, closed=True).deviation < FAR  # corners rounded by some mm
    angle = np.linspace(0, 2 * np.pi, 8, endpoint=False)
    eight = fitted(0.05 * np.column_stack([np.cos(angle), np.sin(angle)]), closed=True)
    assert deviation_remark(eight) is None and deviation_remark(circle(0.05)) is None
    assert fitted(square[:2], closed=False).deviation == pytest.approx(0, abs=1e-9)


def test_a_notebook_shows_a_curve_in_a_line_and_as_a_picture() -> None:
    curve = ellipse((0.07, 0.04), (0.01, 0.02))
    assert repr(curve) == "<closed path, 352 mm long, 140 x 80 mm>"
    assert repr(some_open_curve(0)).startswith("<open path, ")
    drawing = ElementTree.fromstring(curve._repr_svg_())
    left, top, width, height = map(float, drawing.attrib["viewBox"].split())
    line, dot = drawing
    places = np.array([point.split(",") for point in line.attrib["points"].split()], dtype=float)
    assert (left, top) < (places[:, 0].min(), places[:, 1].min())
    assert (left + width, top + height) > (places[:, 0].max(), places[:, 1].max())
    assert places * (1, -1) / 1e3 == pytest.approx(dense(curve, count=len(places)), abs=1e-4)
    assert (float(dot.attrib["cx"]), float(dot.attrib["cy"])) == (80.0, -20.0)  # θ = 0
    assert len(curve._repr_svg_()) < 4000
    assert curve._repr_html_() == f"{curve._repr_svg_()}<p>{repr(curve)[1:-1]}</p>"


@pytest.mark.parametrize("seed", range(20))
def test_the_length_between_two_parameters_is_that_of_the_arcs(random_curve, seed):
    rng, curve = np.random.default_rng(seed), random_curve(seed)
    begin, end = rng.uniform(-np.pi, np.pi, 2)
    if curve.closed and seed % 2:  # over the seam
        begin, end = np.pi - rng.uniform(0, 1), np.pi + rng.uniform(0, 1)
    along = abs(float(np.diff(curve.arc(np.array([begin, end])))[0]))
    assert curve.length_between(begin, end) == pytest.approx(along, abs=2e-5)
    assert curve.length_between(end, begin) == pytest.approx(curve.length_between(begin, end))
    assert curve.length_between(begin, begin) == 0.0
