"""Figures of the zero dynamics: exponents against alpha and number of modes, critical alpha."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from onpath.app.exports.figures import save
from onpath.app.exports.zero_dynamics import Study, critical_alpha, critical_map, highest, study
from onpath.models.studies.experiments import experiments
from onpath.models.systems.beam import MOST_MODES

SAMPLES = 241
RHOS = (0.05, 0.1, 0.2, 0.3, 0.4, 0.6, 0.8, 1.0)


def draw_zero_dynamics(result: Study, path: Path) -> None:
    """Exponents against alpha for 1 to 6 modes; critical alpha over the path's plane and rho."""
    figure = Figure(figsize=(13, 7.5), layout="constrained")
    axes = figure.subplot_mosaic(
        [["exponents", "map"], ["exponents", "rho"]], width_ratios=(1.5, 1)
    )
    parameters = result.parameters
    name = parameters.plant.replace("_", " ")
    figure.suptitle(f"Zero dynamics of the flexible link ({name}, ρ = {parameters.rho:g} kg/m)")
    limit = highest(parameters)
    fine = study(parameters, result.at, np.linspace(-limit * 2 / 3, limit, SAMPLES))
    _draw_exponents(axes["exponents"], fine)
    _draw_map(axes["map"], result)
    _draw_rho(axes["rho"], result)
    save(figure, path)


def _draw_exponents(axes: Axes, fine: Study) -> None:
    colours = matplotlib.colormaps["viridis"](np.linspace(0, 0.9, MOST_MODES))
    for modes, colour in enumerate(colours, start=1):
        critical = fine.critical[modes - 1]
        label = f"{modes} mode{'s' if modes > 1 else ''}, critical α = {critical:.3f}"
        width = 1.2 + 0.7 * (MOST_MODES - modes)  # later curves cover earlier ones
        axes.plot(fine.alphas, fine.fastest[modes - 1], color=colour, lw=width, label=label)
        axes.plot([critical], [0], "o", color=colour, markersize=7)
    axes.axhline(0, color="0.3", linewidth=0.8)
    axes.set_yscale("symlog", linthresh=1)
    axes.set_xlabel("α: share of the deflection in the controlled output (1: tip, 0: rigid link)")
    unit = rf"$\sqrt{{EI/\rho}}/\ell^2$ = {fine.unit:.2f} 1/s"
    axes.set_ylabel(f"largest real part of the exponents  [1/s]    ({unit})")
    axes.grid(alpha=0.25)
    axes.legend(loc="upper left")


def _draw_map(axes: Axes, result: Study) -> None:
    lines, critical = critical_map(result.parameters)
    filled = axes.contourf(1e3 * lines, 1e3 * lines, critical, levels=12, cmap="viridis")
    axes.figure.colorbar(filled, ax=axes, label="critical α")
    r = 1e3 * experiments()["flexible"].schedule.r
    angle = np.linspace(0, 2 * np.pi, 200)
    axes.plot(r * np.cos(angle), r * np.sin(angle), color="white", linewidth=2)
    axes.set_aspect("equal")
    axes.set_xlabel("$y_2$  [mm]")
    axes.set_ylabel("$y_3$  [mm]")
    axes.set_title(f"at rest, modes: {result.parameters.modes}; white: the path")


def _draw_rho(axes: Axes, result: Study) -> None:
    for plant, style in (("lagrangian", "-"), ("unit_modes", "--")):
        variants = [replace(result.parameters, plant=plant, rho=rho) for rho in RHOS]
        critical = [critical_alpha(each, result.at) for each in variants]
        axes.plot(RHOS, critical, style, marker="o", label=plant.replace("_", " "))
    axes.axhline(1, color="0.3", linewidth=0.8)
    axes.text(RHOS[-1], 1.05, "the tip", ha="right", va="bottom")
    axes.set_yscale("log")
    axes.set_xlabel("ρ  [kg/m]")
    axes.set_ylabel("critical α")
    axes.grid(alpha=0.25, which="both")
    axes.legend()
