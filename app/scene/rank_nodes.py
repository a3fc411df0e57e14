"""The rank test (11) as a coloured map in the path's plane, on demand."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from viser.transforms import SO3

from onpath.app.common import palette
from onpath.app.scene.pointer_projection import plane_coordinates
from onpath.app.scene.stage import Stage
from onpath.models.control.rank_test import RankGrid
from onpath.models.systems.robots import Robot

if TYPE_CHECKING:
    import viser

OPACITY = 0.75
BEHIND_LINKS, BEHIND_PATH = 0.052, 0.008
"""Depth of the map behind the path's plane [m]: the first one if the links move in that plane."""
UPRIGHT = 0.5
"""Least vertical part of a unit vector that counts as upright."""


def map_corners(stage: Stage, robot: Robot) -> tuple[np.ndarray, np.ndarray]:
    """Opposite corners of the mapped rectangle in the path's plane, shape (2,) each, [m].

    It contains what the robot reaches in that plane, as far as its neighbours and the floor leave
    room and the camera looks.
    """
    origin, right, up = _axes(robot)
    base, reach = plane_coordinates(robot, np.zeros(3)), stage.reach[1]
    low, high = base - reach, base + reach
    apart = float(np.ptp(stage.origins @ right)) / 2 / float(right @ right)
    middle = float(((stage.low + stage.high) / 2 - origin) @ right) / float(right @ right)
    if apart > 0:
        low[0], high[0] = max(low[0], middle - apart), min(high[0], middle + apart)
    if up[2] > UPRIGHT:
        low[1] = max(low[1], (stage.floor - origin[2]) / up[2])
        high[1] = min(high[1], (stage.high[2] - origin[2]) / up[2])
    return low, high


def map_picture(values: np.ndarray) -> np.ndarray:
    """The map as an image from top to bottom, transparent where it has no value.

    Args:
        values: see `RankGrid.values`.

    Returns:
        RGBA, shape (rows, columns, 4), uint8.
    """
    alpha = np.where(np.isfinite(values), round(255 * OPACITY), 0).astype(np.uint8)
    colours = palette.on_scale(values / largest(values))
    return np.concatenate([colours, alpha[..., None]], axis=-1)[::-1]


def largest(values: np.ndarray) -> float:
    """The value at the upper end of the colour scale: the largest one, or 1 if there is none."""
    most = float(np.max(np.nan_to_num(values), initial=0.0))
    return most if most > 0 else 1.0


class RankNodes:
    """One image for each robot.

    Args:
        scene: the client's scene.
        stage: where the robots stand.
        robot: what kind of robot they are.
        grid: the map.
    """

    def __init__(self, scene: viser.SceneApi, stage: Stage, robot: Robot, grid: RankGrid) -> None:
        origin, right, up = _axes(robot)
        away = stage.path_plane.normal / np.linalg.norm(stage.path_plane.normal)
        contains_base = abs(float(stage.path_plane.point @ away)) < 1e-9
        first, second = (grid.low + grid.high) / 2
        depth = BEHIND_LINKS if contains_base else BEHIND_PATH
        middle = origin + first * right + second * up + depth * away
        width, height = (grid.high - grid.low) * [np.linalg.norm(right), np.linalg.norm(up)]
        x, y = right / np.linalg.norm(right), -up / np.linalg.norm(up)  # an image's y is downward
        turned = SO3.from_matrix(np.column_stack([x, y, np.cross(x, y)])).wxyz
        self._nodes = [
            scene.add_image(
                f"/show/rank/{bench}",
                map_picture(grid.values),
                float(width),
                float(height),
                format="png",
                cast_shadow=False,
                receive_shadow=False,
                wxyz=turned,
                position=base + middle,
            )
            for bench, base in stage.bases.items()
        ]

    def remove(self) -> None:
        """Remove all nodes."""
        for node in self._nodes:
            node.remove()


def _axes(robot: Robot) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Origin of the path's plane, and its two coordinate directions, in the robot's frame."""
    origin, right, up = robot.place(robot.frame.lift(np.array([(0.0, 0.0), (1, 0), (0, 1)])))
    return origin, right - origin, up - origin
