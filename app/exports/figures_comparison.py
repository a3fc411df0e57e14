"""The picture of a comparison: contour error against delay, for each law and obstruction."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import cycle
from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from onpath.app.exports.figures import ShownFigure, save
from onpath.lessons.sides import law_titles
from onpath.lessons.words import ENGLISH
from onpath.models.studies.comparison import Outcome

COLOURS = ("#d55e00", "#0072b2", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000", "#888888")
"""Okabe and Ito's colours, which are distinguishable with every form of colour blindness."""
MARKERS = "osD^v<>PX*dhp"  # one for each obstruction
LEAST = 1e-4  # [mm]; smaller distances are drawn here


def draw_comparison(results: Mapping[tuple[str, str], Sequence[Outcome]], path: Path) -> None:
    """Write `comparison_figure` to a file."""
    save(comparison_figure(results), path)


def comparison_figure(results: Mapping[tuple[str, str], Sequence[Outcome]]) -> Figure:
    """Plot the largest distance over the final delay, for the worst place of each obstruction.

    A law that stays on the path has a small distance; one that keeps to its clock has a delay of 0.
    A law whose worst run was stopped has neither: its marker is hollow, at the upper edge.
    """
    laws = list(dict.fromkeys(law for law, _ in results))
    obstructions = list(dict.fromkeys(name for _, name in results))
    figure = ShownFigure(figsize=(10, 6.2), layout="constrained")
    axes = figure.subplots()
    stopped = 0
    for (law, name), outcomes in results.items():
        colour = COLOURS[laws.index(law) % len(COLOURS)]
        worst = max(outcomes, key=lambda outcome: outcome.max_distance_m)
        marker = MARKERS[obstructions.index(name) % len(MARKERS)]
        if worst.stopped_at_s is None:
            distance = max(1e3 * worst.max_distance_m, LEAST)
            axes.plot(worst.delay_s, distance, marker, color=colour, markersize=9, alpha=0.85)
        else:
            stopped += 1
            edge = {"transform": axes.transAxes, "markerfacecolor": "none", "markersize": 9}
            axes.plot(0.03 * stopped, 0.96, marker, color=colour, **edge)
    if stopped:
        x = 0.03 * stopped + 0.02
        axes.text(x, 0.96, ENGLISH("compare.stopped"), transform=axes.transAxes, va="center")
    axes.set_yscale("log")
    axes.grid(alpha=0.25, which="major")
    axes.set_xlabel(ENGLISH("compare.delay"))
    axes.set_ylabel(ENGLISH("compare.distance"))
    _explain(figure, axes, laws, obstructions)
    return figure


def _explain(figure: Figure, axes: Axes, laws: list[str], obstructions: list[str]) -> None:
    """Add legends for the laws' colours and the obstructions' markers."""
    by_law = [
        axes.plot([], [], "o", color=colour, label=title)[0]
        for title, colour in zip(law_titles(laws, ENGLISH).values(), cycle(COLOURS), strict=False)
    ]
    by_obstruction = [
        axes.plot(
            [], [], MARKERS[i % len(MARKERS)], color="0.4", label=ENGLISH(f"obstruction.{name}")
        )[0]
        for i, name in enumerate(obstructions)
    ]
    figure.legend(handles=by_law, loc="outside right upper", title="law", frameon=False)
    figure.legend(
        handles=by_obstruction, loc="outside right lower", title="obstruction", frameon=False
    )
