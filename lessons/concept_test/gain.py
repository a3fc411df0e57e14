"""What a class has learned, by its answers to the concept test before and after the course."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from onpath.lessons.concept_test.concept_test import (
    AFTER,
    BEFORE,
    handed_in,
    questions,
    right_in,
)
from onpath.lessons.concept_test.estimates import Estimated, bootstrapped, share
from onpath.lessons.progress import Progress
from onpath.lessons.schema import Lesson
from onpath.models.arrays import Array

Forms = Sequence[Lesson]
"""The test in each of its forms, in one language."""


@dataclass(frozen=True, slots=True)
class Sitting:
    """A test that a student has handed in: its form, and whether each answer is right."""

    form: int
    right: tuple[bool, ...]


@dataclass(frozen=True, slots=True)
class Person:
    """A student's tests; None for one that has not been handed in."""

    before: Sitting | None
    after: Sitting | None


def people(forms: Forms, students: Iterable[tuple[str, Progress]]) -> list[Person]:
    """The tests of each student.

    Args:
        students: who it is, and the progress in a lab. A test before the course in one lab and one
            after it in another lab of the same student are put together. Those who have handed in
            the same test are not the same student.
    """
    found = dict[str, Person]()
    for number, (who, progress) in enumerate(students):
        new = Person(_sat(forms, progress, BEFORE), _sat(forms, progress, AFTER))
        old = found.get(who, Person(None, None))
        if (old.before and new.before) or (old.after and new.after):
            found[f"{who} {number}"] = new
        else:
            found[who] = Person(old.before or new.before, old.after or new.after)
    return list(found.values())


def _sat(forms: Forms, progress: Progress, sitting: str) -> Sitting | None:
    found = handed_in(progress, sitting)
    if found is None or found[0] >= len(forms):
        return None
    form, notes = found
    return Sitting(form, tuple(right_in(forms[form], notes)))


@dataclass(frozen=True, slots=True)
class ClassGain:
    """The results of a class before and after the course, without names.

    Only students who have handed in both tests count, each in a form of its own if there are two,
    so that all shares are of the same students.

    Attributes:
        students: their number.
        before, after: mean share of right answers, [%]; see `class_gain`.
        gain: the normalised gain.
        questions: for each belief, the share of right answers before and after, [%].
    """

    students: int
    before: Estimated | None
    after: Estimated | None
    gain: Estimated | None
    questions: tuple[tuple[Estimated | None, Estimated | None], ...]


def normalised_gain(before: Array, after: Array) -> Array:
    """The achieved share of the possible gain: g = (after - before) / (100 % - before).

    Source: R. R. Hake, Am. J. Phys. 66 (1998) 64.

    Args:
        before, after: means of a class, [%].

    Returns:
        The gain; not a number if nothing could be gained.
    """
    possible = np.where(before < 100, 100 - before, np.nan)
    return (after - before) / possible


def class_gain(forms: Forms, students: Iterable[Person]) -> ClassGain:
    """The results of the students who have handed in both tests.

    A mean before or after the course is the mean over the forms of the means of those who answered
    the form then. So a form that is easier than the other counts on both sides, however many
    students have answered it first.
    """
    pairs = [
        (each.before, each.after)
        for each in students
        if each.before and each.after and (len(forms) == 1 or each.before.form != each.after.form)
    ]
    ways = [[pair for pair in pairs if pair[0].form == form] for form in range(len(forms))]
    ways = [way for way in ways if way]
    scores = [100 * np.array([[np.mean(s.right) for s in pair] for pair in way]) for way in ways]

    def means(weights: Sequence[Array]) -> Array:
        """Before, after and gain, shape (draws, 3)."""
        of_ways = [w @ each / len(each) for w, each in zip(weights, scores, strict=True)]
        before, after = np.mean(of_ways, axis=0).T
        return np.stack([before, after, normalised_gain(before, after)], axis=1)

    asked = len(questions(forms[0]))
    if not pairs:
        return ClassGain(0, None, None, None, ((None, None),) * asked)
    before, after, gain = bootstrapped([len(way) for way in ways], means)
    counts = np.sum([[s.right for s in pair] for pair in pairs], axis=0, dtype=int).tolist()
    shares = [(share(a, len(pairs)), share(b, len(pairs))) for a, b in zip(*counts, strict=True)]
    return ClassGain(len(pairs), before, after, gain, tuple(shares))
