"""The laws under one obstruction, computed in another process; table and picture grow."""

from __future__ import annotations

import base64
from collections.abc import Callable
from typing import Any

import viser

from onpath.app.common.templates import render
from onpath.app.exports.comparison import Results
from onpath.app.lab.snapshots.page_snapshot import PageSnapshot, robot_of
from onpath.app.page.panels.widgets import on_press
from onpath.lessons.benches import law_label, law_text
from onpath.lessons.words import Words
from onpath.models.control.laws.registry import LAWS
from onpath.models.studies.comparison import OBSTRUCTIONS, worst

MOST = 6  # laws in one comparison
CHOSEN = ("trajectory_tracking", "path_following", "waiting_clock")  # at first
Ask = Callable[[list[str], str, Callable[[Results, bytes], None]], None]


class ComparePanel:
    """Choice of laws and obstruction, and what they lead to.

    Args:
        ask: starts a comparison: laws, obstruction, and what is called with the results so far and
            their picture.
    """

    def __init__(self, gui: viser.GuiApi, words: Words, first: PageSnapshot, ask: Ask) -> None:
        self._words, self._ask = words, ask
        system = robot_of(first).system
        with gui.add_folder(words("compare.title"), expand_by_default=False):
            gui.add_markdown(words("compare.text"))
            self._laws = {
                name: gui.add_checkbox(
                    law_label(name, words), name in CHOSEN, hint=law_text(name, words)
                )
                for name, law in LAWS.items()
                if law.travels and law.suits(system)
            }
            self._obstructions = {words(f"obstruction.{name}"): name for name in OBSTRUCTIONS}
            self._obstruction = gui.add_dropdown(
                words("compare.obstruction"),
                list(self._obstructions),
                initial_value=words("obstruction.brake"),
            )
            start = gui.add_button(words("compare.run"), icon=viser.Icon.SCALE)
            self._shown = gui.add_html("")
        on_press(start, self._start)

    def _box(self, gui: viser.GuiApi, law: str) -> viser.GuiCheckboxHandle:
        label, hint = law_label(law, self._words), law_text(law, self._words)
        return gui.add_checkbox(label, law in CHOSEN, hint=hint)

    def _start(self) -> None:
        laws = [name for name, box in self._laws.items() if box.value]
        if not 1 <= len(laws) <= MOST:
            self._shown.content = render(
                "panel/note.html", said=self._words("compare.count", most=MOST), small=True
            )
            return
        self._ask(laws, self._obstructions[self._obstruction.value], self._show)

    def _show(self, results: Results, picture: bytes) -> None:
        self._shown.content = comparison_html(results, picture, self._words)


def comparison_html(results: Results, picture: bytes, words: Words) -> str:
    """A table with a row for each law, and the picture."""
    rows: list[dict[str, Any]] = []
    for (law, _), outcomes in results.items():
        values = worst(outcomes)
        rows.append(
            {
                "law": law_label(law, words),
                "distance": f"{1000 * (values['max_distance_m'] or 0):.1f}",
                "delay": f"{(values['delay_s'] or 0) + 0.0:.1f}",
                "force": f"{values['peak_force_N'] or 0:.0f}",
                "stopped": values["diverged_at_s"] is not None,
            }
        )
    image = base64.b64encode(picture).decode()
    return render("panel/comparison.html", rows=rows, image=image, words=words)
