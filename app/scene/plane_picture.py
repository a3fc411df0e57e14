"""A picture in the plane of the path behind each robot."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from viser.transforms import SO3

from onpath.app.common import palette
from onpath.app.scene.stage import PlanePicture, Stage
from onpath.app.viser_adapter.images import add_png, png_of
from onpath.models.control.rank_test import cell_centres
from onpath.models.paths.path_checks import LEAST_MARGIN
from onpath.models.systems.robots import Robot

if TYPE_CHECKING:
    import viser

BEHIND_LINKS, BEHIND_PATH = (0.052, 0.7), (0.008, 0.5)
"""Depth of a map behind the path's plane [m], and its opacity: where the links move in that plane,
and where they do not."""
GAP = 0.97
"""Width of a picture relative to the distance between neighbours."""
UPRIGHT = 0.5
"""Least vertical part of a unit vector that counts as upright."""
ZONE_PIXELS, ZONE_WIDTH, ZONE_OPACITY = 160, 0.02, 0.2
"""Of the shading near singular configurations: pixels in either direction, width [m], opacity."""


class PlaneNodes:
    """One image for each robot.

    Args:
        scene: the client's scene.
        name: of the nodes' folder.
        stage: where the robots stand.
        picture: the image and its corners.
    """

    def __init__(
        self, scene: viser.SceneApi, name: str, stage: Stage, picture: PlanePicture
    ) -> None:
        origin, right, up = stage.axes
        depth, _ = BEHIND_LINKS if contains_base(stage) else BEHIND_PATH
        first, second = (picture.low + picture.high) / 2
        middle = origin + first * right + second * up + depth * stage.away
        extent = picture.high - picture.low
        width, height = extent * [np.linalg.norm(right), np.linalg.norm(up)]
        x, y = right / np.linalg.norm(right), -up / np.linalg.norm(up)  # an image's y is downward
        turned = SO3.from_matrix(np.column_stack([x, y, np.cross(x, y)])).wxyz
        size = float(width), float(height)
        self._nodes = [
            add_png(scene, f"{name}/{side}", picture.png, size, base + middle, turned)
            for side, base in stage.bases.items()
        ]

    def remove(self) -> None:
        """Remove all nodes."""
        for node in self._nodes:
            node.remove()


def map_corners(stage: Stage, robot: Robot) -> tuple[np.ndarray, np.ndarray]:
    """Opposite corners of the mapped rectangle in the path's plane, shape (2,) each, [m].

    It contains the points that the robot reaches in that plane, within the room that its neighbours
    and the floor leave and within the camera's view.
    """
    origin, right, up = stage.axes
    base = robot.frame.planar(robot.output_at(np.zeros(3)))
    low, high = base - robot.reach, base + robot.reach
    apart = GAP * float(np.ptp(stage.origins @ right)) / 2 / float(right @ right)
    middle = float(((stage.low + stage.high) / 2 - origin) @ right) / float(right @ right)
    if apart > 0:
        low[0], high[0] = max(low[0], middle - apart), min(high[0], middle + apart)
    if up[2] > UPRIGHT:
        low[1] = max(low[1], (stage.floor - origin[2]) / up[2])
        high[1] = min(high[1], (stage.high[2] - origin[2]) / up[2])
    return low, high


def zone_picture(stage: Stage, robot: Robot) -> PlanePicture:
    """Shading of the points in reach near configurations too close to singular for a path."""
    low, high = map_corners(stage, robot)
    margin = robot.margin(cell_centres(low, high, (ZONE_PIXELS, ZONE_PIXELS)))
    near = margin < LEAST_MARGIN
    for axis in (1, 0):
        pixel = float(high[1 - axis] - low[1 - axis]) / ZONE_PIXELS
        near = _widened(near, round(ZONE_WIDTH / pixel), axis)
    shaded = (margin > 0) & near
    picture = np.zeros((ZONE_PIXELS, ZONE_PIXELS, 4), dtype=np.uint8)
    picture[..., :3] = palette.WARNING.rgb
    picture[..., 3] = np.round(255 * ZONE_OPACITY * shaded)
    return PlanePicture(low, high, png_of(picture[::-1]))


def _widened(marked: np.ndarray, by: int, axis: int) -> np.ndarray:
    """The marks, extended by a number of cells along an axis in both directions."""
    padded = np.pad(marked, [(by, by) if i == axis else (0, 0) for i in range(2)], mode="edge")
    windows = np.lib.stride_tricks.sliding_window_view(padded, 2 * by + 1, axis)
    return np.asarray(windows.any(axis=-1))


def contains_base(stage: Stage) -> bool:
    """Whether the links move in the path's plane."""
    return abs(float(stage.path_plane.point @ stage.away)) < 1e-9
