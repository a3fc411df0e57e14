"""The rank test (11) as an optional coloured map in the path's plane."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from onpath.app.common import palette
from onpath.app.scene.plane_picture import (
    BEHIND_LINKS,
    BEHIND_PATH,
    contains_base,
    map_corners,
)
from onpath.app.scene.stage import PlanePicture, Stage
from onpath.app.viser_adapter.images import png_of
from onpath.models.control.rank_test import IN_REACH, RankGrid, cell_centres, rank_grid
from onpath.models.systems.parameters import Parameters
from onpath.models.systems.robots import Robot

FINER = 4
"""Pixels of the picture per cell of the map, in either direction; it is interpolated in between."""


def map_picture(robot: Robot, grid: RankGrid, opacity: float) -> np.ndarray:
    """The map as an image from top to bottom, transparent where the robot cannot reach.

    It is interpolated between the cells.

    Returns:
        RGBA, shape (FINER rows, FINER columns, 4), uint8.
    """
    rows, columns = grid.values.shape
    z = cell_centres(grid.low, grid.high, (FINER * columns, FINER * rows))
    share = _finer(np.isfinite(grid.values).astype(float))
    inside, rim = share == 1.0, (share > 0.0) & (share < 1.0)
    inside[rim] = robot.margin(z[rim]) > IN_REACH
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
    return BEHIND_LINKS[1] if contains_base(stage) else BEHIND_PATH[1]


def largest(values: np.ndarray) -> float:
    """The value at the upper end of the colour scale: the largest one, or 1 if there is none."""
    most = float(np.max(np.nan_to_num(values), initial=0.0))
    return most if most > 0 else 1.0


@dataclass(frozen=True, slots=True, eq=False)
class RankPicture(PlanePicture):
    """A map that is ready to be shown.

    Attributes:
        grid: its numbers.
    """

    grid: RankGrid


def rank_picture(stage: Stage, robot: Robot, parameters: Parameters) -> RankPicture:
    """The map of a robot with these parameters; takes some tens of milliseconds."""
    low, high = map_corners(stage, robot)
    grid = rank_grid(robot, parameters, low, high)
    png = png_of(map_picture(robot, grid, map_opacity(stage)))
    return RankPicture(low=low, high=high, png=png, grid=grid)
