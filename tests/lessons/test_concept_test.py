"""The concept test as it is written, and the gain of a class."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from markupsafe import Markup
from msgspec.structs import replace

from onpath.lessons.concept_test.concept_test import (
    AFTER,
    BEFORE,
    FOLDER,
    TESTS,
    both_tests,
    questions,
    right_in,
)
from onpath.lessons.concept_test.gain import class_gain, normalised_gain
from onpath.lessons.course import BUILT_IN, Course, read_course
from onpath.lessons.parse import read_lesson
from onpath.lessons.problems import LessonError
from onpath.lessons.progress import Notes, Progress
from onpath.lessons.schema import Lesson
from tests.support.built_in import built_in_course
from tests.support.given import notes_with

COURSE, PROBLEMS = built_in_course()
TEST = COURSE.lesson(BEFORE, "en")
FRONT = '+++\ntitle = "A"\nsummary = "B"\n+++\n\n'
ITEM = """# quiz: One

```quiz
question = "Is it?"
options = [{ text = "Yes", right = true, answer = "So." }, { text = "No", answer = "Not so." }]
```
"""
answers = st.lists(st.booleans(), min_size=len(questions(TEST)), max_size=len(questions(TEST)))


def handed_in(test: Lesson, right: Sequence[bool]) -> Notes:
    """Notes on a test in which some questions are answered rightly, and the others wrongly."""
    chosen = {
        key: next(i for i, option in enumerate(block.options) if option.right == good)
        for (key, block), good in zip(questions(test).items(), right, strict=True)
    }
    return notes_with(quiz=chosen, handed_in=True)


def both(before: Sequence[bool], after: Sequence[bool]) -> Progress:
    """A student who has handed in both tests."""
    return Progress(notes={BEFORE: handed_in(TEST, before), AFTER: handed_in(TEST, after)})


def test_there_are_twelve_questions_one_for_each_misconception_in_every_language() -> None:
    assert not PROBLEMS and list(COURSE.tests) == list(TESTS)
    assert not set(TESTS) & set(COURSE.lessons)
    for name in TESTS:
        assert set(COURSE.tests[name]) == set(COURSE.languages())
        for test in COURSE.tests[name].values():
            asked = questions(test).values()
            assert test.name == name and len(asked) == 12
            assert len({block.misconception for block in asked} - {""}) == 12
            assert all(len(block.options) == 4 for block in asked)
            assert len({option.text for block in asked for option in block.options}) == 48


@pytest.mark.parametrize("language", COURSE.languages())
def test_no_rule_of_thumb_finds_the_right_answers(language: str) -> None:
    """Every place is right three times; the longest or shortest option is not mostly right."""
    found: Counter[object] = Counter()
    asked = questions(COURSE.lesson(BEFORE, language)).values()
    for block in asked:
        sizes = [len(Markup(option.text).striptags()) for option in block.options]
        for place, option in enumerate(block.options):
            rules = (place, *(most for most in (max, min) if sizes[place] == most(sizes)))
            found.update(rules if option.right else ())
    assert [found[place] for place in range(4)] == [3] * 4
    assert found[max] <= 4 and found[min] <= 4, found


def test_a_test_has_questions_only(tmp_path: Path) -> None:
    file = tmp_path / FOLDER / "en.md"
    file.parent.mkdir()
    file.write_text(FRONT + ITEM, "utf-8")
    assert len(questions(read_lesson(file))) == 1
    run = "# run: Two\n\n```script\nuntil = 2.0\n```\n"
    for bad in ("", "# explain: Words\n\nWords.\n", ITEM + run, ITEM + ITEM[ITEM.index("```") :]):
        file.write_text(FRONT + bad, "utf-8")
        with pytest.raises(LessonError, match="test"):
            read_lesson(file)


@pytest.mark.thorough
def test_a_course_may_have_a_test_of_its_own_or_none(tmp_path: Path) -> None:
    (tmp_path / FOLDER).mkdir()
    (tmp_path / FOLDER / "en.md").write_text(FRONT + ITEM, "utf-8")
    course, problems = read_course([BUILT_IN, tmp_path])
    assert not problems and len(questions(course.lesson(AFTER, "en"))) == 1
    assert both_tests({}) == {} and not Course({}).has(BEFORE)


# The gain.


@given(st.floats(0, 99.9), st.floats(0, 100))
def test_the_gain_is_the_learned_part_of_what_was_not_known(before: float, after: float) -> None:
    gain = normalised_gain(before, after)
    assert gain is not None and gain <= 1.0 + 1e-9
    assert before + gain * (100 - before) == pytest.approx(after, abs=1e-9)
    assert (gain > 0) == (after > before)


def test_nothing_can_be_gained_by_those_who_know_all() -> None:
    assert normalised_gain(100.0, 100.0) is None and normalised_gain(None, 50.0) is None


@given(st.lists(st.tuples(answers, answers), min_size=1, max_size=5))
def test_the_class_s_means_are_those_of_its_students(
    ways: list[tuple[list[bool], list[bool]]],
) -> None:
    found = class_gain(TEST, [both(*way) for way in ways])
    assert found.students == len(ways)
    for place, mean in enumerate((found.mean_before, found.mean_after)):
        right = [each for way in ways for each in way[place]]
        assert mean == pytest.approx(100 * sum(right) / len(right))
    assert found.gain == normalised_gain(found.mean_before, found.mean_after)


def test_only_students_who_handed_in_both_count_and_a_missing_answer_is_wrong() -> None:
    all_right, none = [True] * 12, [False] * 12
    half = Progress(notes={BEFORE: handed_in(TEST, none)})
    open_still = both(none, all_right)
    after = replace(open_still.notes[AFTER], handed_in=False)
    open_still = replace(open_still, notes={**open_still.notes, AFTER: after})
    nothing = class_gain(TEST, [half, open_still, Progress()])
    assert (nothing.students, nothing.gain, nothing.mean_before) == (0, None, None)
    found = class_gain(TEST, [half, both(none, all_right)])
    assert (found.students, found.mean_before, found.mean_after, found.gain) == (1, 0, 100, 1)
    empty = Notes(handed_in=True)
    assert right_in(TEST, empty) == none
    gone = notes_with(quiz={"0.1": 99, "77.0": 0}, handed_in=True)  # of another version of the test
    assert right_in(TEST, gone) == none
