"""Predictions and results of a class as numbers, for the projector."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from onpath.lessons.kept.option_keys import second_key
from onpath.lessons.progress import Answer, Notes, Progress, Truth
from onpath.lessons.schema import Choice, Lesson, Prediction


@dataclass(frozen=True, slots=True)
class Distribution:
    """The answers of a class to a prediction.

    Attributes:
        counts: number of answers per option; empty for a sketch.
        sketches: the sketched curves.
        skipped: number of students who skipped it.
        unknown: number of answers that cannot be recovered, since the lesson has changed.
        waiting: number of students who have not answered.
    """

    counts: tuple[int, ...]
    sketches: tuple[Answer, ...]
    skipped: int
    waiting: int
    unknown: int = 0


def prediction_at(lesson: Lesson, index: int) -> tuple[int, Prediction] | None:
    """The prediction that a step asks for or whose truth it shows, and the index of its step."""
    before = index - 1 if lesson.steps[index].kind == "run" else index
    for at in dict.fromkeys((index, before)):
        if at >= 0:
            for prediction in lesson.steps[at].predictions():
                return at, prediction
    return None


def distribution(
    prediction: Prediction,
    lesson: str,
    step: int,
    students: Sequence[Progress],
    again: bool = False,
) -> Distribution:
    """Count the answers of the class.

    Args:
        step: index of the step that asks for the prediction.
        students: progress of all students.
        again: whether to count the second answers, after a discussion, instead of the first ones.
    """
    notes, key = [_notes(each, lesson) for each in students], str(step)
    lost = sum((second_key(key) if again else key) in each.unknown for each in notes)
    answers = [(each.second if again else each.answers).get(key) for each in notes]
    given = [answer for answer in answers if answer is not None]
    options = range(len(prediction.options)) if isinstance(prediction, Choice) else ()
    return Distribution(
        counts=tuple(sum(answer.option == option for answer in given) for option in options),
        sketches=tuple(answer for answer in given if answer.times),
        skipped=sum(answer.skipped for answer in given) - lost,
        waiting=len(answers) - len(given),
        unknown=lost,
    )


def is_asked_again(lesson: str, step: int, students: Iterable[Progress]) -> bool:
    """Whether a prediction has been asked a second time in the class."""
    return any(str(step) in _notes(each, lesson).asked_again for each in students)


def truth_of(lesson: str, step: int, students: Iterable[Progress]) -> Truth | None:
    """The truth, taken from the first lab in which it has been measured."""
    found = (_notes(each, lesson).truths.get(str(step)) for each in students)
    return next((truth for truth in found if truth is not None and truth.times), None)


def tasks_passed(progress: Progress, lesson: Lesson) -> tuple[int, int]:
    """Numbers of passed tasks and of all tasks in a lesson, without optional ones."""
    tasks, passed = lesson.required_tasks(), _notes(progress, lesson.name).tasks
    return sum(task.id in passed for task in tasks), len(tasks)


def _notes(progress: Progress, lesson: str) -> Notes:
    return progress.notes.get(lesson, Notes())
