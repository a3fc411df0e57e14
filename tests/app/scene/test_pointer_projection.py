"""Laws of the pointer's geometry."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from onpath.app.scene.pointer_projection import (
    Box,
    DragPlane,
    plane_coordinates,
    pointer_on_plane,
)
from onpath.app.scene.stage_catalogue import stage_of
from onpath.models.systems.catalogue import ROBOTS

vectors = arrays(np.float64, 3, elements=st.floats(-10.0, 10.0))
NOT_FINITE = st.sampled_from([np.nan, np.inf, -np.inf])
EVERYWHERE = Box(np.full(3, -1e9), np.full(3, 1e9))


def seen(camera, pointer, point, normal):
    """Where the ray from a camera through a pointer meets a plane."""
    return pointer_on_plane(camera, pointer, np.zeros(3), DragPlane(point, normal), EVERYWHERE)


def steep(direction: np.ndarray, normal: np.ndarray) -> float:
    """Cosine of the angle between two vectors, 0 when either is nothing."""
    lengths = np.linalg.norm(direction) * np.linalg.norm(normal)
    return float(direction @ normal / lengths) if lengths > 1e-6 else 0.0


@given(vectors, vectors, vectors, vectors)
@example(  # a plane through the ray's origin: the sign of `ahead` is rounding
    np.array([1.5, 3.75, 0.0]), -np.ones(3), np.array([3.75, 1.5, 0.0]), 2.058 * np.ones(3)
)
def test_hit_lies_on_plane_and_on_ray(origin, direction, point, normal):
    pointer = origin + direction
    direction = pointer - origin  # rounded, as it is seen
    assume(abs(steep(direction, normal)) > 0.05)
    hit = seen(origin, pointer, point, normal)
    ahead = float((point - origin) @ normal) / float(direction @ normal)
    scale = np.abs(point - origin) @ np.abs(normal) / abs(direction @ normal)
    undecided = abs(ahead) <= 1e-14 * scale  # a few roundings: behind or at the origin
    if ahead < 0.0 and not undecided:
        assert hit is None
        return
    if hit is None:
        assert undecided
        return
    assert abs((hit - point) @ normal) < 1e-9 * np.linalg.norm(normal) * (1.0 + ahead)
    np.testing.assert_allclose(hit, origin + ahead * direction, atol=1e-9)


@given(vectors, vectors, vectors, vectors)
def test_ray_along_the_plane_never_hits(origin, direction, point, normal):
    assume(np.linalg.norm(normal) > 1e-3)
    along = direction - (direction @ normal) / (normal @ normal) * normal
    assume(np.linalg.norm(along) > 1e-6)  # else only rounding is left of it
    assert seen(origin, origin + along, point, normal) is None


@given(vectors, vectors, vectors, vectors, st.integers(0, 11), NOT_FINITE)
def test_what_is_not_finite_never_hits(origin, direction, point, normal, place, value):
    numbers = np.concatenate([origin, direction, point, normal])
    numbers[place] = value
    with np.errstate(invalid="ignore"):
        origin, direction, point, normal = numbers.reshape(4, 3)
        assert seen(origin, origin + direction, point, normal) is None


@given(vectors, vectors, vectors)
def test_clamped_point_is_the_nearest_of_the_box(point, corner, other):
    box = Box(np.minimum(corner, other), np.maximum(corner, other))
    clamped = box.clamp(point)
    assert ((clamped >= box.lower) & (clamped <= box.upper)).all()
    for candidate in (box.lower, box.upper, (box.lower + box.upper) / 2):
        nearer = np.linalg.norm(point - candidate) - np.linalg.norm(point - clamped)
        assert nearer >= -1e-12


@given(st.floats(-0.5, 0.5), st.floats(-0.5, 0.5), st.floats(0.1, 0.9), vectors)
def test_pointer_anywhere_on_the_ray_means_the_same_point(x, z, share, base):
    camera = base + [0.3, -3.0, 0.4]
    target = np.array([x, 0.0, z])
    pointer = camera + share * (base + target - camera)
    box = Box(np.full(3, -0.6), np.full(3, 0.6))
    vertical = DragPlane(np.zeros(3), np.array([0.0, 1.0, 0.0]))
    found = pointer_on_plane(camera, pointer, base, vertical, box)
    assert found is not None
    np.testing.assert_allclose(found, target, atol=1e-9)


@settings(max_examples=3)
@given(name=st.sampled_from(list(ROBOTS)))
@pytest.mark.parametrize("place", [(50.0, 0.0, 80.0), (-70.0, 0.0, 60.0), (40.0, 0.0, -90.0)])
def test_far_pointer_stays_within_the_robot_s_reach(name, place):
    robot = ROBOTS[name].make(ROBOTS[name].parameters())
    stage, home = stage_of(robot), robot.position(robot.frame.lift(np.zeros(2)))
    plane = DragPlane(home, np.array([0.0, 1.0, 0.0]))
    camera = home + [0.0, -1.0, 0.0]
    far = pointer_on_plane(camera, home + place, np.zeros(3), plane, stage.reachable)
    assert far is not None
    np.testing.assert_allclose(far - home, robot.reach * np.sign(place), atol=1e-12)


@given(
    name=st.sampled_from(list(ROBOTS)), z=arrays(np.float64, (5, 2), elements=st.floats(-0.6, 0.6))
)
def test_coordinates_of_the_path_s_plane_are_those_a_point_was_drawn_from(name, z):
    robot = ROBOTS[name].make(ROBOTS[name].parameters())
    np.testing.assert_allclose(
        plane_coordinates(robot, robot.position(robot.frame.lift(z))), z, atol=1e-15
    )
