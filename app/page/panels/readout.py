"""Current and maximum distance of each robot from the path, and what the lab has to say."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache, partial

import viser
from markupsafe import escape

from onpath.app.common.palette import OF_BENCH
from onpath.app.common.templates import render
from onpath.app.lab.snapshots.snapshot import Snapshot
from onpath.app.scene.captions import Captions, spoken
from onpath.app.viser_adapter.frame_channel import update_gui
from onpath.lessons.benches import bench_titles
from onpath.lessons.words import Words


class Readout:
    """Two lines of numbers, a clock, and the message and the words that are shown over the scene.

    Args:
        speaks: whether what happens is spoken by a screen reader.
    """

    def __init__(
        self, gui: viser.GuiApi, words: Words, speaks: Callable[[], bool] = lambda: True
    ) -> None:
        self._words, self._speaks = words, speaks
        self._captions = Captions(words)
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
        laws = tuple(snapshot.laws.items())
        level = snapshot.message_level if snapshot.message else ""
        running = snapshot.running and level != "stop"
        frame = self._frame(laws, level, running)
        time = f"{snapshot.time:.{1 if running else 2}f}"
        speed, message = f"{snapshot.achieved_speed:.2g}", escape(snapshot.message)
        said = escape(self._spoken(snapshot)) if self._speaks() else ""
        content = frame.format(*numbers, time=time, speed=speed, message=message, spoken=said)
        if content != self._shown:
            self._shown = content
            update_gui(self._table, "content", content)

    def _spoken(self, snapshot: Snapshot) -> str:
        """What a sighted user sees: the state of the lab, and what each robot is doing."""
        words, state = self._words, "held" if snapshot.held else "running"
        captions = spoken(
            self._captions.of(snapshot), bench_titles(snapshot.laws, words), words
        ) or words("spoken.on_path")
        return f"{words('spoken.' + (state if snapshot.running else 'paused'))} {captions}"


def _frame(words: Words, laws: tuple[tuple[str, str], ...], level: str, running: bool) -> str:
    """Template of the readout, with {} and {name} for the values updated at 10 Hz.

    Args:
        laws: benches and their control laws.
        level: severity of the message; empty without one.
        running: whether the clock runs.
    """
    titles = bench_titles(dict(laws), words)
    table = render(
        "panel/readout.html",
        rows=[(OF_BENCH[bench].hex, title) for bench, title in titles.items()],
        level=level,
        running=running,
        words=words,
    )
    clock = words(
        "readout.running" if running else "readout.paused", time="{time}", speed="{speed}"
    )
    return table.replace("{clock}", escape(clock))
