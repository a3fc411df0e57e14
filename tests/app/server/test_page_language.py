"""A page that changes its language is told the new words before anything in that language."""

from __future__ import annotations

from collections.abc import Sequence
from threading import Event
from typing import Any, cast

import msgspec
from hypothesis import example, given, settings
from hypothesis import strategies as st

from onpath.app.lab.commands import SetLanguage, TakeStep
from onpath.app.lab.lab import Lab
from onpath.app.lab.snapshots.take_snapshot import take_motion, take_page_snapshot
from onpath.app.server.built_in_course import built_in_course
from onpath.app.server.first_projection import FirstProjection
from onpath.app.server.page_context import PageContext
from onpath.app.server.page_data import PageData
from onpath.app.server.page_text import PageText
from onpath.app.server.tab_visibility import TabVisibility
from onpath.app.viser_adapter.data_channel import Message, PageStream
from tests.support.lab import do, loop_cache

COURSE = built_in_course()
LESSON = next(iter(COURSE.lessons))
TITLES = {each: COURSE.lesson(LESSON, each).steps[0].title for each in ("en", "de")}

VIEW = FirstProjection(lambda work: work())  # at once


class SlowStream:
    """A page that reads what it was handed over when the test says so."""

    def __init__(self) -> None:
        self.is_open, self.opened, self.is_busy = True, 1, False
        self.told: list[dict[str, Any]] = []
        self._unsent: Sequence[Message] = ()

    def hand_over(self, *messages: Message) -> None:
        assert not self.is_busy
        self.is_busy, self._unsent = True, messages

    def read(self) -> None:
        self.told += [msgspec.json.decode(message()) for message in self._unsent]
        self.is_busy, self._unsent = False, ()


class Page:
    """A page in a step of a lesson, on a lab that stands still."""

    def __init__(self) -> None:
        self.lab, self.stream = Lab(loop_cache(), course=COURSE), SlowStream()
        do(self.lab, TakeStep(LESSON, 0))
        self.text = PageText(COURSE, "")
        context = PageContext("", COURSE, 0, print, self.text, print, print)
        stream = cast(PageStream, self.stream)
        self.data = PageData(stream, self.lab, context, TabVisibility())
        self.data._first_projection = VIEW
        self._snapshot = take_page_snapshot(self.lab, 1.0)

    def happen(self, event: str) -> None:
        """One event, and all work that it gave to the page's thread."""
        match event:
            case "tell":
                self._snapshot = take_page_snapshot(self.lab, 1.0, self._snapshot)
                self.data.tell(self._snapshot, None, self.lab.simulation.robot)
            case "frame":
                motion = take_motion(self.lab, self._snapshot)
                self.data.follow(self.lab, motion, is_turn=False, on_resize=lambda: None)
            case "read":
                self.stream.read()
            case language:
                do(self.lab, SetLanguage(language))
        done = Event()
        self.text.submit(done.set)
        assert done.wait(30)


EVENTS = ("tell", "tell", "frame", "frame", "read", "read", "en", "de")
UNDER_LOAD = ["frame", "tell", "de", "tell", "frame", "read", "frame", "read"]


def told(events: list[str]) -> list[str]:
    """Of what a page is told: the language of its words, and titles of steps."""
    page = Page()
    try:
        for event in events:
            page.happen(event)
    finally:
        page.data.close()
    found = {"words": lambda each: each["language"], "lesson": lambda each: each["sections"]["0"]}
    return [found[each["is"]](each) for each in page.stream.told if each["is"] in found]


@settings(max_examples=25, deadline=None)
@given(st.lists(st.sampled_from(EVENTS), max_size=25))
@example(UNDER_LOAD)
def test_no_step_comes_before_the_words_of_its_language(events: list[str]) -> None:
    language = ""
    for each in told(events):
        if each in TITLES:
            language = each
        else:
            assert TITLES[language] in each


def test_after_a_change_of_language_under_load_words_and_step_come() -> None:
    words, step = told([*UNDER_LOAD, "tell", "read", "frame", "read"])[-2:]
    assert words == "de" and TITLES["de"] in step
