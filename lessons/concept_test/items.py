"""How hard each question of the concept test is, and whether it tells students apart."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from onpath.lessons.concept_test.concept_test import questions
from onpath.lessons.concept_test.estimates import Estimated, bootstrapped, share
from onpath.lessons.concept_test.gain import Forms, Person, Sitting
from onpath.models.arrays import Array


@dataclass(frozen=True, slots=True)
class Item:
    """A question of a form.

    Attributes:
        count: number of students who have handed in the form.
        difficulty: share of right answers, [%]; the easier, the larger.
        discrimination: correlation between a right answer and the number of right answers to the
            other questions; see `discriminations`.
    """

    count: int
    difficulty: Estimated | None
    discrimination: Estimated | None


def items(forms: Forms, students: Iterable[Person]) -> list[list[Item]]:
    """The questions of each form, by the students who have handed it in before or after the course.

    Where there is one form only, by the first time.
    """
    sat = [list[list[Sitting]](([], [])) for _ in forms]
    for each in students:
        seen = set[int]()
        for when, sitting in enumerate((each.before, each.after)):
            if sitting is not None and sitting.form not in seen:
                seen.add(sitting.form)
                sat[sitting.form][when].append(sitting)
    return [
        _items([np.array([s.right for s in group], dtype=float) for group in both if group])
        or [Item(0, None, None)] * len(questions(form))
        for form, both in zip(forms, sat, strict=True)
    ]


def _items(groups: Sequence[Array]) -> list[Item]:
    if not groups:
        return []
    count = sum(len(group) for group in groups)
    right = np.sum([group.sum(axis=0) for group in groups], axis=0, dtype=int).tolist()
    told = bootstrapped(
        [len(group) for group in groups], lambda weights: discriminations(groups, weights)
    )
    return [Item(count, share(n, count), r) for n, r in zip(right, told, strict=True)]


def discriminations(groups: Sequence[Array], weights: Sequence[Array]) -> Array:
    """Correlation of each question with the sum of the others, within the groups.

    r = Σ x y / √(Σ x² Σ y²), where x is 1 for a right answer and 0 for another one, and y the
    number of right answers to the other questions, both minus their mean in the group. So it says
    nothing of the difference between those who answer before and after the course.

    Source: the corrected item-total correlation, e.g. J. C. Nunnally, Psychometric Theory (1978).

    Args:
        groups: for each group 1 or 0, shape (students, questions).
        weights: how often each student counts, shape (draws, students) for each group.

    Returns:
        Shape (draws, questions); not a number where all answers are equal.
    """
    total = np.zeros((3, len(weights[0]), groups[0].shape[1]))
    for x, w in zip(groups, weights, strict=True):
        y, all_ = x.sum(axis=1, keepdims=True) - x, w.sum(axis=1, keepdims=True)
        mean_x, mean_y = w @ x / all_, w @ y / all_
        total += [
            w @ (x * y) - all_ * mean_x * mean_y,
            w @ (x * x) - all_ * mean_x**2,
            w @ (y * y) - all_ * mean_y**2,
        ]
    together, of_x, of_y = total
    spread = np.where((of_x > 1e-9) & (of_y > 1e-9), of_x * of_y, np.nan)
    return together / np.sqrt(spread)
