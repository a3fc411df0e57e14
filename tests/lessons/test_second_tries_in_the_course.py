"""What the course asks after a wrong answer; numbers are right by a formula, and by a run."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import onpath
from onpath.lessons.adaptive.branches import question_before
from onpath.lessons.schema import Choice, NumberQuestion, Quiz, Text
from tests.support.built_in import built_in_course

LESSONS = built_in_course()[0].lessons
NUMBERS = {
    "01-path-or-timetable": [30 * (1 - math.cos(math.pi / 2))],
    "01b-let-the-clock-wait": [6.28 * 50, 200 * 0.05],
    "02-what-is-the-error": [12, 30**2 / 60, 60**2 / 30],
    "03-the-five-bar": [math.sqrt(1 - (320 / 400) ** 2), 100 * 90 / 200],
    "04-across-and-along": [40 * (1 + 20 * 0.2) * math.exp(-20 * 0.2), 90, 2 * (6 - 3)],
    "04b-poles-and-gains": [np.roots([1, 60, 900]).real[0], 2500 * 2.5e-3],
    "05-invariance": [300 / (math.e * math.sqrt(400)), 200],
    "06-exact-cancellation": [
        0.4 * 50 * math.tau**2 / (0.6 * 1600 - 0.4 * math.tau**2),
        0.3 - 5 * 0.02,
        2 * 400,
        2**2 * 1.0,
    ],
    "06b-friction-and-the-integral": [
        0.1 / 0.09,
        1e3 * (1.6 - 1.2) / 400,
        1.0 * 400 / 1000,
        1000 * 11 * 4 / 400,
    ],
    "07-flexible-link": [1 / 1.25, 2 * 5, 0.723 / 0.5],
    "07b-where-the-theorem-decides": [0.06 * 0.1 * (0.1 + 0.1) / 0.01, 2 * (3 - 2)],
    "08-challenge": [0.66 / 2**2, math.sqrt(0.5 / 2)],
    "09-read-the-paper": [
        -0.2 * math.sin(math.radians(30)) / 0.02 * 0.1,
        math.sqrt(50**2 + 1600) - 50,
        2 * 50,
        math.pi - 1,
    ],
    "09b-the-theorem-and-section-iii": [10 * 6.28 / math.pi],
    "09c-sections-iv-and-v": [100 * (1 - 0.06) ** 10, -2 + 4 * math.exp(-5 * 0.4)],
}
"""Of each lesson, the answers to the second tries that ask for a number, in their units."""
EXACT: dict[str, Any] = {"K3": 0.0}


def asked(name: str, language: str = "en") -> list[Choice | Quiz]:
    """The questions of a lesson that have a wrong answer and count."""
    steps = built_in_course()[0].lesson(name, language).steps
    blocks = [block for step in steps for block in step.blocks if isinstance(block, Choice | Quiz)]
    return [each for each in blocks if isinstance(each, Choice) or not each.warm_up]


@pytest.mark.parametrize("name", LESSONS)
def test_every_question_has_a_second_try_with_its_own_number(name: str) -> None:
    seconds = [each.second for each in asked(name)]
    numbers = [second.asked for second in seconds if second is not None]
    found = [each for each in numbers if isinstance(each, NumberQuestion)]
    assert None not in seconds and len(found) == len(NUMBERS[name])
    for question, right in zip(found, NUMBERS[name], strict=True):
        assert abs(question.number - right) < 0.7 * question.tolerance, question.question


@pytest.mark.parametrize("name", LESSONS)
def test_a_wrong_prediction_is_taken_up_in_the_run_after_it(name: str) -> None:
    """And nothing is said of it on its own page, where it is not judged yet."""
    for lesson in built_in_course()[0].lessons[name].values():
        steps = lesson.steps
        texts = [
            (step.kind, question_before(steps, index, number))
            for index, step in enumerate(steps)
            for number, block in enumerate(step.blocks)
            if isinstance(block, Text) and block.when == "wrong"
        ]
        choices = [block for step in steps for block in step.blocks if isinstance(block, Choice)]
        taken_up = {found[1]: kind for kind, found in texts if found is not None}
        assert {taken_up.get(choice) for choice in choices} <= {"run"}


def test_those_about_the_lab_are_what_it_does() -> None:
    light: dict[str, Any] = {"error_M11": -40.0, "error_M22": -40.0, "K1": 1600.0, "K2": 80.0}
    lap = onpath.simulate(duration=4.0, **light, **EXACT)
    outside = 1e3 * lap.distance[-1000:].mean()
    assert outside == pytest.approx(answer("06-exact-cancellation", 0), abs=0.05)
    across = onpath.simulate(duration=0.3, velocity=(0.0, 0.3), **EXACT)
    assert 1e3 * across.distance.max() == pytest.approx(answer("05-invariance", 0), abs=0.06)
    free = onpath.simulate(duration=2.0, velocity=(0.2, 0.0), K5=0.0, **EXACT)
    assert 1e3 * free.speed[-1] == pytest.approx(answer("05-invariance", 1), abs=2.0)


def answer(name: str, index: int) -> float:
    """The number that a second try of a lesson asks for."""
    found = [each.second.asked for each in asked(name) if each.second is not None]
    return [each.number for each in found if isinstance(each, NumberQuestion)][index]
