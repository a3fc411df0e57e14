"""Comparison of laws under one obstruction, computed in another process; table and picture grow."""

from __future__ import annotations

import base64
from collections.abc import Callable
from typing import Any

import viser

from onpath.app.common.templates import render
from onpath.app.exports.comparison import Results
from onpath.app.lab.snapshots.page_snapshot import PageSnapshot, robot_of
from onpath.app.page.panels.widgets import note, on_press
from onpath.lessons.sides import law_label, law_text, law_titles
from onpath.lessons.words import Words
from onpath.models.control.laws.own import is_text
from onpath.models.control.laws.registry import LAWS
from onpath.models.control.sides import SIDES
from onpath.models.studies.comparison import OBSTRUCTIONS, beyond_efforts, by_law, worst
from onpath.models.systems.robots import Robot

MOST = 6  # laws in one comparison
CHOSEN = ("trajectory_tracking", "path_following", "waiting_clock")  # at first
Ask = Callable[[list[str], str, Callable[[Results, bytes], None]], None]


class ComparePanel:
    """Choice of laws and obstruction, and the results.

    A law that is typed for a side can be chosen as long as that side has it.

    Args:
        ask: starts a comparison; takes the laws, the obstruction, and a function that is called
            with the results so far and their picture.
    """

    def __init__(self, gui: viser.GuiApi, words: Words, first: PageSnapshot, ask: Ask) -> None:
        self._words, self._ask = words, ask
        self._robot = robot_of(first)
        with gui.add_folder(words("compare.title"), expand_by_default=False):
            gui.add_markdown(words("compare.text"))
            self._laws = {
                name: gui.add_checkbox(
                    law_label(name, words), name in CHOSEN, hint=law_text(name, words)
                )
                for name, law in LAWS.items()
                if law.travels and law.suits(self._robot.system)
            }
            self._typed = {side: self._add_typed(gui, side, first.run.laws[side]) for side in SIDES}
            self._side_laws = first.run.laws
            self._obstructions = {words(f"obstruction.{name}"): name for name in OBSTRUCTIONS}
            self._obstruction = gui.add_dropdown(
                words("compare.obstruction"),
                list(self._obstructions),
                initial_value=words("obstruction.brake"),
            )
            start = gui.add_button(words("compare.run"), color="gray", icon=viser.Icon.SCALE)
            self._shown = gui.add_html("")
        on_press(start, self._start)

    def _add_typed(self, gui: viser.GuiApi, side: str, law: str) -> viser.GuiCheckboxHandle:
        hint, label = self._words("compare.own_hint"), self._words(f"laws.own_{side}")
        return gui.add_checkbox(label, False, visible=is_text(law), hint=hint)

    def follow(self, snapshot: PageSnapshot) -> None:
        """Offer the typed laws of the sides."""
        if snapshot.run.laws == self._side_laws:
            return
        self._side_laws = snapshot.run.laws
        for side, box in self._typed.items():
            box.visible = is_text(self._side_laws[side])

    def _chosen(self) -> list[str]:
        """The chosen laws; the same law typed for both sides counts once."""
        laws = [name for name, box in self._laws.items() if box.value]
        typed = [
            self._side_laws[side] for side, box in self._typed.items() if box.visible and box.value
        ]
        return [*laws, *dict.fromkeys(typed)]

    def _start(self) -> None:
        laws = self._chosen()
        if not 1 <= len(laws) <= MOST:
            self._shown.content = note(self._words("compare.count", most=MOST), small=True)
            return
        self._ask(laws, self._obstructions[self._obstruction.value], self._show)

    def _show(self, results: Results, picture: bytes) -> None:
        self._shown.content = comparison_html(results, picture, self._words, self._robot)


def comparison_html(results: Results, picture: bytes, words: Words, robot: Robot) -> str:
    """A table with a row for each law, what exceeds the motors of the robot's file, the picture."""
    rows: list[dict[str, Any]] = []
    titles = law_titles((law for law, _ in results), words)
    for (law, _), outcomes in results.items():
        values = worst(outcomes)
        cells = [
            words.written(f"{1000 * (values['max_distance_m'] or 0):.1f}"),
            words.written(f"{(values['delay_s'] or 0) + 0.0:.1f}"),
            f"{values['peak_force_N'] or 0:.0f}",
        ]
        stopped = values["stopped_at_s"] is not None
        rows.append(
            {
                "law": titles[law],
                "text": law if is_text(law) else "",
                "cells": [words("compare.stopped")] * len(cells) if stopped else cells,
                "stopped": stopped,
            }
        )
    image = base64.b64encode(picture).decode()
    found = {law: beyond_efforts(robot, each) for law, each in by_law(results).items()}
    beyond = [f"{titles[law]}: {words.sentence(each)}" for law, each in found.items() if each]
    return render("panel/comparison.html", rows=rows, beyond=beyond, image=image, words=words)
