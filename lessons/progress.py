"""A student's progress in the lessons. It is stored as JSON, and validated when it is read."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Annotated, Literal, cast

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


class Answer(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
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


class Given(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """One answer, as it was given: what was answered later is another one beside it.

    Attributes:
        item: what was answered: a prediction, by step, or a question, by step and block.
        time: seconds since 1970; 0 if unknown.
        round: how often the item had been asked again by then; 0: never.
        answer: to a prediction or a quiz.
        number: to a question whose answer is a number.
        text: in the student's own words.
        mark, why_mark: keys of the chosen option and reason; see `lessons.kept`.
        key: a number by which the browser knows the answer; one that comes again counts once.
    """

    item: Key
    time: float = 0.0
    round: Index = 0
    answer: Answer | None = None
    number: float | None = None
    text: Written = ""
    mark: Key = ""
    why_mark: Key = ""
    key: Key = ""


class Truth(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """What happened after a prediction: one quantity of both robots over time."""

    quantity: Key
    times: Points
    tracker: Points
    follower: Points


class Notes(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Progress in one lesson.

    Attributes:
        step: index of the open step.
        seen: number of steps that have been opened.
        answers, truths: of the predictions, by step.
        played: steps whose script has been run.
        tasks: ids of passed tasks -> best value so far, or 0 for tasks without one.
        ways: the way in which a task was passed last, by task; see `lessons.checks.way_of`.
        hints: number of hints shown, by task.
        quiz: chosen options, by step and block.
        numbers: answers that are numbers, by step and block.
        written: answers in the student's own words, and the rows of derivations (see
            `lessons.derivation.judged`), by step and block.
        twice: quizzes and questions for numbers that have been answered a second time, by step and
            block.
        asked_again: predictions that the teacher has asked again after a discussion, by step; one
            is in it as often as it was asked again.
        second: the answers to those.
        marks: keys of the chosen options; see `lessons.kept`.
        unknown: keys of choices that cannot be identified, because the lesson has changed.
        handed_in: whether a test has been handed in, after which its answers do not change.
        given: the answers in the order in which they were given; see `given_to`.
    """

    step: Index = 0
    seen: Index = 0
    answers: dict[Key, Answer] = {}
    truths: dict[Key, Truth] = {}
    played: Annotated[tuple[Key, ...], msgspec.Meta(max_length=1000)] = ()
    tasks: dict[Key, float] = {}
    ways: dict[Key, Index] = {}
    hints: dict[Key, Index] = {}
    quiz: dict[Key, Index] = {}
    numbers: dict[Key, float] = {}
    written: dict[Key, Written] = {}
    twice: Annotated[tuple[Key, ...], msgspec.Meta(max_length=1000)] = ()
    asked_again: Annotated[tuple[Key, ...], msgspec.Meta(max_length=1000)] = ()
    second: dict[Key, Answer] = {}
    marks: dict[Key, Key] = {}
    unknown: Annotated[tuple[Key, ...], msgspec.Meta(max_length=1000)] = ()
    handed_in: bool = False
    given: Annotated[tuple[Given, ...], msgspec.Meta(max_length=10_000)] = ()


class Progress(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Progress of one student.

    Attributes:
        lesson: name of the open lesson; empty for none.
        route: name of the route that is followed; empty for none.
        language: of texts and interface.
        notes: by lesson.
        ended: whether the end of the open lesson is shown in place of its open step.
    """

    lesson: Key = ""
    language: Annotated[str, msgspec.Meta(max_length=8)] = "en"
    notes: dict[Key, Notes] = {}
    route: Key = ""
    ended: bool = False


def given_to(notes: Notes, item: str) -> tuple[Given, ...]:
    """The answers to an item, in order; of notes from before each was kept, those that remain."""
    known = tuple(each for each in notes.given if each.item == item)
    return known or tuple(_remaining(notes, item))


def _remaining(notes: Notes, item: str) -> Iterator[Given]:
    if item in notes.answers:
        yield Given(item, answer=notes.answers[item])
    if item in notes.second:
        yield Given(item, round=notes.asked_again.count(item), answer=notes.second[item])
    if item in notes.quiz:
        yield Given(item, answer=Answer(option=notes.quiz[item]))
    if item in notes.numbers:
        yield Given(item, number=notes.numbers[item])
    if item in notes.written:
        yield Given(item, text=notes.written[item])


def read_progress(data: object) -> Progress:
    """The progress in decoded JSON.

    Raises:
        ValueError: it is not valid; the message names the place.
    """
    if isinstance(data, dict):  # "presenting" is one of the lab's own settings now
        given = cast("dict[object, object]", data)
        data = {name: value for name, value in given.items() if name != "presenting"}
    progress = msgspec.convert(data, Progress)
    for notes in progress.notes.values():
        numbers = [*notes.tasks.values(), *notes.numbers.values()]
        numbers += [number for g in notes.given for number in (g.time, g.number or 0.0)]
        given = [g.answer for g in notes.given if g.answer is not None]
        for answer in (*notes.answers.values(), *notes.second.values(), *given):
            numbers += [*answer.times, *answer.values]
            if len(answer.times) != len(answer.values):
                raise ValueError("a sketch with more times than values, or fewer")
        for truth in notes.truths.values():
            numbers += [*truth.times, *truth.tracker, *truth.follower]
            if not len(truth.times) == len(truth.tracker) == len(truth.follower):
                raise ValueError("a truth with more times than values, or fewer")
        if not all(map(math.isfinite, numbers)):
            raise ValueError("a number that is not finite")
    return progress
