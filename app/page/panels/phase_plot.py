"""The phase plane (ξ₁, ξ₂) of both robots, live: the current states and their recent paths."""

from __future__ import annotations

from typing import Any

import numpy as np
import viser

from onpath.app.common.palette import OF_SIDE
from onpath.app.common.templates import render
from onpath.app.lab.snapshots.page_snapshot import PageSnapshot
from onpath.lessons.sides import displayed_names
from onpath.lessons.words import Words
from onpath.models.systems.law_parameters import LEVEL_SET

NAME = "phase"
WIDTH, HEIGHT = 300, 220  # [px]
LEAST = (1.0, 10.0)  # smallest ranges, [mm] and [mm/s]
STEPS = (1, 2, 5, 10)  # of the ranges, times a power of ten


class PhasePlot:
    """One picture, redrawn when the displayed time changes.

    Args:
    """

    def __init__(self, gui: viser.GuiApi, words: Words) -> None:
        self._words, self._shown = words, (-1.0, "")
        self._handle = gui.add_html(phase_picture(np.zeros((0, 2, 2)), {}, words))

    def follow(self, snapshot: PageSnapshot) -> None:
        """Draw the last seconds up to the displayed time."""
        level_set = snapshot.parameters["across"] == LEVEL_SET
        shown = snapshot.time, str(snapshot.laws)
        if shown == self._shown:
            return
        self._shown = shown
        names = displayed_names(snapshot.laws, self._words)
        content = phase_picture(snapshot.phase, names, self._words, level_set)
        self._handle.content = content

    def remove(self) -> None:
        """Remove the picture from the page."""
        self._handle.remove()


def phase_picture(
    phase: np.ndarray, names: dict[str, str], words: Words, level_set: bool = False
) -> str:
    """The phase plane as SVG.

    Args:
        phase: see `PageSnapshot.phase`.
        names: displayed name of each side.
        level_set: whether ξ₁ is an area, [m²], instead of a distance.
    """
    values = phase.astype(float) * (1e6 if level_set else 1e3)
    values = np.where(np.isfinite(values), values, 0.0)
    ranges = [
        _rounded(max(least, float(np.abs(values[..., i]).max(initial=0.0))))
        for i, least in enumerate(LEAST)
    ]
    middle = np.array([WIDTH, HEIGHT]) / 2
    scale = np.array([middle[0], -middle[1]]) / ranges
    places = middle + values * scale
    lines: list[dict[str, Any]] = [
        {
            "title": title,
            "colour": OF_SIDE[side],
            "width": 3 if i == 0 else 1.6,  # so that one line stays visible under the other
            "points": " ".join(f"{x:.1f},{y:.1f}" for x, y in places[:, i]),
            "now": places[-1, i].round(1).tolist() if len(places) else None,
        }
        for i, (side, title) in enumerate(names.items())
    ]
    unit = "-level_set" if level_set else ""
    return render(
        "panel/phase.html",
        size=(WIDTH, HEIGHT),
        ranges=[words.number(limit) for limit in ranges],
        axes=[words(f"axis.{name}{unit}") for name in ("across", "across_rate")],
        lines=lines,
        words=words,
    )


def _rounded(most: float) -> float:
    """The least of 1, 2 and 5 times a power of ten that is not below a value."""
    power = 10.0 ** np.floor(np.log10(most))
    return float(next(step * power for step in STEPS if step * power >= most * (1 - 1e-9)))
