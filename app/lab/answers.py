"""Converts a student's answers to the form in which they are stored."""

from __future__ import annotations

import math

from msgspec.structs import replace

from onpath.app.common.visible_text import readable
from onpath.app.lab.sketches import sketched
from onpath.lessons.given import MOST_TEXT, SURENESS, Answer
from onpath.lessons.schema import Prediction, Sketch
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
