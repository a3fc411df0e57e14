"""Each student is shown the options of a question in an order of their own, always the same."""

from __future__ import annotations

from collections import Counter
from itertools import permutations

from hypothesis import given
from hypothesis import strategies as st

from onpath.lessons.option_order import LETTERS, option_order

names = st.text(max_size=20)


@given(st.integers(0, len(LETTERS)), names, names)
def test_an_order_shows_each_option_once_and_is_the_same_again(
    count: int, question: str, student: str
) -> None:
    order = option_order(count, question, student)
    assert sorted(order) == list(range(count))
    assert order == option_order(count, question, student)


@given(st.integers(0, len(LETTERS)), names)
def test_without_a_student_it_is_the_authors(count: int, question: str) -> None:
    assert option_order(count, question, "") == tuple(range(count))


def test_no_order_is_preferred_and_questions_are_independent() -> None:
    """Each of the 3! orders is as likely as the others: within five standard deviations."""
    students = [f"student {number}" for number in range(6000)]
    for question in ("a 1", "a 2.0"):
        found = Counter(option_order(3, question, student) for student in students)
        assert set(found) == set(permutations(range(3)))
        assert all(abs(number - 1000) < 5 * (6000 * 5 / 36) ** 0.5 for number in found.values())
    same = sum(option_order(3, "a 1", s) == option_order(3, "a 2.0", s) for s in students)
    assert abs(same - 1000) < 5 * (6000 * 5 / 36) ** 0.5
