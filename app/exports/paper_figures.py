"""Draws the paper's figures 2, 3, 5, 6 and 7 with Matplotlib, from runs with the same settings."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from onpath.app.common.palette import AZURE, INK, VERMILLION, WHITE
from onpath.app.exports.figures import ShownFigure, save
from onpath.models.arrays import Array
from onpath.models.closed_loop.trajectory import Trajectory
from onpath.models.control.laws.registry import LAWS
from onpath.models.studies.experiments import Experiment
from onpath.models.studies.paper_figures import PaperFigure
from onpath.models.systems.beam import beam_modes

COLOURS = (AZURE, VERMILLION)  # of the paper's law, and of the one beside it
LINES = ("-", "--", ":", "-.")
SHADES = (AZURE, AZURE.toward(INK, 0.8), AZURE.toward(WHITE, 0.45), AZURE.toward(INK, 0.4))
AREA = 1e4  # cm² in m²: the paper's s(y) is an area


@dataclass(frozen=True, slots=True)
class Panel:
    """One axis over time.

    Attributes:
        label: with its unit.
        values: run -> lines, shape (n, lines), in that unit.
        names: of the lines, if there are several.
        reference: run -> reference, shape (n,); None: no reference.
        enlarged: whether small lines are multiplied by a power of ten, stated beside their names.
    """

    label: str
    values: Callable[[Trajectory], Array]
    names: tuple[str, ...] = ()
    reference: Callable[[Trajectory], Array] | None = None
    enlarged: bool = False


def draw_paper_figure(figure: PaperFigure, runs: list[Trajectory], path: Path) -> None:
    """Write `paper_figure` to a file."""
    save(paper_figure(figure, runs), path)


def paper_figure(figure: PaperFigure, runs: list[Trajectory]) -> Figure:
    """One of the paper's figures, with its axes and signals."""
    experiment = figure.planned()
    picture = ShownFigure(figsize=_SIZES[figure.number], layout="constrained")
    picture.suptitle(f"Figure {figure.number}: {figure.title}", fontsize=12)
    if figure.number == 2:
        _plane(picture, experiment, runs)
    elif figure.number == 6:
        _space(picture, experiment, runs[0])
    elif figure.number == 7:
        across = [*_transversal(), *_in_space()]
        along = [*_tangential(experiment), *_internal(experiment)]
        _over_time(picture, [across, along], runs)
    else:
        _over_time(picture, [[*_transversal(), *_tangential(experiment), _torque()]], runs)
    return picture


_SIZES = {2: (9.5, 5.5), 3: (7.5, 8.5), 5: (7.5, 8.5), 6: (7.0, 6.5), 7: (11.0, 8.5)}


def _transversal() -> list[Panel]:
    return [
        Panel(r"$\xi_1$  [cm²]", lambda run: AREA * run.fields["xi"][:, :1]),
        Panel(r"$\xi_2$  [cm²/s]", lambda run: AREA * run.fields["xi_rate"][:, :1]),
    ]


def _in_space() -> list[Panel]:
    """The second transversal pair: the distance from the path's plane and its rate."""
    return [
        Panel(r"$\xi_3$  [mm]", lambda run: 1e3 * run.fields["xi"][:, 1:]),
        Panel(r"$\xi_4$  [mm/s]", lambda run: 1e3 * run.fields["xi_rate"][:, 1:]),
    ]


def _tangential(experiment: Experiment) -> list[Panel]:
    parameters = experiment.parameters
    holds = parameters.task == "position"

    def speed(run: Trajectory) -> Array:
        return np.zeros_like(run.t) if holds else run.fields["speed_ref"][:, 0]

    def place(run: Trajectory) -> Array:
        return np.full_like(run.t, parameters.target)

    return [
        Panel(
            r"$\eta_2^1$  [rad]",
            lambda run: _wrapped(run.fields["theta"]),
            reference=place if holds else None,
        ),
        Panel(r"$\eta_2^2$  [rad/s]", lambda run: run.fields["theta_rate"], reference=speed),
    ]


def _internal(experiment: Experiment) -> list[Panel]:
    """η1: the contribution of each mode to the tip's deflection, and its rate.

    Together, the modes move in such a way that the output does not.
    """
    robot = experiment.robot()
    m, names = robot.system.m, robot.system.parameter_names
    length = robot.plant(experiment.parameters)[names.index("l")]
    modes = robot.system.n - m
    tip = 1e3 * beam_modes(modes, length).tip
    lines = tuple(f"mode {j + 1}" for j in range(modes))
    return [
        Panel(
            r"$\eta_1$: $\varphi_j f_j$  [mm]",
            lambda run: tip * run.fields["q"][:, m:],
            lines,
            enlarged=True,
        ),
        Panel(
            r"$\eta_1$: $\varphi_j \dot f_j$  [mm/s]",
            lambda run: tip * run.fields["v"][:, m:],
            lines,
            enlarged=True,
        ),
    ]


def _torque() -> Panel:
    return Panel(r"$u$  [N m]", lambda run: run.fields["u"], ("$u_1$", "$u_2$"))


def _over_time(picture: Figure, columns: list[list[Panel]], runs: list[Trajectory]) -> None:
    grid = picture.subplots(len(columns[0]), len(columns), sharex=True, squeeze=False)
    for i, panels in enumerate(columns):
        for axes, panel in zip(grid[:, i], panels, strict=True):
            _draw(axes, panel, runs[0])
        grid[-1, i].set_xlabel("t  [s]")


def _draw(axes: Axes, panel: Panel, run: Trajectory) -> None:
    lines = panel.values(run).T
    larger = enlargements(lines) if panel.enlarged else np.ones(len(lines))
    shades = SHADES if panel.enlarged else [AZURE] * len(LINES)
    looks = zip(LINES, shades, (*panel.names, *LINES), strict=False)
    for line, factor, (style, shade, name) in zip(lines, larger, looks, strict=False):
        scaled_name = name if factor == 1 else f"{name}, {factor:.0f}×"
        label = scaled_name if panel.names else None
        axes.plot(run.t, factor * line, style, color=shade.hex, linewidth=1.4, label=label)
    if panel.reference is not None:
        axes.plot(run.t, panel.reference(run), "--", color="0.25", linewidth=1.1, label="reference")
    if panel.names:
        axes.margins(y=0.25)  # space for the legend
        axes.legend(loc="upper right", fontsize=8, ncols=4)
    elif panel.reference is not None:
        axes.legend(loc="best", fontsize=8)
    held = run.t[run.held]
    if held.size:
        axes.axvspan(held[0], held[-1], color="0.5", alpha=0.2, linewidth=0)
    axes.set_ylabel(panel.label)
    axes.grid(alpha=0.25)


def enlargements(lines: Array) -> Array:
    """Powers of ten that bring every line to at least a tenth of the largest, (k, n) -> (k,)."""
    sizes = np.abs(lines).max(axis=1)
    sizes[sizes == 0] = sizes.max()
    return 10.0 ** np.floor(np.log10(sizes.max() / sizes))


def _wrapped(theta: Array) -> Array:
    """Angles in (-π, π], with NaN where they jump."""
    wrapped = np.angle(np.exp(1j * theta))
    wrapped[1:][np.abs(np.diff(wrapped, axis=0)) > np.pi] = np.nan
    return wrapped


def _plane(picture: Figure, experiment: Experiment, runs: list[Trajectory]) -> None:
    """The end-point in the output space, one law beside the other."""
    picture.set_layout_engine("compressed")  # axes of equal scales are smaller than their cells
    path = 1e3 * experiment.curve().at(np.linspace(-np.pi, np.pi, 400))
    target = 1e3 * experiment.curve().at(np.array(experiment.parameters.target))
    grid = picture.subplots(1, len(runs), sharex=True, sharey=True, squeeze=False)
    for axes, run, colour in zip(grid[0], runs, COLOURS, strict=False):
        y = 1e3 * run.fields["y"]
        axes.plot(*path.T, "--", color="0.35", linewidth=1.2, label=r"path $\gamma$")
        axes.plot(*y.T, color=colour.hex, linewidth=1.8, label="end-point")
        axes.plot(*y[0], "o", color=colour.hex, markersize=7, label="start")
        axes.plot(*target, "*", color="0.1", markersize=12, label=r"$\eta_2^{1\mathrm{ref}}$")
        axes.set_title(LAWS[run.law].label, fontsize=11)
        axes.set_aspect("equal")
        axes.set_xlabel("$y_1$  [mm]")
        axes.grid(alpha=0.25)
    grid[0, 0].set_ylabel("$y_2$  [mm]")
    grid[0, 0].legend(loc="center", fontsize=8)


def _space(picture: Figure, experiment: Experiment, run: Trajectory) -> None:
    """The tip in the output space."""
    axes: Any = picture.add_subplot(projection="3d")
    frame = experiment.robot().frame
    path = 1e3 * frame.lift(experiment.curve().at(np.linspace(-np.pi, np.pi, 400)))
    y = 1e3 * run.fields["y"]
    axes.plot(*path.T, "--", color="0.35", linewidth=1.2, label=r"path $\gamma$")
    axes.plot(*y.T, color=AZURE.hex, linewidth=1.4, label="tip")
    axes.plot(*y[:1].T, "o", color=AZURE.hex, label="start")
    axes.plot(*y[-1:].T, "s", color=AZURE.hex, label="end")
    for name, number in (("x", 1), ("y", 2), ("z", 3)):
        getattr(axes, f"set_{name}label")(f"$y_{number}$  [mm]")
    axes.set_box_aspect(None, zoom=0.88)  # leaves room for the labels
    axes.view_init(elev=22, azim=-50)
    axes.legend(loc="upper left", fontsize=8)
