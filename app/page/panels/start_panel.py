"""The start of the next run: numbers, and a start in the scene that can be dragged."""

from __future__ import annotations

import math
from dataclasses import asdict
from functools import partial

import viser

from onpath.app.lab import commands as c
from onpath.app.lab.snapshots.page_snapshot import PageSnapshot
from onpath.app.page.panels.widgets import LabValue, Post, add_buttons, on_user_update, put_number
from onpath.lessons.words import Words
from onpath.models.closed_loop.start import BOUNDS

UNITS = {
    "theta": math.radians(1.0),
    "beside": 1e-3,
    "along": 1e-3,
    "across": 1e-3,
    "clock_offset": math.radians(1.0),
}
"""Units of the numbers on the page, in SI: degrees, mm and mm/s."""
STEPS = {"theta": 5.0, "beside": 1.0, "along": 10.0, "across": 10.0, "clock_offset": 5.0}


class StartPanel:
    """A folder for the start of the next run.

    Args:
        switches: whether the scene shows the start.
    """

    def __init__(
        self,
        gui: viser.GuiApi,
        words: Words,
        post: Post,
        first: PageSnapshot,
        switches: set[str],
    ) -> None:
        self._start = LabValue(post)
        with gui.add_folder(words("start.title"), expand_by_default=False):
            seen = gui.add_checkbox(
                words("start.show"), "start" in switches, hint=words("start.show_hint")
            )
            self._numbers = {name: self._add(gui, words, name) for name in UNITS}
            commands = {words("start.reset"): c.Reset(), words("start.default"): c.StartOnPath()}
            add_buttons(gui, "", commands, post)
        on_user_update(seen, lambda on: (switches.add if on else switches.discard)("start"))
        for name, handle in self._numbers.items():
            on_user_update(handle, partial(self._change, name))
        self.follow(first)

    @staticmethod
    def _add(gui: viser.GuiApi, words: Words, name: str) -> viser.GuiInputHandle[float]:
        most = round(BOUNDS[name] / UNITS[name], 3)
        return gui.add_number(
            words(f"start.{name}"),
            0.0,
            min=-most,
            max=most,
            step=STEPS[name],
            hint=words(f"start.{name}_hint"),
        )

    def _change(self, name: str, value: float) -> None:
        most = BOUNDS[name]
        self._start.change(c.Set(f"start_{name}", min(max(value * UNITS[name], -most), most)))

    def follow(self, snapshot: PageSnapshot) -> None:
        """Show the lab's start."""
        start = snapshot.settings.start
        if self._start.is_new(start):
            for name, value in asdict(start).items():
                put_number(self._numbers[name], value / UNITS[name])
