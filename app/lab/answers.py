"""Converts a student's answers to the form in which they are stored, and chooses what is kept."""

from __future__ import annotations

import math
from collections.abc import Sequence

from msgspec.structs import replace

from onpath.app.common.visible_text import readable
from onpath.app.lab.sketches import sketched
from onpath.lessons.given import MOST_TEXT, SURENESS, Answer, Given
from onpath.lessons.progress import Notes, given_to
from onpath.lessons.schema import Prediction, Sketch
from onpath.lessons.second_try import SECOND_TRY
from onpath.models.errors import CodedError


def kept_answer(prediction: Prediction, answer: Answer) -> Answer:
    """The answer to a prediction; a skipped one has neither confidence nor reason.

    Raises:
        ValueError: no such option or reason, or the sketch is no curve.
    """
    if answer.skipped:
        return Answer()
    kept = sketched(prediction, answer) if isinstance(prediction, Sketch) else answer
    if not isinstance(prediction, Sketch) and answer.option not in range(len(prediction.options)):
        raise CodedError("lesson.no_such_option")
    if answer.reason is not None and answer.reason not in range(len(prediction.reasons)):
        raise CodedError("lesson.no_such_option")
    return replace(
        kept,
        sure=answer.sure if answer.sure in SURENESS else "",
        reason=answer.reason,
        why=kept_text(answer.why) if prediction.why else "",
    )


def kept_number(given: object) -> float:
    """An answer that is a number.

    Raises:
        ValueError: it is not a finite number.
    """
    if isinstance(given, bool) or not isinstance(given, float | int) or not math.isfinite(given):
        raise CodedError("lesson.no_number")
    return float(given)


def kept_text(typed: object) -> str:
    """An answer in the student's own words: at most MOST_TEXT visible characters and spaces."""
    return readable(str(typed)[: 4 * MOST_TEXT], _space)[:MOST_TEXT].strip()


def _space(character: str) -> str:
    """What replaces an invisible character: a line break, a space or nothing."""
    if character == "\n":
        return character
    return " " if character.isspace() else ""


def with_answer(notes: Notes, new: Given) -> tuple[Given, ...] | None:
    """The answers of some notes, and one more to an item; None if it says the same again.

    Of those before the item was asked again, and of those after the last time, not all are kept;
    see `_kept`.
    """
    before, asked = given_to(notes, new.item), notes.asked_again.count(new.item)
    new = replace(
        new,
        attempt=_attempt(before, new.item),
        round=asked,
        hints=notes.hints.get(new.item, 0),
    )
    if before and _says(before[-1]) == _says(new):
        return None
    latest = [each for each in (*before, new) if each.round == asked]
    first = [each for each in before if not each.round] if asked else []
    others = (each for each in notes.given if each.item != new.item)
    return (*others, *_kept(first), *_kept(latest))


def _attempt(before: Sequence[Given], item: str) -> int:
    """The number of an answer; one takes the place of an answer that cannot be identified."""
    first = 2 if item.endswith(SECOND_TRY) else 1
    return before[-1].attempt + (not before[-1].lost) if before else first


def _says(given: Given) -> tuple[object, ...]:
    return given.round, given.answer, given.number, given.text, given.way, given.lost


def _kept(given: Sequence[Given]) -> list[Given]:
    """The first answer, the first that was not skipped, the second one where it is judged (what is
    right is told after it), and the last one."""
    first = next((each for each in given if not each.is_skipped), None)
    second = given[1:2] if given and given[0].right is not None else ()
    wanted = (*given[:1], first, *second, *given[-1:])
    return [each for each in given if each in wanted]
