"""What a student has done in the lessons. Kept as JSON; whatever is read back is checked."""

from __future__ import annotations

import math
from typing import Annotated

import msgspec

MOST_POINTS = 200
Index = Annotated[int, msgspec.Meta(ge=0, le=1000)]
Key = Annotated[str, msgspec.Meta(max_length=80)]
Points = Annotated[tuple[float, ...], msgspec.Meta(max_length=MOST_POINTS)]


class Answer(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A prediction: an option, or a curve, or neither when it was skipped.

    Attributes:
        option: index, or None.
        times, values: of a sketch, [s] and in the quantity's unit.
    """

    option: Index | None = None
    times: Points = ()
    values: Points = ()

    @property
    def skipped(self) -> bool:
        """Whether there is none."""
        return self.option is None and not self.times


class Truth(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """What really happened: a quantity of both robots over time."""

    quantity: Key
    times: Points
    tracker: Points
    follower: Points


class Notes(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Of one lesson.

    Attributes:
        step: the one that is open.
        seen: how many steps have been opened.
        answers, truths: of the predictions, by step.
        played: steps that have been let happen.
        tasks: passed ones, with the best value of each that is worth one, or 0.
        hints: how many are shown, by task.
        quiz: chosen options, by step.
    """

    step: Index = 0
    seen: Index = 0
    answers: dict[Key, Answer] = {}
    truths: dict[Key, Truth] = {}
    played: Annotated[tuple[Key, ...], msgspec.Meta(max_length=1000)] = ()
    tasks: dict[Key, float] = {}
    hints: dict[Key, Index] = {}
    quiz: dict[Key, Index] = {}


class Progress(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Of one student.

    Attributes:
        lesson: name of the open one; empty for none.
        language: of texts and interface.
        presenting: large type for a projector.
        notes: by lesson.
    """

    lesson: Key = ""
    language: Annotated[str, msgspec.Meta(max_length=8)] = "en"
    presenting: bool = False
    notes: dict[Key, Notes] = {}


def read_progress(data: object) -> Progress:
    """From decoded JSON.

    Raises:
        ValueError: it is not a progress; the message says where.
    """
    progress = msgspec.convert(data, Progress)
    for notes in progress.notes.values():
        numbers = [*notes.tasks.values()]
        for answer in notes.answers.values():
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
