"""Space curves: derivatives, closest points, faults, and planar curves among them."""

from __future__ import annotations

import numpy as np
import pytest

from onpath.models.arrays import Array
from onpath.models.paths.curve_blend import blend
from onpath.models.paths.curve_faults import ambiguities, curve_faults
from onpath.models.paths.curves import Curve, SeriesCurve, chebyshev_curve, circle, fourier, segment
from onpath.models.paths.distance import closest_parameter, near_distances, path_distance
from onpath.models.paths.frames import LevelPlane, Plane, SlantedPlane, Space
from onpath.models.paths.path_checks import TUBE
from onpath.models.paths.path_design import presets
from onpath.models.paths.space_curves import in_space, saddle
from onpath.models.systems.spatial_arm import SPATIAL_ARM

FRAME = LevelPlane()
RAISED = [
    saddle(circle(0.05), 0.03),
    saddle(presets()["clover"].curve, -0.02),
    saddle(segment((-0.06, -0.02), (0.06, 0.03)), 0.02),
]


@pytest.mark.parametrize("curve", RAISED)
def test_each_order_is_the_derivative_of_the_one_before(curve: Curve) -> None:
    theta, h = np.linspace(-3, 3, 40), 1e-5
    for order in range(3):
        slope = (curve.at(theta + h, order) - curve.at(theta - h, order)) / (2 * h)
        assert slope == pytest.approx(curve.at(theta, order + 1), abs=1e-6)
    for order, values in enumerate(curve.all_orders(theta)):
        assert np.array_equal(values, curve.at(theta, order))


@pytest.mark.parametrize("curve", RAISED)
def test_the_plan_view_is_the_planar_path(curve: Curve) -> None:
    assert curve.dimension == 3 and curve.conic() is None
    plan = SeriesCurve(curve.closed, curve.coefficients[..., :2])
    theta = np.linspace(-4, 4, 30)
    y = FRAME.lift(curve.at(theta))
    assert np.array_equal(FRAME.planar(y), plan.at(theta))
    assert np.array_equal(FRAME.lift(plan.at(theta))[:, 2], np.zeros(30))


@pytest.mark.parametrize("curve", RAISED)
def test_distances_are_those_of_a_search_over_a_fine_grid(curve: Curve) -> None:
    rng, grid = np.random.default_rng(0), np.linspace(-np.pi, np.pi, 40001)
    line = curve.at(grid)
    theta = rng.uniform(-2.5, 2.5, 30)
    y = curve.at(theta) + rng.normal(0, 2e-3, (30, 3))
    gaps = np.array([np.linalg.norm(line - point, axis=1).min() for point in y])
    half = np.linalg.norm(np.diff(line, axis=0), axis=1).max() / 2
    guess = curve.nearest(y)[0] + 1e-3
    near = near_distances(FRAME, [curve, curve], np.stack([y, y]), np.stack([guess, guess]))
    for found in (path_distance(FRAME, curve, y), *near):
        assert (found <= gaps + 1e-12).all()  # what the grid misses: half a step along the curve
        assert (found >= np.sqrt(np.maximum(gaps**2 - 1.2 * half**2, 0)) - 1e-12).all()
    for point in y[:5]:
        found = closest_parameter(FRAME, curve, point)
        best = grid[np.linalg.norm(line - point, axis=1).argmin()]
        assert np.exp(1j * found) == pytest.approx(np.exp(1j * best), abs=2e-4)


def test_the_curvature_of_a_tilted_circle_is_that_of_the_circle() -> None:
    c, s, radius = np.cos(0.7), np.sin(0.7), 0.04
    tilted = fourier(
        np.zeros(3), radius * np.array([[c, 0.0, s]]), radius * np.array([[0.0, 1.0, 0.0]])
    )
    assert tilted.curvature(np.linspace(-3, 3, 9)) == pytest.approx(1 / radius)
    assert tilted.length() == pytest.approx(2 * np.pi * radius)


def test_a_planar_curve_blends_with_a_raised_one() -> None:
    flat, theta = circle(0.05), np.linspace(-3, 3, 20)
    half = blend(flat, saddle(circle(0.06), 0.02), 0.5)
    expected = saddle(circle(0.055), 0.01).at(theta)
    assert half.at(theta) == pytest.approx(expected)
    assert blend(flat, circle(0.06), 0.5).dimension == 2
    assert saddle(flat, 0.0) is flat


def margin(z: Array) -> Array:
    return SPATIAL_ARM.margin(z)


def test_strands_may_cross_in_the_plan_view_where_they_are_far_enough_apart() -> None:
    """The figure of eight, with the height rise sin θ: 2 rise apart where it crosses itself."""
    eight = presets()["figure of eight"].curve
    for gap, near in ((2.1 * TUBE, False), (1.9 * TUBE, True)):
        height = fourier(np.zeros(1), np.zeros((1, 1)), np.array([[gap / 2]]))
        found = ambiguities(in_space(eight, height))
        assert [each.reason.code for each in found] == ["fault.narrow"] * near
    for flat in (eight, in_space(eight)):
        assert "fault.crosses" in [each.reason.code for each in ambiguities(flat)]


def test_a_vertical_tangent_and_heights_out_of_reach_are_refused() -> None:
    upright = fourier(np.zeros(3), np.array([[0.05, 0, 0]]), np.array([[0, 0, 0.05]]))
    assert curve_faults(margin, upright)  # a vertical circle: its tangent is vertical at θ = 0
    assert curve_faults(margin, saddle(circle(0.05), 0.03)) == []
    high = chebyshev_curve(np.array([[0, 0, 0.5], [0.05, 0, 0]]))
    assert any("workspace" in str(fault.reason) for fault in curve_faults(margin, high))


def test_only_frames_that_keep_distances_take_space_curves() -> None:
    assert Plane().space is None and SlantedPlane().space is None
    assert FRAME.space == Space() == Space().space
