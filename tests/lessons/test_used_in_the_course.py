"""What the course asks of its predictions and identifications, and where it uses branches."""

from __future__ import annotations

import re
from collections.abc import Iterator

import pytest

from onpath.app.lab import commands as c
from onpath.app.lab.lab import Lab
from onpath.app.lab.snapshots.take_snapshot import take_page_snapshot
from onpath.app.view.lesson_view import LessonView
from onpath.lessons.minutes import word_count
from onpath.lessons.schema import Choice, Lesson, NumberQuestion, Quiz, Step, Text
from onpath.lessons.task_schema import Event, Order, Setting, Task
from onpath.models.systems.catalogue import FIVE_BAR
from tests.support.built_in import built_in_course
from tests.support.lab import do, loop_cache

COURSE, _ = built_in_course()
VERSIONS = [lesson for versions in COURSE.lessons.values() for lesson in versions.values()]


def steps() -> Iterator[tuple[Lesson, int, Step]]:
    """All steps of the course, in all languages."""
    for lesson in VERSIONS:
        for index, step in enumerate(lesson.steps):
            yield lesson, index, step


def test_every_prediction_asks_why() -> None:
    silent = [
        (lesson.name, lesson.language, step.title)
        for lesson, _, step in steps()
        for prediction in step.predictions()
        if not prediction.reasons and not prediction.why
    ]
    assert silent == []


def test_every_run_says_what_to_watch_and_not_what_happens() -> None:
    for lesson, _, step in steps():
        told = step.watch.striptags()
        assert bool(told) == (step.kind == "run"), (lesson.name, lesson.language, step.title)
        assert len(told.split()) < 40
        units = re.findall(r"\d (?:mm|N|mJ|%)", told)
        assert units == [], (lesson.name, lesson.language, step.title)


TOUCH = {
    "en": r"\b(?:Press|Pull|Drag|Set|Put|Move|Send|Take|Turn)\b",
    "de": r"\b(?:Drücke|Ziehe?|Stelle|Setze?|Bewege|Schicke|Nimm|Schalte)\b",
}
"""Words that tell a student to do something in the lab."""
OPENING = 60
"""Most words of a lesson before the first of them."""


@pytest.mark.parametrize("lesson", VERSIONS, ids=lambda each: f"{each.name} {each.language}")
def test_a_lesson_opens_with_a_thing_to_touch(lesson: Lesson) -> None:
    first = lesson.steps[0]
    text = " ".join(block.html for block in first.blocks if isinstance(block, Text))
    found = re.search(TOUCH[lesson.language], text)
    assert first.setup is not None and first.setup.controls
    assert found is not None and word_count(text[: found.start()]) <= OPENING


def test_the_right_options_are_neither_mostly_the_longest_nor_mostly_at_one_place() -> None:
    english = [step for lesson, _, step in steps() if lesson.language == "en"]
    asked = [b for step in english for b in step.blocks if isinstance(b, Choice | Quiz)]
    right = [next(i for i, o in enumerate(block.options) if o.right) for block in asked]
    longest = [
        len(block.options[i].text) == max(len(option.text) for option in block.options)
        for block, i in zip(asked, right, strict=True)
    ]
    assert sum(longest) < 0.4 * len(asked)
    assert max(right.count(place) for place in range(4)) < 0.5 * len(asked)


def after_numbers() -> list[tuple[Lesson, int, int]]:
    """Lesson, step and block of each text of the course that depends on a number above it."""
    return [
        (lesson, index, place)
        for lesson, index, step in steps()
        for place, block in enumerate(step.blocks)
        if isinstance(block, Text) and block.when
        if place and isinstance(step.blocks[place - 1], NumberQuestion)
    ]


def test_whoever_misses_the_border_is_led_to_the_arm() -> None:
    found = after_numbers()
    assert {lesson.name for lesson, _, _ in found} == {"04b-poles-and-gains"}
    assert {lesson.language for lesson, _, _ in found} == {"en", "de"}
    for lesson, index, place in found:
        text, asked = (lesson.steps[index].blocks[at] for at in (place, place - 1))
        assert isinstance(text, Text) and isinstance(asked, NumberQuestion)
        assert len(text.links) == 3
        lab = Lab(loop_cache(), FIVE_BAR, COURSE)
        do(lab, c.SetLanguage(lesson.language), c.TakeStep(lesson.name, index))
        assert not is_told(lab, place, text)
        for given, told in ((asked.number / 2, True), (asked.number, False)):
            do(lab, c.AnswerNumber(place - 1, given))
            assert is_told(lab, place, text) == told


def is_told(lab: Lab, place: int, text: Text) -> bool:
    """Whether the page of a lab shows a text of the open step."""
    view = LessonView(COURSE, lab.words, take_page_snapshot(lab, 1.0).lesson)
    return view.text(place, text) is not None


def task(name: str) -> Task:
    """A task of the course, by its id."""
    return next(t for lesson in VERSIONS for t in lesson.tasks() if t.id == name)


@pytest.mark.parametrize("name", ["excite", "excite-well"])
def test_a_number_that_is_put_right_by_hand_is_not_identified(name: str) -> None:
    wanted = task(name)
    (identified,) = [c for c in wanted.check if isinstance(c, Event) and c.event == "identify"]
    bounded = {c.name for c in wanted.check if isinstance(c, Setting) and c.equals is None}
    assert {f"set:{each}" for each in bounded | {"error_M11"}} <= set(identified.since)
    assert not any(isinstance(check, Order) for check in wanted.check)
