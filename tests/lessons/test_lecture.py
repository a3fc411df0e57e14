"""The lecture: slides like a lesson's steps, with notes."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from onpath.app.server.built_in_course import built_in_course
from onpath.lessons.course import read_course, read_versions
from onpath.lessons.lecture import LECTURE
from tests.support.lesson_texts import write_lesson

MINUTES = re.compile(r"<em>(\d+) (?:minutes?|Minuten?)\.</em>")
SLIDES = """\
+++
title = "A"
summary = "B"
+++

# explain: One

Text.

```notes
Ask *them*.
```
"""


@pytest.mark.parametrize("language", ["en", "de"])
def test_the_notes_of_all_slides_add_up_to_twenty_minutes(language: str) -> None:
    slides = built_in_course().lecture[language].steps
    assert sum(int(MINUTES.findall(step.notes)[0]) for step in slides) == 20


def test_a_lecture_needs_no_step_of_a_kind_and_is_no_lesson(tmp_path: Path) -> None:
    write_lesson(tmp_path, name="01-good")
    lecture = tmp_path / LECTURE
    lecture.mkdir()
    (lecture / "en.md").write_text(SLIDES, "utf-8")
    course, problems = read_course([tmp_path])
    assert [each.text for each in problems if LECTURE in each.path] == ["there must be one"]
    (lecture / "reference.toml").write_text("", "utf-8")
    course, problems = read_course([tmp_path])
    assert LECTURE not in course.lessons and LECTURE in course.played
    assert course.lesson(LECTURE, "de").steps[0].notes == "<p>Ask <em>them</em>.</p>\n"
    assert not [each for each in problems if LECTURE in each.path]


@pytest.mark.parametrize("more", ["```notes\nAgain.\n```\n", "# explain: Two\n\n```notes\n```\n"])
def test_a_slide_has_one_block_of_notes_with_words(more: str, tmp_path: Path) -> None:
    home = tmp_path / LECTURE
    home.mkdir()
    (home / "en.md").write_text(SLIDES + more, "utf-8")
    (home / "reference.toml").write_text("", "utf-8")
    assert "one block of notes" in read_versions(home)[1][0].text
