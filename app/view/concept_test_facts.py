"""A student's own answers to the concept test, shown once both tests are handed in."""

from __future__ import annotations

from dataclasses import dataclass

from onpath.app.lab.lesson_state import LessonState
from onpath.lessons.concept_test.concept_test import (
    SITTINGS,
    chosen_in,
    handed_in,
    questions,
    right_in,
)
from onpath.lessons.schema import Quiz


@dataclass(frozen=True, slots=True)
class AnsweredQuestion:
    """A question, and the option chosen each time that it was asked; None for no answer.

    Attributes:
        chosen: before the course or after it (an index of `SITTINGS`) -> index of the option.
        treated: number of the lesson and of its step that treat it; None if that is not said.
    """

    block: Quiz
    chosen: dict[int, int | None]
    treated: tuple[str, int] | None


@dataclass(frozen=True, slots=True)
class ConceptTestResults:
    """A student's results in the concept test.

    Attributes:
        title: of the test.
        scores: number of right answers before and after the course; None if not handed in.
        count: number of questions in each.
        questions: empty until the test after the course has been handed in.
    """

    title: str
    scores: tuple[int | None, int | None]
    count: int
    questions: list[AnsweredQuestion]


def results_of(run: LessonState) -> ConceptTestResults | None:
    """A student's results; None if the course has no test, or none has been handed in."""
    forms = run.course.forms(run.progress.language)
    found = [handed_in(run.progress, sitting) for sitting in SITTINGS]
    sat = [None if each is None or each[0] >= len(forms) else each for each in found]
    if sat == [None, None]:
        return None
    scores = [sum(right_in(forms[each[0]], each[1])) if each else None for each in sat]
    numbers, answered = run.course.numbers(), list[AnsweredQuestion]()
    chosen = {
        when: (each[0], chosen_in(forms[each[0]], each[1]))
        for when, each in enumerate(sat)
        if each is not None
    }
    asked = [list(questions(form).values()) for form in forms]
    for index in range(len(asked[0])):
        for form in dict.fromkeys(form for form, _ in chosen.values()):
            block = asked[form][index]
            page = block.treated
            times = {when: options[index] for when, (f, options) in chosen.items() if f == form}
            treated = (numbers.get(page.lesson, ""), page.step) if page else None
            answered.append(AnsweredQuestion(block, times, treated))
    return ConceptTestResults(
        title=forms[0].front.title,
        scores=(scores[0], scores[1]),
        count=len(asked[0]),
        questions=answered if sat[1] else [],
    )
