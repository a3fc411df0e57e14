"""The projection of the compiled loop against brute force, over thousands of curves and points."""

from __future__ import annotations

from collections.abc import Callable

import casadi as ca
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from onpath.models.arrays import Array
from onpath.models.paths.curves import TABLE_SHAPE, Curve, chebyshev_curve, circle, segment
from onpath.models.paths.projection import LARGEST_STEP, LocalCurve, basis, wrap

CURVES, POINTS = 150, 25


def projector(closed: bool, passes: int) -> ca.Function:
    """(theta_0, z, table) -> (theta, sigma and derivatives as columns), `passes` ticks of it."""
    theta, z, table = ca.SX.sym("theta"), ca.SX.sym("z", 2), ca.SX.sym("table", *TABLE_SHAPE)
    guess, local = theta, None
    for _ in range(passes):
        values = table @ basis(guess, closed)
        local = LocalCurve.from_values(guess, closed, values).project(z)
        guess = local.theta
    assert local is not None
    columns = ca.horzcat(local.sigma, local.first, local.second, local.third)
    return ca.Function("projector", [theta, z, table], [local.theta, columns])


def evaluate(function: ca.Function, curve: Curve, theta: Array, z: Array) -> tuple[Array, Array]:
    """theta, (n,), and sigma with derivatives, (n, 4, 2)."""
    table = curve.table().reshape(TABLE_SHAPE, order="F")
    found, columns = function.map(len(theta))(theta, z.T, np.tile(table, len(theta)))
    return found.full().ravel(), columns.full().T.reshape(len(theta), 4, 2)


def tube(curve: Curve, rng: np.random.Generator, part: float = 0.8) -> tuple[Array, Array]:
    """Points within `part` of the tube where the closest point is unique, and their thetas."""
    grid = curve.sample(512)
    samples, first = curve.at(grid), curve.at(grid, 1)
    bend = np.abs(curve.curvature(grid)).max()
    apart = np.linalg.norm(samples[:, None] - samples[None], axis=-1)
    gap = np.abs(wrapped(grid[:, None] - grid[None])) > 1.0
    radius = min(1 / bend, apart[gap].min() / 2)
    chosen = rng.integers(0, len(grid), POINTS)
    normal = np.column_stack([-first[:, 1], first[:, 0]])
    normal /= np.linalg.norm(first, axis=1)[:, None]
    offset = rng.uniform(-part * radius, part * radius, POINTS)
    return samples[chosen] + offset[:, None] * normal[chosen], grid[chosen]


def wrapped(angle: Array) -> Array:
    return angle - 2 * np.pi * np.round(angle / (2 * np.pi))


@pytest.fixture(scope="module")
def once() -> ca.Function:
    return projector(closed=True, passes=1)


@pytest.mark.thorough
def test_closest_point_of_thousands_is_that_of_brute_force(
    random_curve: Callable[[int], Curve], once: ca.Function
) -> None:
    rng = np.random.default_rng(0)
    for seed in range(CURVES):
        curve = random_curve(seed)
        z, theta = tube(curve, rng)
        start = theta + rng.uniform(-5e-3, 5e-3, POINTS)  # more than a tick leaves at 1 kHz
        found, columns = evaluate(once, curve, start, z)
        best, distance = curve.nearest(z)
        assert np.abs(wrapped(found - best)).max() < 1e-6
        assert np.linalg.norm(z - columns[:, 0], axis=1) == pytest.approx(distance, abs=1e-10)


def test_result_is_the_curve_there(random_curve: Callable[[int], Curve], once: ca.Function) -> None:
    rng = np.random.default_rng(1)
    for seed in range(20):
        curve = random_curve(seed)
        z, theta = tube(curve, rng)
        found, columns = evaluate(once, curve, theta + 1e-4, z)
        for order, precision in enumerate((1e-13, 1e-11, 1e-7, 1e-3)):
            exact = curve.at(found, order)
            assert np.abs(columns[:, order] - exact).max() < precision


@pytest.mark.thorough
def test_a_few_ticks_recover_from_a_bad_start(random_curve: Callable[[int], Curve]) -> None:
    rng, often = np.random.default_rng(2), projector(closed=True, passes=8)
    for seed in range(40):
        curve = random_curve(seed)
        z, theta = tube(curve, rng, part=0.3)
        found, _ = evaluate(often, curve, theta + rng.uniform(-0.3, 0.3, POINTS), z)
        assert np.abs(wrapped(found - curve.nearest(z)[0])).max() < 1e-6


def test_step_is_bounded_and_finite_even_at_the_centre_of_curvature(once: ca.Function) -> None:
    rng = np.random.default_rng(3)
    curve = circle(0.05)
    theta = rng.uniform(-np.pi, np.pi, 200)
    z = 0.2 * rng.normal(size=(200, 2))
    z[:50] = 0.0
    found, columns = evaluate(once, curve, theta, z)
    assert np.all(np.isfinite(found)) and np.all(np.isfinite(columns))
    assert np.abs(found - theta).max() <= 2 * LARGEST_STEP + 1e-12


def test_open_curve_is_projected_inside_and_beyond_its_ends() -> None:
    rng, function = np.random.default_rng(4), projector(closed=False, passes=3)
    for _ in range(40):
        bent = np.array([[0.0, 0.0], [0.08, 0.0], *(0.01 * rng.normal(size=(3, 2)))])
        curve = chebyshev_curve(bent)
        theta = rng.uniform(-4.5, 4.5, POINTS)
        first = curve.at(theta, 1)
        normal = np.column_stack([-first[:, 1], first[:, 0]])
        z = curve.at(theta) + 0.05 * rng.uniform(-1, 1, (POINTS, 1)) * normal
        found, columns = evaluate(function, curve, theta + rng.uniform(-0.02, 0.02, POINTS), z)
        assert found == pytest.approx(theta, abs=1e-6)
        assert columns[:, 0] == pytest.approx(curve.at(theta), abs=1e-8)


@given(st.floats(-30, 30))
def test_beyond_the_end_of_a_segment_theta_is_its_coordinate(theta: float) -> None:
    line = segment((-0.05, 0.0), (0.05, 0.0))
    z = np.array([[0.05 * theta / np.pi, 0.02]])
    start = np.array([theta + 0.2])
    found, columns = evaluate(projector(closed=False, passes=1), line, start, z)
    assert found[0] == pytest.approx(theta, abs=1e-9)
    assert columns[0, 1] == pytest.approx([0.05 / np.pi, 0.0], abs=1e-15)


@given(st.floats(-1e3, 1e3))
def test_wrap_keeps_the_angle_and_the_range(angle: float) -> None:
    x = ca.SX.sym("x")
    closed, opened = ca.Function("w", [x], [wrap(x, True), wrap(x, False)])(angle)
    assert -np.pi <= float(closed) <= np.pi
    assert np.exp(1j * float(closed)) == pytest.approx(np.exp(1j * angle), abs=1e-9)
    assert float(opened) == angle
