"""What is read before a lesson gives no answer away; what is read after it is complete."""

from __future__ import annotations

import re

import pytest

from onpath.lessons.schema import Choice, Lesson, Quiz
from onpath.lessons.words import languages
from tests.support.built_in import built_in_course

COURSE, PROBLEMS = built_in_course()
EACH = pytest.mark.parametrize(
    "lesson",
    [COURSE.lesson(name, language) for name in COURSE.lessons for language in languages()],
    ids=lambda lesson: f"{lesson.name}-{lesson.language}",
)
RUN = 4
"""So many words in a row are the same statement."""


def runs_of_words(text: str) -> set[tuple[str, ...]]:
    """Every few words in a row of a text, in lower case, without its markup."""
    words = re.findall(r"\w+", re.sub(r"<[^>]*>", " ", text).lower())
    return {tuple(words[i : i + RUN]) for i in range(len(words) - RUN + 1)}


def answers(lesson: Lesson) -> list[str]:
    """All right options and explanations, and what the lesson wants to be remembered."""
    asked = [b for step in lesson.steps for b in step.blocks if isinstance(b, Choice | Quiz)]
    options = [option for block in asked for option in block.options]
    told = [option.answer for option in options] + [o.text for o in options if o.right]
    return [*told, *lesson.front.takeaway]


@EACH
def test_a_summary_gives_no_answer_away(lesson: Lesson) -> None:
    assert PROBLEMS == []
    told = set[tuple[str, ...]]().union(*map(runs_of_words, answers(lesson)))
    assert runs_of_words(lesson.front.summary) & told == set()


@EACH
def test_every_lesson_says_what_to_take_away(lesson: Lesson) -> None:
    assert 2 <= len(lesson.front.takeaway) <= 5
    assert all(len(point) > 40 for point in lesson.front.takeaway)
