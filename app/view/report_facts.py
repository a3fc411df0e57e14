"""A student's stored lesson record, restricted to entries that match the current lessons."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, TypeVar

import numpy as np
from msgspec.structs import replace

from onpath.app.lab.lesson_state import LessonState
from onpath.lessons.progress import Answer, Notes, Truth
from onpath.lessons.schema import (
    Choice,
    Derivation,
    Lesson,
    NumberQuestion,
    OpenQuestion,
    Prediction,
    Quiz,
    Sketch,
)

T = TypeVar("T")


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


def quizzes(lesson: Lesson) -> dict[str, Quiz]:
    """Quizzes by note key: step and block."""
    return _of_kind(lesson, Quiz)


def numbers(lesson: Lesson) -> dict[str, NumberQuestion]:
    """Questions whose answer is a number, by note key: step and block."""
    return _of_kind(lesson, NumberQuestion)


def open_questions(lesson: Lesson) -> dict[str, OpenQuestion | Derivation]:
    """Questions answered in the student's own words or lines, by note key: step and block."""
    return _of_kind(lesson, OpenQuestion) | _of_kind(lesson, Derivation)


def _of_kind(lesson: Lesson, kind: type[T]) -> dict[str, T]:
    steps = enumerate(lesson.steps)
    blocks = [(f"{i}.{j}", each) for i, step in steps for j, each in enumerate(step.blocks)]
    return {key: block for key, block in blocks if isinstance(block, kind)}


def fitting(lesson: Lesson, notes: Notes) -> tuple[Notes, int]:
    """Notes that match a lesson, which may have changed since, and the number that do not."""
    asked, questions = predictions(lesson), quizzes(lesson)
    tasks = {task.id for task in lesson.tasks()}
    kept: dict[str, dict[str, Any]] = {
        "answers": _kept(notes.answers, lambda k, a: k in asked and _answers(asked[k], a)),
        "second": _kept(notes.second, lambda k, a: k in asked and _answers(asked[k], a)),
        "truths": _kept(notes.truths, lambda k, t: k in asked and _is_true_of(asked[k], t)),
        "tasks": _kept(notes.tasks, lambda k, best: k in tasks and bool(np.isfinite(best))),
        "quiz": _kept(
            notes.quiz, lambda k, i: k in questions and 0 <= i < len(questions[k].options)
        ),
        "numbers": _kept(
            notes.numbers, lambda k, given: k in numbers(lesson) and bool(np.isfinite(given))
        ),
        "written": _kept(notes.written, lambda k, _: k in open_questions(lesson)),
    }
    strange = sum(len(getattr(notes, name)) - len(kept[name]) for name in kept)
    return replace(notes, seen=min(notes.seen, len(lesson.steps)), **kept), strange


def _kept(notes: dict[str, Any], fits: Callable[[str, Any], bool]) -> dict[str, Any]:
    return {key: note for key, note in notes.items() if fits(key, note)}


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
