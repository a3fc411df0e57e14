"""Kept choices of lessons that have changed since: identified by their keys, or marked as lost.

Notes without marks, from earlier versions, only have the position of an option, so that the option
is unknown. A curve without a mark is shown if the step still asks for a curve.
"""

from __future__ import annotations

from dataclasses import dataclass

from msgspec.structs import replace

from onpath.lessons.course import Course
from onpath.lessons.given import Answer, Given
from onpath.lessons.kept.option_keys import why_key
from onpath.lessons.progress import Notes, Progress
from onpath.lessons.right import is_right
from onpath.lessons.schema import Block, Choice, Lesson, Quiz, Sketch
from onpath.lessons.second_try import SECOND_TRY, second_at


def marked(lesson: Lesson, given: Given) -> Given:
    """An answer with the keys of its option and its reason, by which it is identified later."""
    if given.answer is None:
        return given
    option = 0 if given.answer.times else given.answer.option
    why_mark = _mark(lesson, why_key(given.item), given.answer.reason)
    return replace(given, mark=_mark(lesson, given.item, option), why_mark=why_mark)


def _mark(lesson: Lesson, key: str, index: int | None) -> str:
    keys = lesson.keys.get(key, ())
    return keys[index] if index is not None and index < len(keys) else ""


def of_today(course: Course, progress: Progress) -> Progress:
    """The progress with the present indices of the options; the same object if nothing changes.

    Choices that can no longer be identified are in `Notes.unknown`.
    """
    changed = dict[str, Notes]()
    for name, notes in progress.notes.items():
        if course.has(name):
            found = known_notes(course.lesson(name, progress.language), notes)
            if found != notes:
                changed[name] = found
    return replace(progress, notes={**progress.notes, **changed}) if changed else progress


def known_notes(lesson: Lesson, notes: Notes) -> Notes:
    """Notes on a lesson with the present indices of the options; see `of_today`."""
    search = _Search(lesson)
    return replace(notes, given=tuple(map(search.given, notes.given)))


@dataclass(frozen=True, slots=True)
class _Search:
    """Looks for kept choices in the present lesson."""

    lesson: Lesson

    def given(self, given: Given) -> Given:
        """An answer with the present indices; without choice and curve if it is lost.

        One from before it was kept whether an answer is right is judged now.
        """
        if given.answer is not None:
            found = self._answer(given.item, given.mark, given.why_mark, given.answer)
            lost = given.lost or (found.skipped and not given.answer.skipped)
            if found != given.answer or lost != given.lost:
                given = replace(given, answer=found, lost=lost)
        block = self._asked(given.item)
        if given.right is None and block is not None and not given.lesson:
            given = replace(given, right=is_right(block, given))
        return given

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

    def _asked(self, key: str) -> Block | None:
        """The prediction or the question; None for a task, or if there is none any more."""
        if key.endswith(SECOND_TRY):
            return second_at(self.lesson.steps, key)
        step, _, block = key.partition(".")
        steps = self.lesson.steps
        if not step.isdecimal() or int(step) >= len(steps):
            return None
        if not block:
            return next(iter(steps[int(step)].predictions()), None)
        blocks = steps[int(step)].blocks
        return blocks[int(block)] if block.isdecimal() and int(block) < len(blocks) else None
