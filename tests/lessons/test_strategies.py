"""No strategy that reads no physics is right more or less often than chance.

The distribution of a rate is compared with counting all places where the right options can be; the
strategies are tried with questions in which they always find the right option.
"""

from __future__ import annotations

from itertools import product

import pytest
from hypothesis import given
from hypothesis import strategies as st

from onpath.lessons.course import Course
from onpath.lessons.schema import Front, Lesson, Option, Quiz, Step
from onpath.lessons.strategies import ALLOWED, FEWEST, STRATEGIES, rate, rates
from tests.support.built_in import built_in_course

marks = st.lists(st.booleans(), min_size=2, max_size=4)


@given(st.lists(marks, min_size=1, max_size=4))
def test_a_rate_has_the_mean_and_deviation_of_chance(questions: list[list[bool]]) -> None:
    places = list(product(*(range(len(each)) for each in questions)))
    found = [rate("", "", zip(questions, at, strict=True)) for at in places]
    mean = sum(each.right for each in found) / len(found)
    square = sum((each.right - mean) ** 2 for each in found) / len(found)
    assert all(each.chance == pytest.approx(mean, abs=1e-12) for each in found)
    assert all(each.deviation == pytest.approx(square**0.5, abs=1e-7) for each in found)


def test_the_built_in_questions_cannot_be_answered_by_their_form() -> None:
    course, problems = built_in_course()
    found = rates(course)
    assert not problems
    assert [f"{each.group} {each.strategy} {each}" for each in found if each.suspicious] == []
    assert {each.group.split()[0] for each in found} == set(course.languages())


TELLING = {
    "shortest": ("it stops", "it will go on for a while", "it will go on for some time"),
    "longest": ("it goes on along the path", "it stops", "it turns"),
    "middle": ("it goes on", "it", "it goes on for ever and ever"),
    "most numbers": ("1 to 2 mm", "3 mm", "some mm"),
    "never/always": ("It never stops", "It stops", "It turns"),
    "odd one out": ("a b", "it turns left", "it turns right"),
    "with a reason": ("It stops, since it is heavy", "It stops", "It turns"),
    "place A": ("It goes", "It stops", "It turns"),
}
"""For some strategies, options of which it takes the first."""


def _course(texts: tuple[str, ...], count: int) -> Course:
    options = tuple(Option(text=t, answer="", right=not i) for i, t in enumerate(texts))
    blocks = (Quiz(question="?", options=options),) * count
    step = Step(kind="quiz", title="", line=1, blocks=blocks)
    front = Front(title="", summary="")
    return Course({"a": {"en": Lesson(name="a", language="en", front=front, steps=(step,))}})


@pytest.mark.parametrize("name", TELLING)
def test_a_strategy_that_is_always_right_is_found(name: str) -> None:
    course = _course(TELLING[name], FEWEST)
    (found,) = [each for each in rates(course) if (each.strategy, each.count) == (name, FEWEST)]
    assert found.right == FEWEST
    assert found.suspicious
    assert str(found).endswith("!")
    assert not any(each.suspicious for each in rates(_course(TELLING[name], FEWEST - 1)))


@given(st.lists(st.text(max_size=30), min_size=2, max_size=4), st.sampled_from(["en", "de", "fr"]))
def test_a_strategy_marks_each_option_or_not(texts: list[str], language: str) -> None:
    options = [Option(text=each, answer="") for each in texts]
    for name, strategy in STRATEGIES.items():
        found = strategy(options, language)
        assert len(found) == len(options), name
        same = strategy(
            [Option(text=f"<em>{each.text}</em>", answer="") for each in options], language
        )
        assert "<" in "".join(texts) or "&" in "".join(texts) or same == found, name


def test_a_rate_on_the_border_is_by_chance() -> None:
    four = [([True, False], 0)] * 3 + [([True, False], 1)]
    found = rate("", "", four)
    assert found.right - found.chance == 1 < ALLOWED * found.deviation
    assert not found.suspicious
