"""The folder "Show": switches for the optional drawings in the scene, and their legends."""

from __future__ import annotations

from math import inf
from typing import Any

import viser

from onpath.app.common.palette import SCALE
from onpath.app.common.templates import render
from onpath.app.lab.snapshots.page_snapshot import PageSnapshot
from onpath.app.page.panels.widgets import note, on_user_update, put
from onpath.app.scene.overlays import Overlays
from onpath.app.scene.rank_nodes import largest, map_opacity
from onpath.app.scene.tube_nodes import TubeShape
from onpath.lessons.words import Words
from onpath.models.control.rank_test import RankGrid
from onpath.models.systems.catalogue import ROBOTS

SWITCHES = {
    "labels": ("show.labels", "show.labels_hint"),
    "tube": ("show.tube", "show.tube_hint"),
    "grid": ("show.grid", "show.grid_hint"),
    "rank": ("show.rank", "show.rank_hint"),
    "errors": ("show.errors", "show.errors_hint"),
    "mass": ("show.mass", "show.mass_hint"),
}
"""Label and hint of each switch."""
TICKS = 3
"""Numbers beside the colour scale."""


class ShowPanel:
    """Switches, all off at first, and a legend for those that need one.

    Args:
        overlays: the drawings.
        expanded: whether the folder is open at first.
    """

    def __init__(
        self, gui: viser.GuiApi, words: Words, overlays: Overlays, expanded: bool = False
    ) -> None:
        self._words, self._overlays = words, overlays
        self._boxes: dict[str, viser.GuiCheckboxHandle] = {}
        self._shown: tuple[Any, ...] = (None,)
        with gui.add_folder(words("show.title"), expand_by_default=expanded):
            for name in SWITCHES:
                self._add(gui, name)
                if name == "grid":
                    self._numbers = gui.add_html("")
            self._legend = gui.add_html("")

    def _add(self, gui: viser.GuiApi, name: str) -> None:
        switches = self._overlays.switches
        label, hint = map(self._words, SWITCHES[name])
        box = gui.add_checkbox(label, name in switches, hint=hint)
        on_user_update(box, lambda on: (switches.add if on else switches.discard)(name))
        self._boxes[name] = box

    def follow(self, snapshot: PageSnapshot) -> None:
        """Show which drawings are on, even if switched elsewhere on the page, and their numbers."""
        overlays = self._overlays
        for name, box in self._boxes.items():
            put(box, value=name in overlays.switches)
        alpha = _alpha(snapshot) if overlays.rank_map is not None else None
        shape, grid, rank_map = overlays.shape, "grid" in overlays.switches, overlays.rank_map
        shown = shape, grid, rank_map, alpha
        if shown != self._shown:
            self._shown = shown
            self._numbers.content = tube_numbers(shape, grid, self._words)
            self._legend.content = rank_legend(
                rank_map, alpha, self._words, opacity=map_opacity(overlays.stage)
            )


def _alpha(snapshot: PageSnapshot) -> float | None:
    """α, on which the controlled output of a robot with a flexible link depends."""
    if ROBOTS[snapshot.key.robot].flexible_link is None:
        return None
    return float(snapshot.parameters["alpha"])


def tube_numbers(shape: TubeShape | None, grid: bool, words: Words) -> str:
    """The width of the tube and the distances between the curves, as HTML; empty without a tube."""
    if shape is None:
        return ""
    text = words("show.width_none")
    if shape.width < inf:
        text = words("show.width", width=f"{1e3 * shape.width:.1f}")
    if grid:
        steps = words("show.steps", xi=f"{1e3 * shape.step:g}", theta=f"{shape.degrees:g}")
        text = f"{text} {steps}"
    return note(text, small=True)


def rank_legend(
    grid: RankGrid | None, alpha: float | None, words: Words, opacity: float = 1.0
) -> str:
    """The colour scale with its numbers and unit, as HTML; empty without a map.

    Args:
        alpha: of a flexible link, or None.
        opacity: of the map.
    """
    if grid is None:
        return ""
    most = largest(grid.values)
    return render(
        "panel/rank_legend.html",
        colours=[colour.hex for colour in SCALE],
        opacity=opacity,
        ticks=[f"{most * i / (TICKS - 1):.3g}" for i in range(TICKS)],
        alpha=None if alpha is None else f"{alpha:g}",
        words=words,
    )
