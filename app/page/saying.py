"""What the lab has to say, for assets/page: messages, the live region, a summary, and sound."""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache, partial

import viser
from markupsafe import escape

from onpath.app.common.templates import render
from onpath.app.lab.snapshots.page_snapshot import PageSnapshot
from onpath.app.lab.snapshots.snapshot import Snapshot
from onpath.app.page.panels.widgets import label_of
from onpath.app.scene.captions import Captions, spoken
from onpath.app.viser_adapter.frame_channel import update_gui
from onpath.lessons.benches import bench_titles
from onpath.lessons.words import Words
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.parameters import specs

MOST = 2
"""Settings that are named on a button."""


class Saying:
    """An element that is not seen; its attributes are what the page's scripts show, say and play.

    It stands outside of all tabs, because viser does not update what is in a tab that is not shown.

    Args:
        wanted: the browser's `Preferences`.
    """

    def __init__(
        self,
        gui: viser.GuiApi,
        words: Words,
        wanted: Mapping[str, bool],
    ) -> None:
        self._words, self._wanted = words, wanted
        self._captions = Captions(words)
        self._handle = gui.add_html("")
        self._shown = ""
        self._asked, self._summaries, self._summary = False, 0, ""
        self._frame = lru_cache(maxsize=16)(partial(_frame, words))

    def ask_summary(self) -> None:
        """Have what is on the screen told at the next update. Thread-safe."""
        self._asked = True

    def follow(self, snapshot: Snapshot) -> None:
        """Say what a snapshot says; sends nothing if that has been said."""
        level = snapshot.message_level if snapshot.message else ""
        running = snapshot.running and level != "stop"
        captions = self._captions.of(snapshot)
        if self._asked and isinstance(snapshot, PageSnapshot):
            self._asked, self._summaries = False, self._summaries + 1
            self._summary = summary(snapshot, captions, self._words)
        distances = [1e3 * view.distance for view in snapshot.robots.values()]
        said = _spoken(snapshot, captions, self._words) if self._wanted["speaks"] else ""
        stopped = bool(snapshot.stopped) and level == "error"
        plays = isinstance(snapshot, PageSnapshot) and snapshot.lesson.playing
        remedy = _earlier_settings(snapshot, self._words) if stopped or level == "replay" else ""
        content = self._frame(level, running, snapshot.held, stopped, plays).format(
            message=escape(snapshot.message),
            spoken=escape(said),
            summary=escape(self._summary),
            earlier=escape(remedy),
            number=self._summaries,
            tones=" ".join(f"{each:.1f}" for each in distances) if self._wanted["sounds"] else "",
        )
        if content != self._shown:
            self._shown = content
            update_gui(self._handle, "content", content)


def _frame(words: Words, level: str, running: bool, held: bool, stopped: bool, plays: bool) -> str:
    """Template of the element, with {name} for what changes often.

    Args:
        level: severity of the message; empty without one.
        running: whether the clock runs.
        held: whether Hold is on.
        stopped: whether the message says why a robot has stopped.
        plays: whether a lesson is showing something, which a replay would interrupt.
    """
    shown = {"level": level, "running": running, "held": held, "stopped": stopped}
    return render("panel/saying.html", **shown, plays=plays, words=words)


def _spoken(snapshot: Snapshot, captions: dict[str, str], words: Words) -> str:
    """What a sighted user sees: the state of the lab, and what each robot is doing."""
    state = "held" if snapshot.held else "running"
    said = spoken(captions, bench_titles(snapshot.laws, words), words) or words("spoken.on_path")
    return f"{words('spoken.' + (state if snapshot.running else 'paused'))} {said}"


def _earlier_settings(snapshot: Snapshot, words: Words) -> str:
    """Label of the button that goes back to the settings that did well; empty if there is none."""
    if not snapshot.remedy:
        return ""
    known = specs(ROBOTS[snapshot.key.robot].parameters)
    changes = [
        f"{label_of(words, name, known[name])} = {_written(value)}"
        for name, value in list(snapshot.remedy.items())[:MOST]
    ]
    return words("breakdown.earlier", changes=", ".join(changes))


def _written(value: float | int | str) -> str:
    return f"{value:g}" if isinstance(value, float) else str(value)


def summary(snapshot: PageSnapshot, captions: dict[str, str], words: Words) -> str:
    """What is on the screen, for whoever does not see it: clock, path, and each robot."""
    path = words.get(f"path.{snapshot.edit.name}", snapshot.edit.name)
    said = [
        _spoken(snapshot, captions, words),
        words("summary.clock", time=f"{snapshot.time:.1f}", path=path),
    ]
    for bench, title in bench_titles(snapshot.laws, words).items():
        view = snapshot.robots[bench]
        numbers = {
            "now": f"{1e3 * view.distance:.1f}",
            "most": f"{1e3 * view.max_distance:.1f}",
            "speed": f"{1e3 * view.speed:.0f}",
        }
        said.append(words("summary.robot", robot=title, **numbers))
    return " ".join(said)
