"""The lab's messages, spoken text, summary and sound, as attributes for assets/page."""

from __future__ import annotations

import re
from collections.abc import Mapping
from functools import lru_cache, partial

import viser
from markupsafe import escape

from onpath.app.common.templates import render
from onpath.app.lab.snapshots.page_snapshot import PageSnapshot
from onpath.app.lab.snapshots.snapshot import Snapshot
from onpath.app.scene.captions import Captions, spoken
from onpath.app.viser_adapter.frame_channel import update_gui
from onpath.lessons.labels import parameter_label, path_label, value_label
from onpath.lessons.sides import side_titles
from onpath.lessons.words import Words
from onpath.models.control.settable import specs
from onpath.models.systems.catalogue import ROBOTS

MOST = 2
"""Most settings that a button names."""
RENEWED = 1.0
"""Time between updates of spoken numbers [s]; assets/page/narration.js reads fewer aloud."""


class Narration:
    """An invisible element whose attributes the page's scripts show, speak and play.

    It stands outside all tabs, because viser does not update the contents of a hidden tab.

    Args:
        preferences: the browser's `Preferences`.
        captions: of the scene, which is updated with each snapshot first.
    """

    def __init__(
        self,
        gui: viser.GuiApi,
        words: Words,
        preferences: Mapping[str, bool],
        captions: Captions,
    ) -> None:
        self._words, self._preferences = words, preferences
        self._captions = captions
        self._handle = gui.add_html("")
        self._shown: tuple[object, ...] = ()
        self._asked, self._summaries, self._summary = False, 0, ""
        self._spoken, self._spoken_at = "", 0.0
        self._frame = lru_cache(maxsize=16)(partial(_frame, words))

    def ask_summary(self) -> None:
        """Announce a description of the screen at the next update. Thread-safe."""
        self._asked = True

    def follow(self, snapshot: Snapshot) -> None:
        """Update the attributes; sends nothing if they are unchanged."""
        level = snapshot.message_level if snapshot.message else ""
        running = snapshot.running and level != "stop"
        captions = self._captions.shown
        if self._asked and isinstance(snapshot, PageSnapshot):
            self._asked, self._summaries = False, self._summaries + 1
            self._summary = summary(snapshot, captions, self._words)
        stopped = bool(snapshot.stopped) and level == "error"
        plays = isinstance(snapshot, PageSnapshot) and snapshot.lesson.playing
        frame = self._frame(level, running, snapshot.held, stopped, plays)
        shows_remedy = (stopped or level == "replay") and not _in_lesson(snapshot)
        remedy = _earlier_settings(snapshot, self._words) if shows_remedy else ""
        voice = self._voice(snapshot, captions) if self._preferences["speaks"] else ""
        tones = _tones(snapshot) if self._preferences["sounds"] else ""
        shown = frame, snapshot.message, voice, tones, remedy
        if (*shown, self._summaries) == self._shown:
            return
        self._shown = *shown, self._summaries
        content = frame.format(
            message=escape(snapshot.message),
            spoken=escape(voice),
            summary=escape(self._summary),
            earlier=escape(remedy),
            number=self._summaries,
            tones=tones,
        )
        update_gui(self._handle, "content", content)

    def _voice(self, snapshot: Snapshot, captions: dict[str, str]) -> str:
        """The text to be spoken. If only its numbers change, it is renewed once in `RENEWED`."""
        text, elapsed = _spoken(snapshot, captions, self._words), snapshot.time - self._spoken_at
        if text != self._spoken and (
            abs(elapsed) >= RENEWED or _without_numbers(text) != _without_numbers(self._spoken)
        ):
            self._spoken, self._spoken_at = text, snapshot.time
        return self._spoken


def _without_numbers(text: str) -> str:
    return re.sub(r"\d+", "", text)


def _frame(words: Words, level: str, running: bool, held: bool, stopped: bool, plays: bool) -> str:
    """Template of the element, with {name} for the values that change often.

    Args:
        level: severity of the message; empty without one.
        running: whether the clock runs.
        held: whether Hold is on.
        stopped: whether the message says why a robot has stopped.
        plays: whether a lesson is running an experiment, which a replay would interrupt.
    """
    return render(
        "panel/narration.html",
        level=level,
        running=running,
        held=held,
        stopped=stopped,
        plays=plays,
        words=words,
    )


def _tones(snapshot: Snapshot) -> str:
    """The distances of all robots from the path, [mm]."""
    return " ".join(f"{1e3 * view.distance:.1f}" for view in snapshot.robots.values())


def _spoken(snapshot: Snapshot, captions: dict[str, str], words: Words) -> str:
    """What a sighted user sees: the state of the lab, and what each robot is doing."""
    state = "held" if snapshot.held else "running"
    robots = spoken(captions, side_titles(snapshot.laws, words), words) or words("spoken.on_path")
    return f"{words('spoken.' + (state if snapshot.running else 'paused'))} {robots}"


def _in_lesson(snapshot: Snapshot) -> bool:
    """Whether a lesson is open; good settings may be the answer to one of its tasks."""
    return isinstance(snapshot, PageSnapshot) and bool(snapshot.lesson.progress.lesson)


def _earlier_settings(snapshot: Snapshot, words: Words) -> str:
    """Label of the button that restores the last good settings; empty if there are none."""
    if not snapshot.remedy:
        return ""
    known = specs(ROBOTS[snapshot.key.robot].parameters)
    changes = [
        f"{parameter_label(name, known[name], words)} = {value_label(name, value, words)}"
        for name, value in list(snapshot.remedy.items())[:MOST]
    ]
    return words("breakdown.earlier", changes=", ".join(changes))


def summary(snapshot: PageSnapshot, captions: dict[str, str], words: Words) -> str:
    """A description of the screen for users who cannot see it: clock, path, and each robot."""
    path = path_label(snapshot.edit.name, words)
    sentences = [
        _spoken(snapshot, captions, words),
        words("summary.clock", time=f"{snapshot.time:.1f}", path=path),
    ]
    for side, title in side_titles(snapshot.laws, words).items():
        view = snapshot.robots[side]
        sentences.append(
            words(
                "summary.robot",
                robot=title,
                now=f"{1e3 * view.distance:.1f}",
                most=f"{1e3 * view.max_distance:.1f}",
                speed=f"{1e3 * view.speed:.0f}",
            )
        )
    return " ".join(sentences)
