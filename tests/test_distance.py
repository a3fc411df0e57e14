"""The distance to the path: the quick way is the thorough one, whatever the guess."""

from __future__ import annotations

import numpy as np
import pytest

from models.distance import near_distance, path_distance
from models.frames import Plane, SlantedPlane
from models.path_design import presets

DESIGNS = [design for name, design in presets().items() if name != "figure of eight"]


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
def test_a_wild_guess_never_tells_of_a_distance_that_is_none(design):
    rng = np.random.default_rng(2)
    frame, theta = Plane(), rng.uniform(-np.pi, np.pi, 300)
    y = rng.uniform(-0.12, 0.12, (300, 2))
    near, far = near_distance(frame, design.curve, y, theta), path_distance(frame, design.curve, y)
    guessed = np.linalg.norm(design.curve.at(theta) - y, axis=1)
    assert np.all(near >= far - 1e-5) and np.all(near <= guessed + 1e-5)
