"""The painted shadow is that of what stands on the ground, on the side away from the light."""

from __future__ import annotations

from typing import Any, cast

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.app.scene.ground import DARKEST, KEY_LIGHT, PIXELS, RADIUS, painted_shadow, shadow
from onpath.app.scene.meshes import Mesh
from onpath.app.scene.stage import _put
from onpath.app.scene.stage_catalogue import stage_of
from onpath.models.systems.catalogue import ROBOTS

PITCH = 2 * RADIUS / PIXELS
FLOOR = -0.1


def box(low: tuple[float, float, float], high: tuple[float, float, float]) -> Mesh:
    made = trimesh.creation.box(bounds=[low, high])
    return Mesh(np.asarray(made.vertices), np.asarray(made.faces))


def middle(dark: np.ndarray) -> np.ndarray:
    """Middle of a shadow in the world's x and y, shape (2,), [m]."""
    rows, columns = np.indices(dark.shape)
    x, y = (columns + 0.5) * PITCH - RADIUS, RADIUS - (rows + 0.5) * PITCH
    return np.array([np.sum(x * dark), np.sum(y * dark)]) / dark.sum()


@pytest.mark.parametrize("height", [0.0, 0.1, 0.3])
@pytest.mark.parametrize("place", [(0.0, 0.0), (0.2, -0.3)])
def test_a_shadow_lies_where_the_light_throws_it(height: float, place: tuple[float, float]) -> None:
    (x, y), flat = place, 0.0005
    low, high = FLOOR + height, FLOOR + height + flat
    solid = box((x - 0.05, y - 0.05, low), (x + 0.05, y + 0.05, high))
    dark = shadow([solid], np.zeros((1, 3)), FLOOR)
    wanted = np.array(place) - height / KEY_LIGHT[2] * np.array(KEY_LIGHT[:2])
    np.testing.assert_allclose(middle(dark), wanted, atol=PITCH)
    assert dark.sum() * PITCH**2 == pytest.approx(0.01, rel=0.25)


def test_nothing_on_the_ground_leaves_it_light() -> None:
    far = box((5.0, 5.0, 0.0), (5.1, 5.1, 0.1))
    assert np.abs(shadow([far], np.zeros((1, 3)), FLOOR)).max() < 1e-9
    assert pixels(painted_shadow((far,), ((0.0, 0.0, 0.0),), FLOOR)[0])[..., 3].max() == 0


def pixels(png: bytes) -> np.ndarray:
    """An 8-bit RGBA picture whose rows are decoded here, shape (rows, columns, 4)."""
    image = pytest.importorskip("imageio.v3")
    return np.asarray(image.imread(png))


@settings(max_examples=3)
@given(name=st.sampled_from(list(ROBOTS)))
def test_the_painted_shadow_is_the_whole_shadow_about_the_same_middle(name: str) -> None:
    stage = stage_of(ROBOTS[name].make(ROBOTS[name].parameters()))
    solids = tuple(mesh for _, mesh, _ in stage.parts())
    origins = tuple(map(tuple, stage.origins.tolist()))
    painted = painted_shadow(solids, origins, stage.floor)
    assert painted is painted_shadow(solids, origins, stage.floor)  # painted once
    png, size = painted
    picture = pixels(png)
    rows, columns = picture.shape[:2]
    assert size == pytest.approx((columns * PITCH, rows * PITCH))
    assert picture[..., :3].max() == 0 and len(png) < 30_000
    top, left = (PIXELS - rows) // 2, (PIXELS - columns) // 2
    whole = np.zeros((PIXELS, PIXELS))
    whole[top : top + rows, left : left + columns] = picture[..., 3] / 255.0
    share = DARKEST * shadow(solids, stage.origins, stage.floor)
    np.testing.assert_allclose(whole, share, atol=0.5 / 255.0 + 1e-9)
    assert 0.8 * DARKEST < whole.max() <= DARKEST + 0.01
    assert rows * columns < 0.4 * PIXELS**2  # the rest need not be drawn


def test_the_ground_goes_under_a_robot_that_stands_at_height_0() -> None:
    """Also after another robot: a position of 0 must be sent."""
    sent = list[tuple[float, ...]]()

    class Node:
        def __setattr__(self, name: str, value: np.ndarray) -> None:
            assert name == "position"
            sent.append(tuple(value))

    robot = ROBOTS["seven_axes"]
    stage = stage_of(robot.make(robot.parameters()))
    _put(cast("Any", Node()), stage)
    assert stage.floor == 0 and len(set(sent)) == 2
    assert sent[-1] == pytest.approx((*stage.origins.mean(0)[:2], 0.0))
