"""Where the class is: how many students are in each step of a lesson, without names, as HTML."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from onpath.app.common.templates import render
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


def whereabouts(lesson: Lesson, ways: Iterable[Progress]) -> Whereabouts:
    """Where students are, as seen from a lesson."""
    steps, ended, elsewhere = [0] * len(lesson.steps), 0, 0
    for way in ways:
        if way.lesson != lesson.name:
            elsewhere += 1
        elif way.ended:
            ended += 1
        else:
            index = way.notes.get(lesson.name, Notes()).step
            steps[min(index, len(steps) - 1)] += 1
    return Whereabouts(tuple(steps), ended, elsewhere)


def pace_view(
    lesson: Lesson, ways: Iterable[Progress], pace: Pace | None, words: Words, large: bool = False
) -> str:
    """A bar for each step, and which steps the class may go to.

    Args:
        large: for a projector; titles, which may tell what happens, are left out.
    """
    found = whereabouts(lesson, ways)
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
