"""An answer: one event, as a student's progress, the record of a class, the grade and a learning
platform's interactions read it. assets/web/core/shared_data.ts has the same, made from it."""

from __future__ import annotations

from typing import Annotated, Literal

import msgspec

MOST_POINTS = 200
MOST_TEXT = 1000
"""Longest answer in a student's own words, [characters]."""
Index = Annotated[int, msgspec.Meta(ge=0, le=1000)]
Key = Annotated[str, msgspec.Meta(max_length=80)]
Written = Annotated[str, msgspec.Meta(max_length=MOST_TEXT)]
Sure = Literal["", "guessing", "fairly", "certain"]
"""How sure a student is of a prediction; empty if the student did not say."""
SURENESS: tuple[Sure, ...] = ("guessing", "fairly", "certain")
Points = Annotated[tuple[float, ...], msgspec.Meta(max_length=MOST_POINTS)]


class Answer(msgspec.Struct, frozen=True, forbid_unknown_fields=True, omit_defaults=True):
    """The answer to a prediction: an option, a sketched curve, or neither if it was skipped.

    Attributes:
        option: index of the option, or None.
        times, values: points of a sketch, [s] and in the quantity's unit.
        sure: how sure the student is.
        reason: index of the chosen reason, or None.
        why: the reason in the student's own words.
    """

    option: Index | None = None
    times: Points = ()
    values: Points = ()
    sure: Sure = ""
    reason: Index | None = None
    why: Written = ""

    @property
    def skipped(self) -> bool:
        """Whether no answer was given."""
        return self.option is None and not self.times


class Given(msgspec.Struct, frozen=True, forbid_unknown_fields=True, omit_defaults=True):
    """One answer, as it was given: what was answered later is another one beside it.

    A student's progress, the record of a class, the grade, and what a learning platform is told are
    all read from these.

    Attributes:
        item: what was answered: a prediction, by step, a question, by step and block, a second try
            (see `lessons.second_try`), or a task, by its id.
        attempt: number of the answer to the item, from 1, or 2 for a second try; one that only
            repeats the answer before it is none.
        time: seconds since 1970; 0 if unknown.
        round: how often the item had been asked again by then; 0: never.
        answer: to a prediction or a quiz.
        number: to a question whose answer is a number; the value of a task that was passed, or 0.
        text: in the student's own words; of a derivation, all rows so far.
        right: whether it is right; null where that is not judged.
        hints: number of hints that had been shown.
        way: the way in which a task was passed, see `lessons.checks.way_of`; null: it is none.
        lost: whether the choice cannot be identified, because the lesson has changed.
        mark, why_mark: keys of the chosen option and reason; see `lessons.kept`.
        key: a number by which the browser knows the answer; one that comes again counts once.
        lesson, product: versions of the lesson and of OnPath.
    """

    item: Key
    attempt: Annotated[int, msgspec.Meta(ge=1, le=10_000)] = 1
    time: float = 0.0
    round: Index = 0
    answer: Answer | None = None
    number: float | None = None
    text: Written = ""
    right: bool | None = None
    hints: Index = 0
    way: Index | None = None
    lost: bool = False
    mark: Key = ""
    why_mark: Key = ""
    key: Key = ""
    lesson: Key = ""
    product: Key = ""

    @property
    def is_skipped(self) -> bool:
        """Whether it is none, since the prediction was passed over, or cannot be identified."""
        return self.answer is not None and self.answer.skipped
