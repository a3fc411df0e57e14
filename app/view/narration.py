"""What a page says: spoken text, summary, remedies, sound and invitations."""

from __future__ import annotations

import re
from collections.abc import Mapping

from onpath.app.channel.state_messages import Said
from onpath.app.lab.snapshots.page_snapshot import PageSnapshot
from onpath.app.lab.snapshots.snapshot import Snapshot
from onpath.app.view.captions import Captions, spoken
from onpath.app.view.first_minute import FirstMinute
from onpath.lessons.labels import parameter_label, path_label, value_label
from onpath.lessons.sides import displayed_names
from onpath.lessons.words import Words
from onpath.models.control.settable import specs
from onpath.models.systems.catalogue import ROBOTS

MOST = 2
"""Most settings that a button names."""
RENEWED = 1.0
"""Time between updates of spoken numbers [s]; assets/web/parts/voice.ts reads fewer aloud."""


class Narration:
    """Collects what a page says; assets/web/parts/voice.ts shows, speaks and plays it.

    Args:
        preferences: the browser's `Preferences`.
        captions: of the robots, which are updated with each snapshot first.
        first_minute: what invites newcomers, if anything; it is updated first, too.

    Attributes:
        said: for the latest snapshot.
    """

    def __init__(
        self,
        words: Words,
        preferences: Mapping[str, bool],
        captions: Captions,
        first_minute: FirstMinute | None = None,
    ) -> None:
        self._words, self._preferences, self._captions = words, preferences, captions
        self._first_minute = first_minute
        self._asked, self._summaries, self._summary = False, 0, ""
        self._spoken, self._spoken_at = "", 0.0
        self.said = Said()

    def ask_summary(self) -> None:
        """Announce a description of the screen at the next update. Thread-safe."""
        self._asked = True

    def follow(self, snapshot: PageSnapshot) -> None:
        """Update `said` from a snapshot."""
        level = snapshot.message_level if snapshot.message else ""
        captions = self._captions.shown
        if self._asked:
            self._asked, self._summaries = False, self._summaries + 1
            self._summary = summary(snapshot, captions, self._words)
        stopped = bool(snapshot.stopped) and level == "error"
        shows_remedy = (stopped or level == "replay") and not _in_lesson(snapshot)
        first_minute = self._first_minute
        invitation = None if first_minute is None else first_minute.shown
        self._captions.brief = first_minute is not None and not first_minute.is_over
        self.said = Said(
            voice=self._voice(snapshot, captions) if self._preferences["speaks"] else "",
            summary=self._summary,
            summaries=self._summaries,
            stopped=stopped,
            replays=stopped and not snapshot.lesson.playing,
            earlier=_earlier_settings(snapshot, self._words) if shows_remedy else "",
            sounds=self._preferences["sounds"],
            invitation="" if invitation is None else invitation.name,
            act=None if invitation is None else invitation.act,
        )

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


def _spoken(snapshot: Snapshot, captions: dict[str, str], words: Words) -> str:
    """What a sighted user sees: the state of the lab, and what each robot is doing."""
    state = "held" if snapshot.held else "running"
    names = displayed_names(snapshot.laws, words)
    robots = spoken(captions, names, words) or words("spoken.on_path")
    return f"{words('spoken.' + (state if snapshot.running else 'paused'))} {robots}"


def _in_lesson(snapshot: PageSnapshot) -> bool:
    """Whether a lesson is open; good settings may be the answer to one of its tasks."""
    return bool(snapshot.lesson.progress.lesson)


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
    for side, title in displayed_names(snapshot.laws, words).items():
        robot = snapshot.robots[side]
        sentences.append(
            words(
                "summary.robot",
                robot=title,
                now=f"{1e3 * robot.distance:.1f}",
                most=f"{1e3 * robot.max_distance:.1f}",
                speed=f"{1e3 * robot.speed:.0f}",
            )
        )
    return " ".join(sentences)
