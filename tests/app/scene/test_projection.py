"""What is drawn over the picture lies where the camera shows it."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from viser.transforms import SO3

from onpath.app.scene.projection import projections
from onpath.app.scene.stage_catalogue import stage_of
from onpath.models.systems.catalogue import ROBOTS


@settings(max_examples=3)
@given(name=st.sampled_from(list(ROBOTS)))
def test_a_point_is_projected_along_the_ray_through_it(name):
    robot = ROBOTS[name].make(ROBOTS[name].parameters())
    origins = stage_of(robot).origins
    random = np.random.default_rng(41)
    for _ in range(20):
        position, fov = random.uniform(-3, 3, 3), random.uniform(0.3, 1.5)
        turn = SO3(np.array((q := random.normal(size=4)) / np.linalg.norm(q)))
        matrices = projections(position, turn.wxyz, fov, origins, robot)
        for origin, matrix in zip(origins, matrices, strict=True):
            y = random.uniform(-0.5, 0.5, robot.system.p)
            across, down, depth = matrix @ [*y, 1.0]
            half = np.tan(fov / 2)  # of the picture's height, at distance 1
            seen = np.array([2 * half * across, 2 * half * down, depth])
            np.testing.assert_allclose(
                position + turn.as_matrix() @ seen, origin + robot.position(y), atol=1e-12
            )
