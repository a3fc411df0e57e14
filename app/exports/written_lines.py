"""The lines that the robots have written along their path, side by side: a picture to keep."""

from __future__ import annotations

import io

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from onpath.app.common.palette import OF_SIDE
from onpath.app.exports.history_figure import GREY, SMALL, Runs, held_times
from onpath.lessons.sides import side_titles
from onpath.lessons.words import Words
from onpath.models.arrays import Array
from onpath.models.closed_loop.trajectory import Trajectory
from onpath.models.paths.curves import Curve
from onpath.models.paths.frames import Frame

REACHED = 1e-3  # [m] from the path, at which a robot begins to write
WIDTH = 5.2  # [in], of one robot's picture
FINE = 4  # points drawn for each one of a path's grid


def draw_written(runs: Runs, frame: Frame, curve: Curve, words: Words) -> bytes:
    """The figure of `written_figure` as PNG."""
    file = io.BytesIO()
    written_figure(runs, frame, curve, words).savefig(file, format="png", dpi=150)
    return file.getvalue()


def written_figure(runs: Runs, frame: Frame, curve: Curve, words: Words) -> Figure:
    """What each robot has written since it reached its path.

    The path itself is grey beneath. Where the pen is raised, nothing is drawn. A ring shows where
    a robot was caught by the brake.

    Args:
        runs: the robots' runs on the path, by side.
        frame: how the path lies in the output space.
        curve: the path, in coordinates of its plane.
    """
    span = np.ptp(curve.at(curve.sample()), axis=0)
    height = WIDTH * float(np.clip(span[1] / span[0], 0.3, 1.2)) if span[0] > 0 else WIDTH
    figure = Figure(figsize=(WIDTH * len(runs), height + 0.8), layout="constrained")
    row = figure.subplots(1, len(runs), sharex=True, sharey=True, squeeze=False)[0]
    titles = side_titles({side: tuple(p.law for p in parts) for side, parts in runs.items()}, words)
    theta = curve.sample(FINE * curve.grid)
    if curve.closed:
        theta = np.append(theta, theta[0] + 2 * np.pi)
    wanted = 1e3 * _pen_down(curve, theta, curve.at(theta)[:, :2])
    for axis, (side, parts) in zip(row, runs.items(), strict=True):
        axis.plot(*wanted.T, color="0.8", linewidth=5, solid_capstyle="round")
        for run in parts:
            _write(axis, run, frame, curve, OF_SIDE[side].hex)
        axis.set_title(titles[side], fontsize=15, color=OF_SIDE[side].hex)
        axis.set_aspect("equal")
        axis.set_xticks([])
        axis.set_yticks([])
        axis.spines[:].set_visible(False)
    if any(held_times(run) for parts in runs.values() for run in parts):
        figure.supxlabel(words("export.caught"), fontsize=SMALL, color=GREY)
    return figure


def _write(axis: Axes, run: Trajectory, frame: Frame, curve: Curve, colour: str) -> None:
    """Draw one run."""
    near = np.flatnonzero(run.distance < REACHED)
    if not len(near):
        return
    since = slice(int(near[0]), None)
    line = 1e3 * frame.planar(run.fields["y"])
    written = _pen_down(curve, run.fields["theta"][since, 0], line[since])
    axis.plot(*written.T, color=colour, linewidth=1.8)
    caught = np.searchsorted(run.t, [begin for begin, _ in held_times(run)])
    axis.plot(*line[caught].T, "o", markersize=11, markerfacecolor="none", color=colour)


def _pen_down(curve: Curve, theta: Array, points: Array) -> Array:
    """The points, with NaN where the pen is raised."""
    return np.where(curve.draws(theta)[:, None], points, np.nan)
