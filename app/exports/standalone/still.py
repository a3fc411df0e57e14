"""The picture of a figure: its robots where they are farthest from the path, and all distances.

It stands where a page or a notebook cannot run: without scripts, on paper, on a website that shows
notebooks.
"""

from __future__ import annotations

import io
from collections.abc import Sequence
from typing import Any

import casadi as ca
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from PIL import Image

from onpath.app.common import palette
from onpath.app.exports.standalone.figure_words import run_titles
from onpath.lessons.words import Words
from onpath.models.arrays import Array
from onpath.models.closed_loop.trajectory import Trajectory
from onpath.models.control.sides import LEFT, RIGHT
from onpath.models.paths.curves import Curve
from onpath.models.systems.robots import Robot

SIZE, DPI = (7.6, 5.2), 100
COLOURS = 48
"""Of the picture: many enough for smooth lines, few enough for a small file."""
TRACE = 1000  # rows of the log that the trace shows


def still(robot: Robot, curve: Curve, runs: Sequence[Trajectory], words: Words) -> bytes:
    """The picture as a PNG file.

    Args:
        curve: the path.
        runs: one or two, of the same robot on this path.
    """
    drawn = Figure(figsize=SIZE, layout="constrained")
    colours = [palette.OF_SIDE[side].hex for side in ((LEFT, RIGHT) if runs[1:] else (RIGHT,))]
    shown = [int(run.distance.argmax()) for run in runs]
    names = [f"robot {number}" for number in range(len(runs))]
    layout: list[Any] = [names, ["chart"] * len(runs)]
    all_axes = drawn.subplot_mosaic(layout, height_ratios=(1.7, 1))
    scenes, chart = [all_axes[name] for name in names], all_axes["chart"]
    for axes in scenes[1:]:
        axes.sharex(scenes[0])
        axes.sharey(scenes[0])
    titles = run_titles(runs, words)
    each = zip(scenes, runs, shown, colours, titles, strict=True)
    for axes, run, row, colour, title in each:
        _draw_scene(axes, robot, curve, run, row, colour)
        values = {"law": title, "far": f"{1e3 * run.distance[row]:.1f}"}
        axes.set_title(words("standalone.still_robot", **values), fontsize=10)
        chart.plot(run.t, 1e3 * run.distance, color=colour, linewidth=1.6)
        chart.plot(run.t[row], 1e3 * run.distance[row], "o", color=colour, markersize=4)
    held = runs[0].t[runs[0].held]
    if held.size:
        chart.axvspan(held[0], held[-1], color="0.88", label=words("chart.held"))
        chart.legend(loc="upper right", frameon=False, fontsize=9)
    chart.set_xlabel(words("chart.time"))
    chart.set_ylabel(words("figure.distance"))
    chart.set_ylim(bottom=0)
    chart.grid(alpha=0.25)
    return _png(drawn)


def _draw_scene(
    axes: Axes, robot: Robot, curve: Curve, run: Trajectory, row: int, colour: str
) -> None:
    """The robot in one row of a run, seen as on the page, in [mm]."""
    q = robot.system.q
    picture = ca.Function("picture", [q], [*robot.skeleton(q, ca.SX(1))])

    def seen(points: Array) -> Array:
        return 1e3 * robot.seen @ robot.position(points).T

    theta = np.linspace(-np.pi, np.pi, 2 * curve.grid + 1)
    path = seen(robot.frame.lift(curve.at(theta)))
    drawn = curve.draws(theta)
    for shown, style in ((drawn, {}), (~drawn, {"linestyle": ":", "alpha": 0.6})):
        axes.plot(*np.where(shown, path, np.nan), color=palette.GREY.hex, linewidth=1.2, **style)
    axes.plot(*seen(run.fields["y"][max(0, row - TRACE) : row + 1]), color=colour, linewidth=1.8)
    lines, pins = (1e3 * robot.seen @ np.array(part) for part in picture(run.fields["q"][row]))
    for begin, end in zip(lines.T[::2], lines.T[1::2], strict=True):
        axes.plot(*np.transpose([begin, end]), color=colour, linewidth=5, alpha=0.45)
    axes.plot(*pins, "o", color=palette.STEEL.hex, markersize=5)
    axes.plot(*lines[:, -1], "o", color=colour, markersize=7)
    axes.set_aspect("equal")
    axes.set_axis_off()


def _png(drawn: Figure) -> bytes:
    plain, small = io.BytesIO(), io.BytesIO()
    drawn.savefig(plain, format="png", dpi=DPI)
    Image.open(plain).convert("RGB").quantize(COLOURS).save(small, "png", optimize=True)
    return small.getvalue()
