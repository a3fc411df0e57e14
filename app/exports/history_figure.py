"""The picture of the lab's last minute: title, parameters, plots and legends."""

from __future__ import annotations

import io
from collections.abc import Mapping, Sequence
from textwrap import fill

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from onpath.app.common.palette import INK, OF_SIDE
from onpath.app.exports.figures import STYLES, Quantity, draw_column, panels_of, without_math
from onpath.lessons.labels import (
    parameter_label,
    parameter_unit,
    path_label,
    robot_label,
    value_label,
)
from onpath.lessons.sides import side_titles
from onpath.lessons.words import ENGLISH, Words
from onpath.models.closed_loop.trajectory import Trajectory
from onpath.models.control.settable import specs, values_of
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.parameter_specs import Spec
from onpath.models.systems.parameters import Parameters

ALWAYS = ("K1", "K2", "K3", "K4", "K5", "speed")
"""Parameters that are always stated; the others only if they differ from those of a new lab."""
WIDTH = 150
"""Characters in a line of parameters."""
SMALL = 9.0
"""Size of explanatory text [pt]."""
MEANS = {
    "xi": "figure.xi_means",
    "eta1": "figure.eta1_means",
    "eta2": "figure.eta2_means",
    "u": "figure.u_means",
    "level_set": "figure.level_set_means",
}
"""Message that explains the symbols of a panel, by name of the panel."""
GREY = "0.35"
Runs = Mapping[str, Sequence[Trajectory]]
"""What each side did under its control laws, one after the other, by side."""


def draw_history(
    runs: Runs,
    words: Words = ENGLISH,
    parameters: Parameters | None = None,
    robot: str = "five_bar",
    path: str = "circle",
    logged: Trajectory | None = None,
) -> bytes:
    """The lab's plots over the last minute as PNG.

    Args:
        parameters: the present ones, which are stated; None: none are.
        robot, path: names of the robot and of the present path.
        logged: by a real arm, or None.
    """
    figure = history_figure(runs, words, parameters, robot, path, logged)
    file = io.BytesIO()
    figure.savefig(file, format="png", dpi=110)
    return file.getvalue()


def history_figure(
    runs: Runs,
    words: Words,
    parameters: Parameters | None,
    robot: str,
    path: str,
    logged: Trajectory | None = None,
) -> Figure:
    """The figure of `draw_history`."""
    every = [run for parts in runs.values() for run in parts]
    level_set = any(run.level_set for run in every)
    entry = ROBOTS[robot]
    motors = entry.make(parameters or entry.parameters()).system.motor_units
    panels = panels_of(words, level_set, entry.guesses, motors=motors)
    figure = Figure(figsize=(11, 2.3 * len(panels) + 0.6), layout="constrained")
    axes = figure.subplots(len(panels), 1, sharex=True)
    for axis, (name, label, column) in zip(axes, panels, strict=True):
        count = _draw(axis, runs, column)
        if logged is not None:
            _draw_log(axis, logged, every, *column(logged))
        axis.set_ylabel(label)
        axis.grid(alpha=0.25)
        if name in MEANS:
            meaning = words(MEANS["level_set" if name == "xi" and level_set else name])
            axis.set_title(meaning, loc="left", fontsize=SMALL, color=GREY)
        if count > 1:
            _add_styles(axis, _line_names(name, count, words))
    figure.suptitle(
        words(
            "figure.history",
            robot=without_math(robot_label(robot, words)),
            path=path_label(path, words),
            seconds=f"{_span(every):.0f}",
        ),
        fontsize=15,
    )
    if parameters is not None:
        stated = fill(parameter_line(parameters, entry.parameters(), words), WIDTH)
        axes[0].set_title(stated, loc="left", fontsize=SMALL, color=GREY)
    legend = _legend(runs, words)
    if logged is not None:
        legend.append(Line2D([], [], color=INK.hex, linewidth=1, label=words("chart.log")))
    axes[0].legend(handles=legend, loc="upper right", fontsize=SMALL)
    axes[-1].set_xlabel("t  [s]")
    return figure


def parameter_line(parameters: Parameters, usual: Parameters, words: Words) -> str:
    """The gains, the speed, and whatever else differs from a new lab, in one line."""
    known, defaults = specs(parameters), values_of(usual)
    shown = {
        name: value
        for name, value in values_of(parameters).items()
        if name in ALWAYS or value != defaults[name]
    }
    return ", ".join(_written(name, known[name], value, words) for name, value in shown.items())


def _written(name: str, spec: Spec, value: float | int | str, words: Words) -> str:
    label, shown = parameter_label(name, spec, words), value_label(name, value, words)
    if isinstance(value, str):
        return f"{label}: {shown}"
    return f"{label} = {shown} {parameter_unit(name, spec, words)}".strip()


def _span(runs: Sequence[Trajectory]) -> float:
    """Duration of all runs together [s]."""
    return max(float(run.t[-1]) for run in runs) - min(float(run.t[0]) for run in runs)


def _draw(axis: Axes, runs: Runs, column: Quantity) -> int:
    """Draw a quantity, holds and changes of law; return the number of lines of a run."""
    count = 1
    for side, parts in runs.items():
        for run in parts:
            (values,) = column(run)
            count = max(count, values.shape[1])
            draw_column(axis, run, OF_SIDE[side], values)
            for begin, end in held_times(run):
                axis.axvspan(begin, end, color=OF_SIDE[side].hex, alpha=0.08, linewidth=0)
        for run in parts[1:]:
            axis.axvline(run.t[0], color=OF_SIDE[side].hex, linestyle="-.", linewidth=1)
    return count


def _draw_log(
    axis: Axes, logged: Trajectory, runs: Sequence[Trajectory], values: np.ndarray
) -> None:
    """Draw what was logged while the runs last."""
    begin, end = min(run.t[0] for run in runs), max(run.t[-1] for run in runs)
    shown = (logged.t >= begin) & (logged.t <= end)
    for column, style in zip(values[shown].T, STYLES, strict=False):
        axis.plot(logged.t[shown], column, style, color=INK.hex, linewidth=1)


def held_times(run: Trajectory) -> list[tuple[float, float]]:
    """Beginning and end of each period in which the robot was held back [s]."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], run.held.astype(int), [0]])))
    last = len(run.t) - 1
    pairs = zip(edges[::2], edges[1::2], strict=True)
    return [(float(run.t[begin]), float(run.t[min(end, last)])) for begin, end in pairs]


def _line_names(panel: str, count: int, words: Words) -> list[str]:
    """Names of the lines of one robot; ξ₁ and ξ₃ are the distances across a space curve."""
    if panel == "xi":
        return [rf"$\xi_{2 * i + 1}$" for i in range(count)]
    return [words("figure.motor", number=i + 1) for i in range(count)]


def _add_styles(axis: Axes, names: list[str]) -> None:
    """Add a legend of the line styles of one robot."""
    lines = [
        Line2D([], [], color=GREY, linestyle=style, label=name)
        for style, name in zip(STYLES, names, strict=False)
    ]
    axis.legend(handles=lines, loc="upper right", fontsize=SMALL, ncols=len(lines))


def _legend(runs: Runs, words: Words) -> list[Line2D | Patch]:
    """The robots' colours, and the marks of holds and changes of law, if there are any."""
    laws = {side: tuple(run.law for run in parts) for side, parts in runs.items()}
    titles = side_titles(laws, words)
    found: list[Line2D | Patch] = [
        Line2D([], [], color=OF_SIDE[side].hex, label=title) for side, title in titles.items()
    ]
    if any(len(parts) > 1 for parts in runs.values()):
        found.append(Line2D([], [], color=GREY, linestyle="-.", label=words("figure.law")))
    if any(run.held.any() for parts in runs.values() for run in parts):
        found.append(Patch(color=GREY, alpha=0.2, linewidth=0, label=words("figure.held")))
    return found
