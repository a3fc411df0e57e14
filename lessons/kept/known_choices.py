"""Kept choices of lessons that have changed since: found again by their keys, or known to be lost.

Notes from before marks were kept say only at which place an option stood, so it cannot be known
which option it was. A curve without a mark is shown if the step still asks for a curve.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from msgspec.structs import replace

from onpath.lessons.course import Course
from onpath.lessons.kept.option_keys import second_key, why_key
from onpath.lessons.progress import Answer, Notes, Progress
from onpath.lessons.schema import Choice, Lesson


def marks_of(lesson: Lesson, key: str, answer: Answer, second: bool = False) -> dict[str, str]:
    """What to keep beside an answer to a prediction, so that it can be found again.

    Args:
        key: of the prediction in the notes.
        second: whether it is the answer after a discussion.
    """
    own = second_key(key) if second else key
    marks = mark_of(lesson, key, 0 if answer.times else answer.option, own)
    return {**marks, **mark_of(lesson, why_key(key), answer.reason, why_key(own))}


def mark_of(lesson: Lesson, key: str, index: int | None, own: str = "") -> dict[str, str]:
    """What to keep beside the index of an option; `own` is its name, by default `key`."""
    keys = lesson.keys.get(key, ())
    return {own or key: keys[index]} if index is not None and index < len(keys) else {}


def of_today(course: Course, progress: Progress, only: str = "") -> Progress:
    """The progress with the indices that the options have today; the same object if all have them.

    What was chosen in a way that cannot be known any more is in `Notes.unknown`.

    Args:
        only: name of the one lesson that matters; empty for all.
    """
    changed = dict[str, Notes]()
    for name, notes in progress.notes.items():
        if course.has(name) and name == (only or name):
            found = known_notes(course.lesson(name, progress.language), notes)
            if found != notes:
                changed[name] = found
    return replace(progress, notes={**progress.notes, **changed}) if changed else progress


def known_notes(lesson: Lesson, notes: Notes) -> Notes:
    """Notes on a lesson with the indices that the options have today; see `of_today`."""
    search = _Search(lesson, notes, set(notes.unknown))
    answers = {key: search.answer(key, key, each) for key, each in notes.answers.items()}
    second = {key: search.answer(key, second_key(key), each) for key, each in notes.second.items()}
    quiz = {key: search.index(key, key, index) for key, index in notes.quiz.items()}
    search.lost.update(key for key, index in quiz.items() if index is None)
    found = {key: index for key, index in quiz.items() if index is not None}
    unknown = tuple(sorted(search.lost))
    return replace(notes, answers=answers, second=second, quiz=found, unknown=unknown)


@dataclass(frozen=True, slots=True)
class _Search:
    """Looks for kept choices in a lesson of today.

    Attributes:
        lost: keys of the choices that cannot be known.
    """

    lesson: Lesson
    notes: Notes
    lost: set[str] = field(default_factory=set[str])

    def index(self, key: str, own: str, index: int) -> int | None:
        """The index that a chosen option has today; None if it cannot be known."""
        keys, mark = self.lesson.keys.get(key), self.notes.marks.get(own)
        if keys is None:
            return index  # nothing is asked there, so nothing is shown
        return keys.index(mark) if mark in keys else None

    def answer(self, key: str, own: str, answer: Answer) -> Answer:
        """An answer as it is to be understood today; without choice and curve if it is lost."""
        if answer.skipped or key not in self.lesson.keys:
            return answer
        reason = answer.reason
        if reason is not None:
            reason = self.index(why_key(key), why_key(own), reason)
        if answer.times:
            option, here = None, self._fits_a_curve(key, own)
        else:
            option = self.index(key, own, answer.option or 0)
            here = option is not None and isinstance(self._asked(key), Choice)
        if here:
            return replace(answer, option=option, reason=reason)
        self.lost.add(own)
        return Answer(sure=answer.sure, why=answer.why)

    def _fits_a_curve(self, key: str, own: str) -> bool:
        mark = self.notes.marks.get(own)
        return not isinstance(self._asked(key), Choice) and mark in (None, *self.lesson.keys[key])

    def _asked(self, key: str) -> object:
        return next(iter(self.lesson.steps[int(key)].predictions()), None)
