"""The truth of every prediction of the course is computed as a lab measures it."""

from __future__ import annotations

import pytest

from onpath.app.lab.dry_runs.step_truth import computed_truth
from onpath.app.lab.lesson_run import quantity_of
from onpath.lessons.course import BUILT_IN, read_lesson
from onpath.lessons.sides import ROLES
from tests.support.stated_numbers import shown

pytestmark = pytest.mark.thorough

LESSONS = sorted(file.parent.name for file in BUILT_IN.glob("*/en.md"))


@pytest.mark.parametrize("name", LESSONS)
def test_every_prediction_of_a_lesson_has_its_truth(name: str) -> None:
    lesson = read_lesson(BUILT_IN / name / "en.md")
    for index, step in enumerate(lesson.steps):
        truth = computed_truth(lesson, index)
        assert (truth is None) is (not step.predictions()), step.title
        if truth is not None:
            assert truth.quantity == quantity_of(step.predictions()[0]) and len(truth.times) > 10


def test_it_is_what_a_lab_measures() -> None:
    lesson = read_lesson(BUILT_IN / "01-path-or-timetable" / "en.md")
    index = next(i for i, step in enumerate(lesson.steps) if step.predictions())
    truth, seen = computed_truth(lesson, index), shown("01", lesson.steps[index + 1].title)
    assert truth is not None
    for role in ROLES.values():
        largest = float(seen[role].distance.max())
        assert max(getattr(truth, role)) == pytest.approx(largest, rel=0.02)
