"""What a class has learned, by its answers to the concept test before and after the course."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from onpath.lessons.concept_test.concept_test import AFTER, BEFORE, notes_of, right_in
from onpath.lessons.progress import Progress
from onpath.lessons.schema import Lesson


@dataclass(frozen=True, slots=True)
class ClassGain:
    """The results of a class in both tests, without names.

    Only students who have handed in both count, so that both means are over the same students.

    Attributes:
        students: their number.
        before, after: share of right answers to each question, [%]; empty if there are no students.
    """

    students: int
    before: tuple[float, ...]
    after: tuple[float, ...]

    @property
    def mean_before(self) -> float | None:
        """Mean of the first test, [%]; None without students."""
        return float(np.mean(self.before)) if self.before else None

    @property
    def mean_after(self) -> float | None:
        """Mean of the second test, [%]; None without students."""
        return float(np.mean(self.after)) if self.after else None

    @property
    def gain(self) -> float | None:
        """Normalised gain; None without students, or if all answers were right at once."""
        return normalised_gain(self.mean_before, self.mean_after)


def normalised_gain(before: float | None, after: float | None) -> float | None:
    """The achieved share of the possible gain: g = (after - before) / (100 % - before).

    Source: R. R. Hake, Am. J. Phys. 66 (1998) 64.

    Args:
        before, after: means of a class, [%]; None if unknown.

    Returns:
        The gain; None if a mean is unknown, or nothing could be gained.
    """
    if before is None or after is None or before >= 100:
        return None
    return (after - before) / (100 - before)


def class_gain(test: Lesson, students: Iterable[Progress]) -> ClassGain:
    """The results of the students who have handed in both tests.

    Args:
        test: either of the two tests.
        students: progress of all students.
    """
    both = [(notes_of(student, BEFORE), notes_of(student, AFTER)) for student in students]
    pairs = [(right_in(test, a), right_in(test, b)) for a, b in both if a and b]
    if not pairs:
        return ClassGain(0, (), ())
    shares = 100 * np.mean(np.array(pairs, dtype=float), axis=0)
    return ClassGain(len(pairs), tuple(shares[0].tolist()), tuple(shares[1].tolist()))
