"""Current and maximum distance of each robot from the path, and the clock."""

from __future__ import annotations

from functools import lru_cache, partial

import viser
from markupsafe import escape

from onpath.app.common.palette import OF_SIDE
from onpath.app.common.templates import render
from onpath.app.lab.snapshots.snapshot import Snapshot
from onpath.app.viser_adapter.frame_channel import update_gui
from onpath.lessons.sides import side_titles
from onpath.lessons.words import Words


class Readout:
    """Two lines of numbers, and a clock."""

    def __init__(self, gui: viser.GuiApi, words: Words) -> None:
        self._words = words
        self._table = gui.add_html("")
        self._shown = ""
        self._frame = lru_cache(maxsize=8)(partial(_frame, self._words))

    def follow(self, snapshot: Snapshot) -> None:
        """Show the snapshot's numbers."""
        numbers = [
            f"{distance * 1e3:.1f}"
            for view in snapshot.robots.values()
            for distance in (view.distance, view.max_distance)
        ]
        running = snapshot.running and not (snapshot.message and snapshot.message_level == "stop")
        frame = self._frame(tuple(snapshot.laws.items()), running)
        time = f"{snapshot.time:.{1 if running else 2}f}"
        content = frame.format(*numbers, time=time, speed=f"{snapshot.achieved_speed:.2g}")
        if content != self._shown:
            self._shown = content
            update_gui(self._table, "content", content)


def _frame(words: Words, laws: tuple[tuple[str, str], ...], running: bool) -> str:
    """Template of the readout, with {} and {name} for the values updated at 10 Hz.

    Args:
        laws: sides and their control laws.
        running: whether the clock runs.
    """
    titles = side_titles(dict(laws), words)
    table = render(
        "panel/readout.html",
        rows=[(OF_SIDE[side].hex, title) for side, title in titles.items()],
        words=words,
    )
    clock = words(
        "readout.running" if running else "readout.paused", time="{time}", speed="{speed}"
    )
    return table.replace("{clock}", escape(clock))
