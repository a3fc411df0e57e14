"""Kept choices of lessons that have changed since: identified by their keys, or marked as lost.

Notes without marks, from earlier versions, only have the position of an option, so that the option
is unknown. A curve without a mark is shown if the step still asks for a curve.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from msgspec.structs import replace

from onpath.lessons.course import Course
from onpath.lessons.kept.option_keys import second_key, why_key
from onpath.lessons.progress import Answer, Given, Notes, Progress
from onpath.lessons.schema import Choice, Lesson, Quiz, Sketch


def marks_of(lesson: Lesson, key: str, answer: Answer, second: bool = False) -> dict[str, str]:
    """The marks to keep with an answer to a prediction, so that it can be identified later.

    Args:
        key: of the prediction in the notes.
        second: whether it is the answer after a discussion.
    """
    mark_key = second_key(key) if second else key
    marks = mark_of(lesson, key, 0 if answer.times else answer.option, mark_key)
    return {**marks, **mark_of(lesson, why_key(key), answer.reason, why_key(mark_key))}


def mark_of(lesson: Lesson, key: str, index: int | None, mark_key: str = "") -> dict[str, str]:
    """The mark to keep with the index of an option, under `mark_key`, by default `key`."""
    keys = lesson.keys.get(key, ())
    return {mark_key or key: keys[index]} if index is not None and index < len(keys) else {}


def of_today(course: Course, progress: Progress, only: str = "") -> Progress:
    """The progress with the present indices of the options; the same object if nothing changes.

    Choices that can no longer be identified are in `Notes.unknown`.

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
    """Notes on a lesson with the present indices of the options; see `of_today`."""
    search = _Search(lesson, notes, set(notes.unknown))
    answers = {key: search.answer(key, key, each) for key, each in notes.answers.items()}
    second = {key: search.answer(key, second_key(key), each) for key, each in notes.second.items()}
    quiz = {key: search.index(key, key, index) for key, index in notes.quiz.items()}
    search.lost.update(key for key, index in quiz.items() if index is None)
    found = {key: index for key, index in quiz.items() if index is not None}
    unknown = tuple(sorted(search.lost))
    given = tuple(map(search.given, notes.given))
    return replace(notes, answers=answers, second=second, quiz=found, unknown=unknown, given=given)


@dataclass(frozen=True, slots=True)
class _Search:
    """Looks for kept choices in the present lesson.

    Attributes:
        lost: keys of the choices that cannot be identified.
    """

    lesson: Lesson
    notes: Notes
    lost: set[str] = field(default_factory=set[str])

    def index(self, key: str, mark_key: str, index: int) -> int | None:
        """The present index of a chosen option; None if it cannot be identified."""
        return self._index(key, self.notes.marks.get(mark_key, ""), index)

    def answer(self, key: str, mark_key: str, answer: Answer) -> Answer:
        """An answer with the present indices; without choice and curve if it is lost."""
        marks = self.notes.marks
        found = self._answer(key, marks.get(mark_key, ""), marks.get(why_key(mark_key), ""), answer)
        if found.skipped and not answer.skipped:
            self.lost.add(mark_key)
        return found

    def given(self, given: Given) -> Given:
        """One of the answers that were given; see `answer`."""
        if given.answer is None:
            return given
        found = self._answer(given.item, given.mark, given.why_mark, given.answer)
        return given if found == given.answer else replace(given, answer=found)

    def _index(self, key: str, mark: str, index: int) -> int | None:
        keys = self.lesson.keys.get(key)
        if keys is None:
            return index  # nothing is asked there, so nothing is shown
        return keys.index(mark) if mark in keys else None

    def _answer(self, key: str, mark: str, why_mark: str, answer: Answer) -> Answer:
        if answer.skipped or key not in self.lesson.keys:
            return answer
        reason = answer.reason
        if reason is not None:
            reason = self._index(why_key(key), why_mark, reason)
        if answer.times:
            option, here = None, self._fits_a_curve(key, mark)
        else:
            option = self._index(key, mark, answer.option or 0)
            here = option is not None and isinstance(self._asked(key), Choice | Quiz)
        if here:
            return replace(answer, option=option, reason=reason)
        return Answer(sure=answer.sure, why=answer.why)

    def _fits_a_curve(self, key: str, mark: str) -> bool:
        is_curve = isinstance(self._asked(key), Sketch)
        return is_curve and mark in ("", *self.lesson.keys[key])

    def _asked(self, key: str) -> object:
        step, _, block = key.partition(".")
        if block:
            return self.lesson.steps[int(step)].blocks[int(block)]
        return next(iter(self.lesson.steps[int(step)].predictions()), None)
