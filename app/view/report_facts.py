"""A student's stored lesson record, restricted to entries that match the current lessons."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from msgspec.structs import replace

from onpath.app.lab.lesson_state import LessonState
from onpath.lessons.given import Answer, Given
from onpath.lessons.progress import Notes, Truth
from onpath.lessons.schema import (
    Block,
    Choice,
    Derivation,
    Lesson,
    NumberQuestion,
    OpenQuestion,
    Prediction,
    Quiz,
    Sketch,
)
from onpath.lessons.second_try import second_at, second_item

T = TypeVar("T")
NOTHING = Notes()


@dataclass(frozen=True, slots=True)
class Chapter:
    """One lesson and the student's work on it.

    Attributes:
        number: number of the lesson, as displayed.
        notes: the entries that match the lesson.
        opened: whether the student has opened it.
        strange: number of entries that do not match it.
    """

    number: str
    lesson: Lesson
    notes: Notes
    opened: bool
    strange: int

    @property
    def ended(self) -> bool:
        """Whether the student has reached the last step."""
        return self.notes.seen >= len(self.lesson.steps)

    def happened(self, key: str) -> bool:
        """Whether the predicted experiment has been observed."""
        return key in self.notes.truths

    def chosen(self) -> dict[str, bool]:
        """Whether each choice whose result has been observed is right, by note key."""
        asked = predictions(self.lesson)
        return {
            key: block.options[answer.option].right
            for key, answer in self.notes.answers.items()
            if isinstance(block := asked[key], Choice)
            and answer.option is not None
            and self.happened(key)
        }


def chapters(run: LessonState) -> list[Chapter]:
    """All lessons of the course, in the student's language where available."""
    progress, found = run.progress, list[Chapter]()
    for name, number in run.course.numbers().items():
        lesson = run.course.lesson(name, progress.language)
        notes, strange = fitting(lesson, progress.notes.get(name, Notes()))
        chapter = Chapter(
            number=number,
            lesson=lesson,
            notes=notes,
            opened=name in progress.notes,
            strange=strange,
        )
        found.append(chapter)
    return found


def predictions(lesson: Lesson) -> dict[str, Prediction]:
    """Predictions by note key; a step asks for its first one."""
    steps = ((str(i), step.predictions()) for i, step in enumerate(lesson.steps))
    return {key: asked[0] for key, asked in steps if asked}


def quizzes(lesson: Lesson, notes: Notes) -> dict[str, Quiz]:
    """Quizzes by note key, step and block, and the second tries among them that were made."""
    return _of_kind(lesson, Quiz, notes)


def numbers(lesson: Lesson, notes: Notes) -> dict[str, NumberQuestion]:
    """Questions whose answer is a number, by note key; see `quizzes`."""
    return _of_kind(lesson, NumberQuestion, notes)


def open_questions(lesson: Lesson) -> dict[str, OpenQuestion | Derivation]:
    """Questions answered in the student's own words or lines, by note key: step and block."""
    return _of_kind(lesson, OpenQuestion) | _of_kind(lesson, Derivation)


def _of_kind(lesson: Lesson, kind: type[T], notes: Notes = NOTHING) -> dict[str, T]:
    found = dict[str, T]()
    for i, step in enumerate(lesson.steps):
        for j, block in enumerate(step.blocks):
            item = second_item(i, j)
            second = second_at(lesson.steps, item) if item in notes.by_item else None
            each = {f"{i}.{j}": block, item: second}
            found |= {key: asked for key, asked in each.items() if isinstance(asked, kind)}
    return found


def fitting(lesson: Lesson, notes: Notes) -> tuple[Notes, int]:
    """Notes that match a lesson, which may have changed since, and the number that do not."""
    asked = predictions(lesson)
    questions = {**quizzes(lesson, notes), **numbers(lesson, notes), **open_questions(lesson)}
    blocks = {**asked, **questions}
    tasks = {task.id for task in lesson.tasks()}
    truths = {k: t for k, t in notes.truths.items() if k in asked and _is_true_of(asked[k], t)}
    given = tuple(e for e in notes.given if _fits(e, blocks.get(e.item), e.item in tasks))
    lost = {each.item for each in notes.given} - {each.item for each in given}
    kept = replace(notes, seen=min(notes.seen, len(lesson.steps)), truths=truths, given=given)
    return kept, len(lost) + len(notes.truths) - len(truths)


def _fits(given: Given, block: Block | None, is_task: bool) -> bool:
    answer = given.answer
    if given.way is not None:
        return is_task and given.number is not None and bool(np.isfinite(given.number))
    if isinstance(block, Prediction):
        return answer is not None and _answers(block, answer)
    if isinstance(block, Quiz):
        option = None if answer is None else answer.option
        return given.lost or option in range(len(block.options))
    if isinstance(block, NumberQuestion):
        return given.number is not None and bool(np.isfinite(given.number))
    return isinstance(block, OpenQuestion | Derivation) and answer is None and given.number is None


def _answers(prediction: Prediction, answer: Answer) -> bool:
    if answer.skipped:
        return True
    if answer.reason is not None and answer.reason >= len(prediction.reasons):
        return False
    if isinstance(prediction, Sketch):
        return answer.option is None and _are_curves(answer.times, answer.values)
    return answer.option is not None and 0 <= answer.option < len(prediction.options)


def _is_true_of(prediction: Prediction, truth: Truth) -> bool:
    if isinstance(prediction, Choice):
        return True
    curves = _are_curves(truth.times, truth.tracker, truth.follower)
    return truth.quantity == prediction.quantity and curves


def _are_curves(*columns: tuple[float, ...]) -> bool:
    """Whether all curves have the same number of points, at least two, all numeric."""
    lengths = {len(column) for column in columns}
    return len(lengths) == 1 and min(lengths) > 1 and bool(np.isfinite(columns).all())
