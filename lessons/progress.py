"""A student's progress in the lessons. It is stored as JSON, and validated when it is read."""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import cached_property
from typing import Annotated

import msgspec

from onpath.lessons.given import Answer, Given, Index, Key, Points
from onpath.lessons.kept.former_progress import progress_of_today
from onpath.lessons.kept.option_keys import second_key


class Truth(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """What happened after a prediction: one quantity of both robots over time."""

    quantity: Key
    times: Points
    tracker: Points
    follower: Points


class Notes(msgspec.Struct, frozen=True, forbid_unknown_fields=True, dict=True):
    """Progress in one lesson.

    Attributes:
        step: index of the open step.
        seen: number of steps that have been opened.
        truths: what happened after the predictions, by step.
        played: steps whose script has been run.
        hints: number of hints shown, by task.
        asked_again: predictions that the teacher has asked again after a discussion, by step; one
            is in it as often as it was asked again.
        handed_in: whether a test has been handed in, after which its answers do not change.
        given: all answers, in the order in which they were given; see `given_to`.
    """

    step: Index = 0
    seen: Index = 0
    truths: dict[Key, Truth] = {}
    played: Annotated[tuple[Key, ...], msgspec.Meta(max_length=1000)] = ()
    hints: dict[Key, Index] = {}
    asked_again: Annotated[tuple[Key, ...], msgspec.Meta(max_length=1000)] = ()
    handed_in: bool = False
    given: Annotated[tuple[Given, ...], msgspec.Meta(max_length=10_000)] = ()

    @cached_property
    def by_item(self) -> dict[str, tuple[Given, ...]]:
        """The answers to each item, in order."""
        found = dict[str, tuple[Given, ...]]()
        for each in self.given:
            found[each.item] = (*found.get(each.item, ()), each)
        return found

    @cached_property
    def answers(self) -> dict[str, Answer]:
        """The answers to predictions, by step: of each the first one that was not skipped."""
        return self._predicted(again=False)

    @cached_property
    def second(self) -> dict[str, Answer]:
        """The answers to predictions that were asked again, since the last time."""
        return self._predicted(again=True)

    @cached_property
    def quiz(self) -> dict[str, int]:
        """The options chosen last, by step and block."""
        last = {item: given[-1].answer for item, given in self._asked()}
        return {k: each.option for k, each in last.items() if each and each.option is not None}

    @cached_property
    def numbers(self) -> dict[str, float]:
        """The last answers that are numbers, by step and block."""
        last = {item: given[-1].number for item, given in self._asked()}
        return {item: each for item, each in last.items() if each is not None}

    @cached_property
    def written(self) -> dict[str, str]:
        """The last answers in the student's own words, and the rows of derivations (see
        `lessons.derivation.judged`), by step and block."""
        return {item: given[-1].text for item, given in self._asked() if given[-1].text}

    @cached_property
    def twice(self) -> frozenset[str]:
        """The questions that have been answered more than once."""
        return frozenset(item for item, given in self._asked() if given[-1].attempt > 1)

    @cached_property
    def tasks(self) -> dict[str, float]:
        """Ids of passed tasks -> best value so far, or 0 for tasks without one."""
        return {item: min(each.number or 0.0 for each in given) for item, given in self._passed()}

    @cached_property
    def ways(self) -> dict[str, int]:
        """The way in which a task was passed last; see `lessons.checks.way_of`."""
        return {item: given[-1].way or 0 for item, given in self._passed()}

    @cached_property
    def unknown(self) -> frozenset[str]:
        """Keys of choices that cannot be identified, because the lesson has changed."""
        first, again = (self._chosen(again=again) for again in (False, True))
        found = [item for item, each in first.items() if each.lost]
        found += [second_key(item) for item, each in again.items() if each.lost]
        return frozenset((*found, *(item for item, given in self._asked() if given[-1].lost)))

    def _predicted(self, again: bool) -> dict[str, Answer]:
        found = self._chosen(again)
        return {item: each.answer for item, each in found.items() if each.answer is not None}

    def _chosen(self, again: bool) -> dict[str, Given]:
        """Of each prediction the answer that counts, see `answers` and `second`."""
        found = dict[str, Given]()
        for item, given in self.by_item.items():
            asked = self.asked_again.count(item) if again else 0
            now = [each for each in given if each.round == asked and each.way is None]
            if now and "." not in item and not (again and not asked):
                found[item] = next((each for each in now if not each.is_skipped), now[0])
        return found

    def _asked(self) -> Iterator[tuple[str, tuple[Given, ...]]]:
        """The answers to questions."""
        return (each for each in self.by_item.items() if "." in each[0] and each[1][0].way is None)

    def _passed(self) -> Iterator[tuple[str, tuple[Given, ...]]]:
        """The times when tasks were passed."""
        return (each for each in self.by_item.items() if each[1][0].way is not None)


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
    """The answers to an item, in order."""
    return notes.by_item.get(item, ())


def read_progress(data: object) -> Progress:
    """The progress in decoded JSON.

    Raises:
        ValueError: it is not valid; the message names the place.
    """
    progress = msgspec.convert(progress_of_today(data), Progress)
    for notes in progress.notes.values():
        numbers = [number for g in notes.given for number in (g.time, g.number or 0.0)]
        for answer in (g.answer for g in notes.given if g.answer is not None):
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
