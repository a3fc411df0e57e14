"""What the page's script reads aloud is renewed when it is another sentence, and once a second."""

from __future__ import annotations

import re
from dataclasses import replace
from itertools import pairwise

from onpath.app.lab import commands as c
from onpath.app.lab.lab import Lab
from onpath.app.lab.snapshots.take_snapshot import take_page_snapshot
from onpath.app.view.captions import Captions
from onpath.app.view.narration import RENEWED, Narration
from onpath.app.view.preferences import DEFAULTS
from onpath.lessons.words import ENGLISH
from tests.support.built_in import built_in_course
from tests.support.lab import do, loop_cache, new_lab, run


class Heard:
    """The sentences that a page has had to speak, and since when, [s]."""

    def __init__(self, lab: Lab) -> None:
        self.sentences = list[tuple[float, str]]()
        self._lab, self._captions = lab, Captions(ENGLISH)
        self._narration = Narration(ENGLISH, DEFAULTS, self._captions)

    def follow(self, seconds: float = 0.0) -> None:
        """Show the lab ten times a second."""
        for _ in range(max(1, round(10 * seconds))):
            run(self._lab, 0.1 if seconds else 0.0)
            snapshot = take_page_snapshot(self._lab, 1.0)
            self._captions.follow(snapshot)
            self._narration.follow(snapshot)
            voice = self._narration.said.voice
            if not self.sentences or voice != self.sentences[-1][1]:
                self.sentences.append((self._lab.simulation.time, voice))


def test_numbers_are_renewed_once_a_second_and_another_sentence_at_once() -> None:
    lab = new_lab(1.0)
    said = Heard(lab)
    do(lab, c.Hold(True))
    said.follow(0.3)
    assert said.sentences[-1][1].startswith("Held back.")
    for _ in range(2):
        do(lab, c.Hold(False))
        said.follow(0.1)
        assert said.sentences[-1][1].startswith("Running.")
        do(lab, c.Hold(True))
        said.follow(4.0)
    sentences = [(time, re.sub(r"\d+", "", text)) for time, text in said.sentences]
    alike = [later - time for (time, text), (later, other) in pairwise(sentences) if text == other]
    assert len(alike) >= 2 and min(alike) > RENEWED - 1e-9
    do(lab, c.SetRunning(False))
    said.follow()
    assert said.sentences[-1][1].startswith("Paused.")


def test_in_a_lesson_a_stop_does_not_offer_settings() -> None:
    """Settings that went well may be the answer to the lesson's task."""
    lab, label = Lab(loop_cache(), course=built_in_course()[0]), "Reset with K1 across = 300"
    for opened in ("", "07-flexible-link"):
        if opened:
            do(lab, c.OpenLesson(opened))
        snapshot = take_page_snapshot(lab, 1.0)
        stopped = replace(
            snapshot,
            message="stopped",
            message_level="error",
            stopped=("right",),
            remedy={"K1": 300.0},
        )
        made = Narration(ENGLISH, DEFAULTS, Captions(ENGLISH))
        made.follow(stopped)
        assert made.said.stopped
        assert made.said.earlier == ("" if opened else label)
