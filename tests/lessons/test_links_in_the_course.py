"""What the course's texts lead to exists: lessons that they name, and what their links set."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from onpath.app.lab import commands as c
from onpath.app.lab.lab import Lab
from onpath.lessons.schema import Text
from onpath.models.control.settable import value_of
from tests.support.built_in import built_in_course
from tests.support.checkout import ROOT
from tests.support.lab import do, loop_cache

COURSE, _ = built_in_course()
FOLDER = ROOT / "lessons" / "course"
PLACE = r"\d{1,2}[a-z]?\b"
NAMED = re.compile(
    rf"\b(?:[Ll]essons?|Lektion(?:en)?) ({PLACE}(?:(?:, | and | und | to | bis ){PLACE})*)"
)
NUMBERS = {name.partition("-")[0].removeprefix("0") for name in COURSE.lessons}


def named(file: Path) -> list[str]:
    """The numbers of the lessons that a file names, in its order."""
    lists = [match[1] for match in NAMED.finditer(file.read_text(encoding="utf-8"))]
    return [number for each in lists for number in re.findall(PLACE, each)]


@pytest.mark.parametrize("folder", sorted(p.parent.name for p in FOLDER.glob("*/en.md")))
def test_every_lesson_that_a_text_names_exists_and_is_the_same_in_each_language(
    folder: str,
) -> None:
    english, german = (named(FOLDER / folder / f"{language}.md") for language in ("en", "de"))
    assert english == german
    assert {*english} <= NUMBERS


AFTER = [
    (name, index)
    for name in COURSE.lessons
    for index, step in enumerate(COURSE.lesson(name, "en").steps)
    if any(isinstance(block, Text) and block.when and block.links for block in step.blocks)
]
"""Lesson and step of each text with links that is shown after some answers only."""


@pytest.mark.parametrize(("name", "index"), AFTER)
def test_a_link_in_a_text_for_some_answers_acts(name: str, index: int) -> None:
    before, step = COURSE.lesson(name, "en").steps[index - 1 : index + 1]
    texts = [block for block in step.blocks if isinstance(block, Text) and block.when]
    lab = Lab(loop_cache(), course=COURSE)
    if before.predictions():
        do(lab, c.TakeStep(name, index - 1), c.Predict())
    do(lab, c.TakeStep(name, index))
    for link in (link for text in texts for link in text.links):
        do(lab, c.Act(link.actions))
        assert lab.message_level != "warning", lab.message
        for action in link.actions:
            for parameter, value in (action.set or {}).items():
                assert value_of(lab.simulation.parameters, parameter) == value
            if action.hold is not None:
                assert bool(lab.simulation.forces.held) == action.hold
