"""The rank test (11) over the whole workspace, drawn with Matplotlib."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from onpath.app.exports.figures import ShownFigure, save, without_math
from onpath.models.arrays import Array
from onpath.models.control.rank_test import cell_centres, rank_grid, section_map
from onpath.models.paths.curves import circle
from onpath.models.systems.parameters import Parameters
from onpath.models.systems.robots import Robot, RobotEntry

CELLS = 160
RADIUS = 0.05  # [m], of the circle that is drawn
UNIT = "(m/s²)/(N m)"


def draw_rank_figure(entry: RobotEntry, parameters: Parameters, path: Path) -> None:
    """Write `rank_figure` to a file."""
    save(rank_figure(entry, parameters), path)


def rank_figure(entry: RobotEntry, parameters: Parameters) -> Figure:
    """σ_min in the plane of the path and, for three outputs, in the vertical section y2 = 0."""
    robot = entry.make(parameters)
    in_space = robot.system.p == 3
    figure = ShownFigure(figsize=(10.5 if in_space else 7, 5), layout="constrained")
    ratios = {"width_ratios": (2, 1.2)} if in_space else {}
    axes = figure.subplots(1, 1 + in_space, squeeze=False, gridspec_kw=ratios)[0].tolist()
    alpha = getattr(parameters, "alpha", None)
    condition = "" if alpha is None else f", α = {alpha:g}, link straight"
    figure.suptitle(f"Rank test (11): {without_math(entry.label)}{condition}")
    low, high = _extent(robot)
    grid = rank_grid(robot, parameters, low, high, CELLS)
    first, second = robot.frame.axes
    _draw(axes[0], grid.centres, grid.values, (f"$y_{first}$", f"$y_{second}$"))
    ring = circle(RADIUS).at(np.linspace(-np.pi, np.pi, 200))
    axes[0].plot(*(1e3 * ring.T), color="white", linewidth=2)
    axes[0].set_title("plane of the path; white: circle of 50 mm")
    if in_space:
        centres, values = _section(robot, parameters)
        _draw(axes[1], centres, values, ("$y_1$", "$y_3$"))
        axes[1].set_title("vertical section $y_2$ = 0")
    return figure


def rank_summary(entry: RobotEntry, parameters: Parameters) -> dict[str, Any]:
    """Numbers of the map: its unit, the value at home, and the largest in the plane of the path."""
    robot = entry.make(parameters)
    values = rank_grid(robot, parameters, *_extent(robot)).values
    home = rank_grid(robot, parameters, np.full(2, -1e-6), np.full(2, 1e-6), 1).values
    return {
        "figure": "rank",
        "robot": entry.name,
        "unit": UNIT,
        "home": round(float(home[0, 0]), 4),
        "largest": round(float(np.nanmax(values)), 4),
    }


def _extent(robot: Robot) -> tuple[Array, Array]:
    """Corners of the square in the path's plane that contains the workspace."""
    base = robot.frame.planar(robot.output_at(np.zeros(3)))
    return base - robot.reach, base + robot.reach


def _section(robot: Robot, parameters: Parameters) -> tuple[Array, Array]:
    """Coordinates (y1, y3) in the plane y2 = 0 ahead of the base, and σ_min there."""
    base, reach = robot.output_at(np.zeros(3)), robot.reach
    low = np.array([base[0], base[2] - reach])
    centres = cell_centres(low, low + [reach, 2 * reach], (CELLS // 2, CELLS))
    y = np.stack([centres[..., 0], 0 * centres[..., 0], centres[..., 1]], axis=-1)
    return centres, section_map(robot, parameters, y)


def _draw(axes: Axes, centres: Array, values: Array, names: tuple[str, str]) -> None:
    x, z = 1e3 * centres[0, :, 0], 1e3 * centres[:, 0, 1]
    mesh = axes.pcolormesh(x, z, values, cmap="viridis", vmin=0.0, rasterized=True)
    assert axes.figure is not None
    axes.figure.colorbar(mesh, ax=axes, label=f"smallest singular value  [{UNIT}]")
    axes.set_aspect("equal")
    axes.set_xlabel(f"{names[0]}  [mm]")
    axes.set_ylabel(f"{names[1]}  [mm]")
