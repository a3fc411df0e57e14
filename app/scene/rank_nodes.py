"""The rank test (11) as a coloured map in the path's plane, on demand."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from viser.transforms import SO3

from onpath.app.common import palette
from onpath.app.scene.pointer_projection import plane_coordinates
from onpath.app.scene.stage import Stage
from onpath.app.viser_adapter.images import add_png, png_of
from onpath.models.control.rank_test import RankGrid, cell_centres, rank_grid
from onpath.models.systems.parameters import Parameters
from onpath.models.systems.robots import Robot

if TYPE_CHECKING:
    import viser

BEHIND_LINKS, BEHIND_PATH = (0.052, 0.7), (0.008, 0.5)
"""Depth of the map behind the path's plane [m], and its opacity: if the links move in that plane,
and if they do not."""
FINER = 4
"""Pixels of the picture for a cell of the map, in either direction, between which it is smooth."""
GAP = 0.97
"""Share of the width between neighbours that the map takes."""
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
    apart = GAP * float(np.ptp(stage.origins @ right)) / 2 / float(right @ right)
    middle = float(((stage.low + stage.high) / 2 - origin) @ right) / float(right @ right)
    if apart > 0:
        low[0], high[0] = max(low[0], middle - apart), min(high[0], middle + apart)
    if up[2] > UPRIGHT:
        low[1] = max(low[1], (stage.floor - origin[2]) / up[2])
        high[1] = min(high[1], (stage.high[2] - origin[2]) / up[2])
    return low, high


def map_picture(robot: Robot, grid: RankGrid, opacity: float) -> np.ndarray:
    """The map as an image from top to bottom, transparent where the robot cannot reach.

    It is interpolated between the cells. Its values fall to 0 at both limits of the reach.

    Returns:
        RGBA, shape (FINER rows, FINER columns, 4), uint8.
    """
    rows, columns = grid.values.shape
    z = cell_centres(grid.low, grid.high, (FINER * columns, FINER * rows))
    far = np.linalg.norm(robot.place(robot.frame.lift(z)), axis=-1)
    pixel = (grid.high - grid.low).max() / (FINER * columns)
    inner, outer = robot.reach
    inside = np.clip(np.minimum(far - inner, outer - far) / pixel + 0.5, 0.0, 1.0)
    inside[_finer(np.isfinite(grid.values).astype(float)) == 0] = 0.0  # also for other reasons
    colours = palette.on_scale(_finer(np.nan_to_num(grid.values)) / largest(grid.values))
    alpha = np.round(255 * opacity * inside).astype(np.uint8)
    return np.concatenate([colours, alpha[..., None]], axis=-1)[::-1]


def _finer(values: np.ndarray) -> np.ndarray:
    """Bilinear interpolation between the centres of cells, at `FINER` times as many points."""
    for _ in range(2):
        count = len(values)
        at = (np.arange(FINER * count) + 0.5) / FINER - 0.5
        low = np.clip(np.floor(at).astype(int), 0, max(count - 2, 0))
        high = np.minimum(low + 1, count - 1)
        share = np.clip(at - low, 0.0, 1.0)[:, None]
        values = ((1 - share) * values[low] + share * values[high]).T
    return values


def map_opacity(stage: Stage) -> float:
    """Lower where the map is in front of the links, which do not move in the path's plane."""
    return BEHIND_LINKS[1] if _contains_base(stage) else BEHIND_PATH[1]


def _contains_base(stage: Stage) -> bool:
    return abs(float(stage.path_plane.point @ stage.away)) < 1e-9


def largest(values: np.ndarray) -> float:
    """The value at the upper end of the colour scale: the largest one, or 1 if there is none."""
    most = float(np.max(np.nan_to_num(values), initial=0.0))
    return most if most > 0 else 1.0


@dataclass(frozen=True, slots=True, eq=False)
class RankPicture:
    """A map that is ready to be shown.

    Attributes:
        grid: its numbers.
        png: the picture.
    """

    grid: RankGrid
    png: bytes


def rank_picture(stage: Stage, robot: Robot, parameters: Parameters) -> RankPicture:
    """The map of a robot with these parameters; takes some tens of milliseconds."""
    grid = rank_grid(robot, parameters, *map_corners(stage, robot))
    return RankPicture(grid, png_of(map_picture(robot, grid, map_opacity(stage))))


class RankNodes:
    """One image for each robot.

    Args:
        scene: the client's scene.
        stage: where the robots stand.
        robot: what kind of robot they are.
        picture: the map.
    """

    def __init__(
        self, scene: viser.SceneApi, stage: Stage, robot: Robot, picture: RankPicture
    ) -> None:
        origin, right, up = _axes(robot)
        low, high = picture.grid.low, picture.grid.high
        depth, _ = BEHIND_LINKS if _contains_base(stage) else BEHIND_PATH
        first, second = (low + high) / 2
        middle = origin + first * right + second * up + depth * stage.away
        width, height = (high - low) * [np.linalg.norm(right), np.linalg.norm(up)]
        x, y = right / np.linalg.norm(right), -up / np.linalg.norm(up)  # an image's y is downward
        turned = SO3.from_matrix(np.column_stack([x, y, np.cross(x, y)])).wxyz
        size = float(width), float(height)
        self._nodes = [
            add_png(scene, f"/show/rank/{bench}", picture.png, size, base + middle, turned)
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
