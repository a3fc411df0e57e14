"""What is drawn over the picture lies where the camera shows it."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from viser.transforms import SO3

from onpath.app.scene.projection import projections, seen_from
from onpath.app.scene.stage import FIELD_OF_VIEW, view_of
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


@settings(max_examples=20, deadline=None)
@given(
    name=st.sampled_from(list(ROBOTS)),
    size=st.tuples(st.integers(300, 2600), st.integers(250, 1500)),
)
def test_titles_and_bars_are_known_before_the_picture_is(name, size):
    """Before its camera is in place, a picture is told to show what it then shows."""
    robot = ROBOTS[name].make(ROBOTS[name].parameters())
    stage = stage_of(robot)
    pose = view_of(stage, size)
    seen = seen_from(pose, stage, robot)
    forward = (pose.look_at - pose.position) / np.linalg.norm(pose.look_at - pose.position)
    scale = 1 / (2 * np.tan(FIELD_OF_VIEW / 2))
    right = np.cross(forward, [0.0, 0.0, 1.0])
    right /= np.linalg.norm(right)
    for base, camera in zip(stage.origins, seen.cameras, strict=True):
        across, down, depth = camera @ [*seen.above, 1.0]
        way = base + robot.position(seen.above) - pose.position
        assert np.isclose(across / depth, scale * (way @ right) / (way @ forward), atol=1e-9)
        up = scale * (way @ np.cross(right, forward)) / (way @ forward)
        assert np.isclose(down / depth, -up, atol=1e-9)
        assert abs(across / depth) < 0.5 * size[0] / size[1]  # over the picture
    assert not seen.drawn
