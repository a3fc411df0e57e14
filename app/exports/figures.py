"""Figures of runs in the style of the paper's figures 2, 3 and 5, drawn with Matplotlib."""

from __future__ import annotations

import io
from collections.abc import Callable, Sequence
from pathlib import Path

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.transforms import ScaledTranslation

from onpath.app.common.palette import INK, Colour, of_law
from onpath.app.lab.plot_rows import motor_row
from onpath.lessons.words import ENGLISH, Words
from onpath.models.closed_loop.trajectory import Trajectory
from onpath.models.robot_files.guesses import Guess
from onpath.models.studies.experiments import Experiment
from onpath.models.studies.log_motion import LOG
from onpath.models.systems.guessed_numbers import with_mark

EXTRA = {"deflection": ("deflection of\nthe tip  [mm]", 1e3)}
"""Label and scale of each of `Robot.extras` that is drawn."""
PANELS = {"distance": "distance", "xi": "xi", "eta1": "theta", "eta2": "theta_rate", "u": "tau"}
"""Name of each panel -> that of its quantity in `quantities_of`."""
STYLES = ("-", "--", ":")
"""Line styles of the first, second and third component of a quantity."""
Quantity = Callable[[Trajectory], tuple[np.ndarray]]
"""A run -> the values that are drawn, shape (n, k)."""


class ShownFigure(Figure):
    """A figure that a notebook shows whether or not pyplot is in use."""

    def _repr_png_(self) -> bytes:
        return self.png()

    def png(self) -> bytes:
        """The picture as a PNG file."""
        file = io.BytesIO()
        self.savefig(file, format="png", dpi=80)
        return file.getvalue()


def draw_experiment(experiment: Experiment, runs: list[Trajectory], path: Path) -> None:
    """Write `experiment_figure` to a file."""
    save(experiment_figure(experiment, runs), path)


def experiment_figure(experiment: Experiment, runs: list[Trajectory]) -> Figure:
    """Plot the end-point in output space, and distance, xi, eta, speed and torque over time."""
    level_set = any(run.level_set for run in runs)
    motors = experiment.robot().system.motor_units
    panels = panels_of(level_set=level_set, guesses=experiment.entry.guesses, motors=motors)
    panels[1:1] = _extra_panels(experiment)
    figure = ShownFigure(figsize=(13, 2.1 * len(panels)), layout="constrained")
    axes = figure.subplot_mosaic([["space", name] for name, _, _ in panels], width_ratios=(1, 1.25))
    figure.suptitle(without_math(experiment.title), fontsize=15)
    _draw_space(figure, axes["space"], experiment, runs)
    for name, label, column in panels:
        for run in runs:
            draw_column(axes[name], run, _colour(run), *column(run))
        axes[name].set_ylabel(label)
        axes[name].grid(alpha=0.25)
        _shade_held(axes[name], runs)
    for name, _, _ in panels[:-1]:
        axes[name].tick_params(labelbottom=False)
        axes[name].sharex(axes[panels[-1][0]])
    axes[panels[-1][0]].set_xlabel("t  [s]")
    return figure


def save(figure: Figure, path: Path) -> None:
    """Write a figure to a file; the same figure gives the same bytes."""
    with matplotlib.rc_context({"svg.hashsalt": "onpath"}):  # otherwise its identifiers are random
        figure.savefig(path, metadata=_reproducible(path), dpi=110)


def without_math(name: str) -> str:
    """A name of a user's in which no $ begins a formula."""
    return name.replace("$", r"\$")


def panels_of(
    words: Words = ENGLISH,
    level_set: bool = False,
    guesses: Sequence[Guess] = (),
    *,
    motors: Sequence[str],
) -> list[tuple[str, str, Quantity]]:
    """Axes name, label and quantity of each panel, from top to bottom.

    Args:
        level_set: whether the first component of xi is in [m²].
        guesses: about the robot; what rests on them is marked.
        motors: their units, see `MechanicalSystem.motor_units`.
    """
    panels = _panels(words, level_set, motors)
    return [(name, _marked(name, label, guesses, words), of) for name, label, of in panels]


def _marked(name: str, label: str, guesses: Sequence[Guess], words: Words) -> str:
    """A panel's label, with the mark on a line of its own."""
    marked = with_mark("", guesses, PANELS[name], words.language)
    return f"{label}\n{marked.strip()}" if marked else label


def _panels(
    words: Words, level_set: bool, motors: Sequence[str]
) -> list[tuple[str, str, Quantity]]:
    xi = r"$\xi_1=s(y)$  [mm$^2$]" if level_set else r"$\xi_1$  [mm]"
    return [
        ("distance", words("figure.distance"), lambda r: (1e3 * r.distance[:, None],)),
        ("xi", xi, lambda r: (_shown_xi(r, level_set),)),
        ("eta1", r"$\eta_2^1=\theta$  [rad]", lambda r: (_wrapped(r.fields["theta"]),)),
        ("eta2", r"$\eta_2^2=\dot\theta$  [rad/s]", lambda r: (r.fields["theta_rate"],)),
        ("u", words(f"figure.{motor_row(motors)}"), lambda r: (r.fields["u"],)),
    ]


def _shown_xi(run: Trajectory, level_set: bool) -> np.ndarray:
    """xi in [mm]; with a level set, its first component s(y) alone, in [mm²]."""
    return 1e6 * run.fields["xi"][:, :1] if level_set else 1e3 * run.fields["xi"]


def _extra_panels(experiment: Experiment):
    """Panels, as in `panels_of`, for the quantities that only this robot has."""
    robot, parameters = experiment.robot(), experiment.parameters
    names = [name for name in robot.extras if name in EXTRA]

    def values(run: Trajectory, name: str) -> np.ndarray:
        return robot.measured(run.fields["q"], run.fields["v"], parameters)[name]

    def panel(name: str):
        label, scale = EXTRA[name]
        return name, label, lambda run: (scale * values(run, name),)

    return [panel(name) for name in names]


def _wrapped(theta: np.ndarray) -> np.ndarray:
    """Angles in (-pi, pi], with NaN inserted at jumps."""
    wrapped = np.angle(np.exp(1j * theta))
    jumps = np.abs(np.diff(wrapped, axis=0)) > np.pi
    wrapped[1:][jumps] = np.nan
    return wrapped


def _colour(run: Trajectory) -> Colour:
    return INK if run.law == LOG else of_law(run.law)


def draw_column(axes: Axes, run: Trajectory, colour: Colour, values: np.ndarray) -> None:
    """Plot the columns of values, shape (n, k), each in the style of `STYLES`."""
    for column, style in zip(values.T, STYLES, strict=False):
        axes.plot(run.t, column, style, color=colour.hex, linewidth=1.5)


def _shade_held(axes: Axes, runs: list[Trajectory]) -> None:
    times = runs[0].t[runs[0].held]
    if times.size:
        axes.axvspan(times[0], times[-1], color="0.5", alpha=0.15, linewidth=0)


def _draw_space(figure: Figure, axes: Axes, experiment: Experiment, runs: list[Trajectory]) -> None:
    frame = experiment.robot().frame
    curve = experiment.curve()
    for number, stroke in enumerate(curve.plan.strokes()):
        label = "_" if number else "path"
        style = {"color": "0.75", "linewidth": 6, "solid_capstyle": "round"}
        axes.plot(*(1e3 * stroke.T), label=label, **style)
    given = curve.given
    if given is not None:
        axes.plot(*(1e3 * given.T), color="0.5", linewidth=0.8, linestyle="--", label="given")
    for number, run in enumerate(runs):
        known = [each.label for each in runs[:number]]
        label = "_" if run.label in known else run.label  # of a log with gaps
        z, theta, colour = (
            1e3 * frame.planar(run.fields["y"]),
            run.fields["theta"],
            _colour(run).hex,
        )
        raised = np.isfinite(theta) & ~curve.draws(theta)
        axes.plot(*np.where(raised, np.nan, z).T, color=colour, linewidth=1.6, label=label)
        axes.plot(*np.where(raised, z, np.nan).T, ":", color=colour, linewidth=0.8, alpha=0.6)
        axes.plot(*z[0], "o", color=colour, markersize=6)
        axes.plot(*z[-1], "s", color=colour, markersize=7)
    axes.plot([], [], "o", color="0.3", label="start")
    axes.plot([], [], "s", color="0.3", label="end")
    if any(run.held.any() for run in runs):
        axes.plot([], [], color="0.5", alpha=0.3, linewidth=10, label="held back (right)")
    axes.set_aspect("equal", anchor="N")
    first, second = frame.axes
    axes.set_xlabel(f"$y_{first}$  [mm]")
    axes.set_ylabel(f"$y_{second}$  [mm]")
    axes.grid(alpha=0.25)
    below = axes.transAxes + ScaledTranslation(0.0, -0.5, figure.dpi_scale_trans)
    style = {"loc": "upper center", "ncols": 2, "frameon": False}
    axes.legend(bbox_to_anchor=(0.5, 0.0), bbox_transform=below, **style)


def _reproducible(path: Path) -> dict[str, None] | None:
    """Metadata without the date, so that the same run gives the same bytes."""
    return {".svg": {"Date": None}, ".pdf": {"CreationDate": None}}.get(path.suffix)
