"""The distance to the path: the quick way is the thorough one, whatever the guess."""

from __future__ import annotations

import numpy as np
import pytest

from onpath.models.paths.curves import circle
from onpath.models.paths.distance import (
    closest_parameter,
    closest_parameters,
    near_distance,
    near_distances,
    path_distance,
)
from onpath.models.paths.frames import Plane, SlantedPlane
from onpath.models.paths.path_design import presets

DESIGNS = list(presets().values())


@pytest.mark.parametrize("frame", [Plane(), SlantedPlane()], ids=["plane", "slanted"])
@pytest.mark.parametrize("design", DESIGNS, ids=lambda design: design.name)
def test_a_good_guess_finds_the_closest_point(design, frame):
    rng = np.random.default_rng(1)
    theta = rng.uniform(-1.0, 1.0, 40)
    y = frame.lift(design.curve.at(theta)) + rng.normal(
        0.0, 1e-3, (40, frame.lift(np.zeros(2)).size)
    )
    near = near_distance(frame, design.curve, y, theta + 0.005)
    thorough = path_distance(frame, design.curve, y)
    np.testing.assert_allclose(near, thorough, atol=1e-6)  # a micrometre, on the screen


@pytest.mark.parametrize("design", DESIGNS, ids=lambda design: design.name)
def test_a_wild_guess_never_gives_a_wrong_distance(design):
    rng = np.random.default_rng(2)
    frame, theta = Plane(), rng.uniform(-np.pi, np.pi, 300)
    y = rng.uniform(-0.12, 0.12, (300, 2))
    near, far = near_distance(frame, design.curve, y, theta), path_distance(frame, design.curve, y)
    guessed = np.linalg.norm(design.curve.at(theta) - y, axis=1)
    assert np.all(near >= far - 1e-5) and np.all(near <= guessed + 1e-5)


def test_on_a_circle_it_is_that_of_the_radius_also_near_the_centre():
    rng = np.random.default_rng(3)
    y = rng.normal(size=(4000, 2))
    y *= (np.geomspace(1e-6, 0.15, 4000) / np.linalg.norm(y, axis=1))[:, None]
    for found in (path_distance(Plane(), circle(0.05), y), circle(0.05).nearest(y)[1]):
        assert np.abs(found - np.abs(np.linalg.norm(y, axis=1) - 0.05)).max() < 1e-10


@pytest.mark.parametrize("count", [1, 7, 2100])
@pytest.mark.parametrize("seed", range(4))
def test_all_points_at_once_are_as_far_as_one_by_one_by_another_search(random_curve, seed, count):
    """The other search halves intervals instead of following tangents."""
    rng, curve = np.random.default_rng(seed), random_curve(seed)
    beside = curve.at(rng.uniform(-np.pi, np.pi, count)) + rng.normal(0, 0.01, (count, 2))
    y = np.where(rng.random((count, 1)) < 0.5, beside, rng.uniform(-0.12, 0.12, (count, 2)))
    found, some = path_distance(Plane(), curve, y), rng.choice(count, min(count, 40))
    alone = np.array([curve.nearest(y[i : i + 1])[1][0] for i in some])
    np.testing.assert_allclose(found[some], alone, atol=1e-12)


@pytest.mark.thorough
@pytest.mark.parametrize("seed", range(8))
def test_no_point_of_the_curve_is_nearer_even_where_two_valleys_are_equally_deep(
    random_curve, seed
):
    curve, y = random_curve(seed), np.random.default_rng(seed).uniform(-0.12, 0.12, (2000, 2))
    everywhere = curve.at(curve.sample(6000))
    nearest = np.full(len(y), np.inf)
    for part in np.array_split(everywhere, 60):
        nearest = np.minimum(nearest, ((y[:, None, :] - part) ** 2).sum(-1).min(axis=1))
    for found in (path_distance(Plane(), curve, y, 64), curve.nearest(y, 64)[1]):
        assert np.all(found <= np.sqrt(nearest) + 1e-12)


@pytest.mark.parametrize("frame", [Plane(), SlantedPlane()], ids=["plane", "slanted"])
@pytest.mark.parametrize("closed", [True, False])
@pytest.mark.parametrize("n", [1, 2, 5])
def test_several_curves_at_once_are_as_one_by_one(frame, closed, n):
    curves = [design.curve for design in presets().values() if design.curve.closed == closed] * 9
    rng = np.random.default_rng(4)
    theta = rng.uniform(-3.5, 3.5, (len(curves), n))
    points = [frame.lift(curve.at(own)) for curve, own in zip(curves, theta, strict=True)]
    y = np.stack(points) + rng.normal(0.0, 0.01, (len(curves), n, frame.p))
    together = near_distances(frame, curves, y, theta)
    for i, curve in enumerate(curves):
        assert np.array_equal(together[i], near_distance(frame, curve, y[i], theta[i]))


@pytest.mark.parametrize("frame", [Plane(), SlantedPlane()], ids=["plane", "slanted"])
@pytest.mark.parametrize("design", presets().values(), ids=lambda design: design.name)
def test_closest_points_of_several_robots_are_as_one_by_one(design, frame):
    rng = np.random.default_rng(5)
    curve, y = design.curve, frame.lift(rng.uniform(-0.12, 0.12, (60, 2)))
    together = closest_parameters(frame, curve, y)
    alone = np.array([closest_parameter(frame, curve, each) for each in y])
    if not curve.closed:
        alone = alone.clip(-np.pi, np.pi)
    z = frame.planar(y)
    found, best = (np.linalg.norm(curve.at(theta) - z, axis=1) for theta in (together, alone))
    np.testing.assert_allclose(found, best, atol=1e-9)
