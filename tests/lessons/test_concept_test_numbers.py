"""The numbers about a class: shares, gain, discrimination, and their intervals."""

from __future__ import annotations

from math import comb

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from onpath.lessons.concept_test.concept_test import AFTER, BEFORE, SITTINGS, name_of, questions
from onpath.lessons.concept_test.estimates import FEWEST, NORMAL, bootstrapped, share
from onpath.lessons.concept_test.gain import Person, Sitting, class_gain, normalised_gain, people
from onpath.lessons.concept_test.items import discriminations, items
from onpath.lessons.progress import Progress
from onpath.models.arrays import Array
from tests.support.built_in import built_in_course
from tests.support.given import notes_with

FORMS = built_in_course()[0].forms("en")
ITEMS = len(questions(FORMS[0]))


def sat(form: int, right: list[bool] | Array) -> Sitting:
    return Sitting(form, tuple(bool(each) for each in right))


def drawn(random: np.random.Generator, count: int, before: float, after: float) -> list[Person]:
    """A class whose students differ in ability, half of it each way round; form B is harder.

    Args:
        before, after: mean ability, in standard deviations of the class.
    """
    hard = np.linspace(-1, 1, ITEMS)
    found = list[Person]()
    for number, ability in enumerate(random.normal(size=count)):
        first, sittings = number % 2, list[Sitting]()
        for form, mean in ((first, before), (1 - first, after)):
            chance = 1 / (1 + np.exp(-(ability + mean - hard - form)))
            sittings.append(sat(form, random.random(ITEMS) < chance))
        found.append(Person(*sittings))
    return found


@given(st.integers(FEWEST, 300).flatmap(lambda n: st.tuples(st.integers(0, n), st.just(n))))
def test_the_ends_of_wilson_s_interval_are_just_compatible_with_the_share(
    counted: tuple[int, int],
) -> None:
    right, count = counted
    found = share(right, count)
    assert found is not None and found.value == pytest.approx(100 * right / count)
    assert 0 <= found.low <= found.value + 1e-9 and found.value - 1e-9 <= found.high <= 100
    for end in (found.low / 100, found.high / 100):
        away = NORMAL**2 * end * (1 - end) / count
        assert (right / count - end) ** 2 == pytest.approx(away, abs=1e-12)


@pytest.mark.parametrize("count", [FEWEST, 45])
def test_wilson_s_interval_has_the_true_share_about_as_often_as_it_says(count: int) -> None:
    intervals = [share(right, count) for right in range(count + 1)]
    covered = list[float]()
    for p in np.linspace(0.05, 0.95, 91):
        holds = [each is not None and each.low <= 100 * p <= each.high for each in intervals]
        odds = [comb(count, n) * p**n * (1 - p) ** (count - n) for n in range(count + 1)]
        covered.append(float(np.dot(holds, odds)))
    assert 0.945 < np.mean(covered) < 0.965 and min(covered) > 0.88


def test_no_number_is_told_of_fewer_than_twenty() -> None:
    class_ = drawn(np.random.default_rng(1), FEWEST, 0, 1)
    for part, told in ((class_[1:], False), (class_, True)):
        found = class_gain(FORMS, part)
        numbers = [found.before, found.after, found.gain, *(x for q in found.questions for x in q)]
        for form in items(FORMS, part):
            assert {item.count for item in form} == {len(part)}
            numbers += [item.difficulty for item in form]
            assert any(item.discrimination for item in form) == told
        assert found.students == len(part)
        assert [each is not None for each in numbers] == [told] * len(numbers)
        assert all(each is None or each.low <= each.value <= each.high for each in numbers)


def test_a_harder_form_changes_nothing_however_many_have_it_first() -> None:
    """The same share of what is possible in each form, with 20 students one way and 4 the other."""
    a, b = [True] * 6 + [False] * 6, [True] * 3 + [False] * 9
    better = {0: [True] * 9 + [False] * 3, 1: [True] * 6 + [False] * 6}
    ways = [Person(sat(0, a), sat(1, better[1]))] * 20 + [Person(sat(1, b), sat(0, better[0]))] * 4
    found = class_gain(FORMS, ways)
    assert found.before is not None and found.before.value == pytest.approx(37.5)
    assert found.after is not None and found.after.value == pytest.approx(62.5)
    assert found.gain is not None and found.gain.value == pytest.approx(25 / 62.5)


def test_only_students_who_have_handed_in_both_forms_count() -> None:
    one = sat(0, [True] * ITEMS)
    half, same = Person(one, None), Person(one, one)
    assert class_gain(FORMS, [half, same] * 30).students == 0
    assert class_gain(FORMS[:1], [half, same] * 30).students == 30
    assert [item.count for item in items(FORMS[:1], [half, same])[0]] == [2] * ITEMS


def test_the_labs_of_a_student_are_put_together() -> None:
    before, after = (
        Progress(notes={name_of(sitting, form): notes_with(quiz={}, handed_in=True)})
        for form, sitting in enumerate(SITTINGS)
    )
    wrong = (False,) * ITEMS
    both = Person(Sitting(0, wrong), Sitting(1, wrong))
    assert people(FORMS, [("me", before), ("me", after)]) == [both]
    apart = people(FORMS, [("me", before), ("you", after)])
    assert apart == [Person(both.before, None), Person(None, both.after)]
    twice = people(FORMS, [("me", before), ("me", before), ("me", after)])
    assert twice == [both, Person(both.before, None)]  # two students with one word
    assert people(FORMS, [("me", Progress())]) == [Person(None, None)]
    assert {*before.notes, *after.notes} == {BEFORE, name_of(AFTER, 1)}


@given(st.floats(0, 99.9), st.floats(0, 100))
def test_the_gain_is_the_learned_part_of_what_was_not_known(before: float, after: float) -> None:
    gain = float(normalised_gain(np.array(before), np.array(after)))
    assert gain <= 1.0 + 1e-9
    assert before + gain * (100 - before) == pytest.approx(after, abs=1e-9)


def test_nothing_can_be_gained_by_those_who_know_all() -> None:
    all_right = [sat(form, [True] * ITEMS) for form in (0, 1)]
    found = class_gain(FORMS, [Person(*all_right)] * 30)
    assert found.gain is None and found.before is not None and found.before.value == 100


def test_the_gain_s_interval_has_the_true_gain_about_as_often_as_it_says() -> None:
    random = np.random.default_rng(2)
    found = [class_gain(FORMS, drawn(random, 40, -0.5, 0.5)).gain for _ in range(100)]
    gains = [each for each in found if each is not None]
    true = float(np.mean([each.value for each in gains]))
    held = sum(each.low <= true <= each.high for each in gains)
    assert 87 <= held <= 100 == len(gains)  # 95 are expected; fewer than 87 once in a thousand


@given(st.integers(0, 10_000), st.lists(st.integers(2, 9), min_size=1, max_size=2))
def test_discrimination_is_the_correlation_with_the_other_questions_within_groups(
    seed: int, sizes: list[int]
) -> None:
    random = np.random.default_rng(seed)
    groups = [(random.random((size, 5)) < 0.5).astype(float) for size in sizes]
    weights = [random.integers(1, 4, (2, size)).astype(float) for size in sizes]
    found = discriminations(groups, weights)
    for draw in range(2):
        repeated = [
            np.repeat(x, w[draw].astype(int), axis=0) for x, w in zip(groups, weights, strict=True)
        ]
        for item in range(5):
            x = np.concatenate([g[:, item] - g[:, item].mean() for g in repeated])
            rest = [g.sum(axis=1) - g[:, item] for g in repeated]
            y = np.concatenate([each - each.mean() for each in rest])
            spread = float(np.sqrt((x @ x) * (y @ y)))
            if spread < 1e-6:
                assert np.isnan(found[draw, item])
            else:
                assert found[draw, item] == pytest.approx(float(x @ y) / spread, abs=1e-6)


def test_discrimination_tells_a_question_about_ability_from_one_about_nothing() -> None:
    random = np.random.default_rng(3)
    ability, chance = random.normal(size=(400, 1)), random.normal(size=(400, ITEMS))
    right = ability + 0.5 * chance > 0
    right[:, 4] = chance[:, 4] > 0
    found = items(FORMS, [Person(sat(0, row), None) for row in right])
    told = [item.discrimination for item in found[0]]
    assert all(x is not None and (x.low > 0.3) == (at != 4) for at, x in enumerate(told))
    nothing = told[4]
    assert nothing is not None and nothing.low < 0 < nothing.high
    assert {(item.count, item.difficulty) for item in found[1]} == {(0, None)}


def test_a_statistic_that_is_not_defined_is_not_told() -> None:
    def statistic(weights: list[Array]) -> Array:
        return np.stack([weights[0].mean(axis=1), np.full(len(weights[0]), np.nan)], axis=1)

    known, unknown = bootstrapped([30], statistic)  # type: ignore[arg-type]
    assert known is not None and known.value == 1 and unknown is None
