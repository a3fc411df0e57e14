"""Where the class is: how many students are in each step of a lesson, without names, as HTML."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from onpath.app.common.templates import render
from onpath.lessons.concept_test.concept_test import sitting_of
from onpath.lessons.pace import Pace
from onpath.lessons.progress import Notes, Progress
from onpath.lessons.schema import Lesson
from onpath.lessons.words import Words


@dataclass(frozen=True, slots=True)
class Whereabouts:
    """Numbers of students.

    Attributes:
        steps: in each step of the lesson.
        ended: at its end.
        elsewhere: in another lesson, or in none.
    """

    steps: tuple[int, ...]
    ended: int
    elsewhere: int


def whereabouts(lesson: Lesson, students: Iterable[Progress]) -> Whereabouts:
    """How many students are in each step of a lesson, at its end, or elsewhere."""
    steps, ended, elsewhere = [0] * len(lesson.steps), 0, 0
    for progress in students:
        if sitting_of(progress.lesson) != lesson.name:
            elsewhere += 1
        elif progress.ended:
            ended += 1
        else:
            index = progress.notes.get(progress.lesson, Notes()).step
            steps[min(index, len(steps) - 1)] += 1
    return Whereabouts(tuple(steps), ended, elsewhere)


def pace_view(
    lesson: Lesson,
    students: Iterable[Progress],
    pace: Pace | None,
    words: Words,
    large: bool = False,
) -> str:
    """A bar for each step, and whether the class may go there.

    Args:
        large: for a projector; titles are left out, because they may give the result away.
    """
    found = whereabouts(lesson, students)
    titles = [
        f"{number} {words(f'kind.{step.kind}')}{'' if large else f': {step.title}'}"
        for number, step in enumerate(lesson.steps, start=1)
    ]
    open_ = [pace is None or pace.holds(lesson.name, i) for i in range(len(titles))]
    return render(
        "class/pace.html",
        rows=list(zip(titles, found.steps, open_, strict=True)),
        most=max(1, *found.steps),
        found=found,
        words=words,
        large=large,
    )
