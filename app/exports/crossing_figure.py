"""Three ways to follow a path that crosses itself, side by side, drawn with Matplotlib."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from textwrap import fill
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from onpath.app.common.palette import WARNING, of_law
from onpath.app.exports.figures import ShownFigure, save
from onpath.models.closed_loop.trajectory import Trajectory
from onpath.models.studies.crossing import NOISE, WAYS, jumps
from onpath.models.studies.experiments import Experiment

Runs = Mapping[str, Trajectory]


def draw_crossing_figure(experiment: Experiment, runs: Runs, path: Path) -> None:
    """Write `crossing_figure` to a file."""
    save(crossing_figure(experiment, runs), path)


def crossing_figure(experiment: Experiment, runs: Runs) -> Figure:
    """For each run the end-point in the plane, and θ over time; jumps are red."""
    figure = ShownFigure(figsize=(13, 6.5), layout="constrained")
    noise = f"joint angles measured to {1e3 * NOISE:g} mrad"
    figure.suptitle(f"From rest at the crossing of a path, {noise}")
    axes = figure.subplots(2, len(WAYS), sharey="row", height_ratios=(1.2, 1), squeeze=False)
    for column, (key, text) in enumerate(WAYS.items()):
        _draw_plane(axes[0, column], experiment, runs[key])
        _draw_parameter(axes[1, column], runs[key])
        axes[0, column].set_title(fill(text, 36), fontsize=10)
    axes[0, 0].set_ylabel("$z_2$  [mm]")
    axes[1, 0].set_ylabel(r"$\theta$  [rad]")
    return figure


def crossing_summary(runs: Runs) -> dict[str, Any]:
    """The numbers of the runs."""
    return {
        "figure": "crossing",
        "runs": {
            key: {
                "max_distance_m": float(f"{run.distance.max():.9g}"),
                "jumps": len(jumps(run)),
                "first_jump_s": float(jumps(run)[0]) if len(jumps(run)) else None,
                "theta_at_end_rad": float(f"{run.fields['theta'][-1, 0]:.9g}"),
            }
            for key, run in runs.items()
        },
    }


def _draw_plane(axes: Axes, experiment: Experiment, run: Trajectory) -> None:
    path = 1e3 * experiment.curve().at(np.linspace(-np.pi, np.pi, 400))
    z = 1e3 * experiment.robot().frame.planar(run.fields["y"])
    axes.plot(*path.T, color="0.8", linewidth=5)
    axes.plot(*z.T, color=of_law(run.law).hex, linewidth=1.6)
    axes.plot(*z[-1], "s", color=of_law(run.law).hex, markersize=7)
    jumped = z[np.isin(run.t, jumps(run))]
    axes.plot(*jumped.T, "x", color=WARNING.hex, markersize=9, markeredgewidth=2)
    axes.set_aspect("equal")
    axes.set_xlabel("$z_1$  [mm]")


def _draw_parameter(axes: Axes, run: Trajectory) -> None:
    axes.plot(run.t, run.fields["theta"][:, 0], color=of_law(run.law).hex, linewidth=1.2)
    for time in jumps(run):
        axes.axvline(float(time), color=WARNING.hex, linewidth=0.8)
    axes.set_xlabel("t  [s]")
    axes.grid(alpha=0.25)
