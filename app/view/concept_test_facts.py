"""A student's own answers to the concept test, shown once both tests are handed in."""

from __future__ import annotations

from dataclasses import dataclass

from onpath.app.lab.lesson_state import LessonState
from onpath.lessons.concept_test.concept_test import (
    AFTER,
    BEFORE,
    chosen_in,
    notes_of,
    questions,
    right_in,
)
from onpath.lessons.schema import Lesson, Quiz


@dataclass(frozen=True, slots=True)
class AnsweredQuestion:
    """A question and the options chosen before and after the course; None for no answer."""

    block: Quiz
    before: int | None
    after: int | None


@dataclass(frozen=True, slots=True)
class ConceptTestResults:
    """A student's results in the concept test.

    Attributes:
        scores: number of right answers before and after the course; None if not handed in.
        questions: empty until the test after the course has been handed in.
    """

    lesson: Lesson
    scores: tuple[int | None, int | None]
    questions: list[AnsweredQuestion]

    @property
    def count(self) -> int:
        """Number of questions."""
        return len(questions(self.lesson))


def results_of(run: LessonState) -> ConceptTestResults | None:
    """A student's results; None if the course has no test, or none has been handed in."""
    if not run.course.tests:
        return None
    lesson = run.course.lesson(BEFORE, run.progress.language)
    before, after = (notes_of(run.progress, name) for name in (BEFORE, AFTER))
    if before is None and after is None:
        return None
    blocks = list(questions(lesson).values())
    nothing: list[int | None] = [None] * len(blocks)
    chosen = [chosen_in(lesson, notes) if notes else nothing for notes in (before, after)]
    answered = [
        AnsweredQuestion(block, chosen_before, chosen_after)
        for block, chosen_before, chosen_after in zip(blocks, *chosen, strict=True)
    ]
    right = [sum(right_in(lesson, notes)) if notes else None for notes in (before, after)]
    return ConceptTestResults(lesson, (right[0], right[1]), answered if after else [])
