"""The concept test of a class: teacher's page and CSV record know the gain, and no names."""

from __future__ import annotations

import pytest

from onpath.app.classroom.class_html import choices_view
from onpath.app.classroom.classroom import Member
from onpath.app.classroom.concept_test_results import (
    gain_view,
    item_distribution,
    question_at,
    sheets_without_names,
)
from onpath.lessons.concept_test.concept_test import AFTER, BEFORE, questions
from onpath.lessons.progress import Notes, Progress
from onpath.lessons.words import ENGLISH
from tests.support.built_in import built_in_course
from tests.support.given import notes_with
from tests.support.record import Row, record

COURSE = built_in_course()[0]
TEST = COURSE.lesson(BEFORE, "en")
ASKED = questions(TEST)
CODE = "abcd"


def sat(right: int) -> Notes:
    """Notes of a student who answers the first questions rightly, and leaves out the last one."""
    chosen = dict[str, int]()
    for number, (key, block) in enumerate(list(ASKED.items())[:-1]):
        good = number < right
        chosen[key] = next(i for i, o in enumerate(block.options) if o.right == good)
    return notes_with(quiz=chosen, handed_in=True)


WAYS = {
    "session one": Progress(notes={BEFORE: sat(3), AFTER: sat(9), "01-path-or-timetable": Notes()}),
    "session two": Progress(notes={BEFORE: sat(6), AFTER: sat(6)}),
    "session three": Progress(notes={BEFORE: sat(0)}),
    "session four": Progress(),
}
MEMBERS = [Member(n, f"Nick {n}", way) for n, way in enumerate(WAYS.values(), 1)]
GAIN = (62.5 - 37.5) / (100 - 37.5)  # of the two who have handed in both


def rows() -> tuple[list[Row], list[Row]]:
    """The sheet of the tests, and that of the class."""
    found = record(MEMBERS, COURSE, sheets_without_names(TEST, list(WAYS.items()), CODE))
    assert not {BEFORE, AFTER} & {row["lesson"] for row in found["Answers"]}
    return found["Concept test"], found["Concept test, class"]


def test_the_record_has_the_gain_and_every_answer_in_the_author_s_letters() -> None:
    items, of_class = rows()
    found = {row["of"]: row for row in of_class}
    assert found["normalised gain"]["value"] == pytest.approx(GAIN)
    assert {row["students"] for row in of_class} == {2}
    assert len(items) == 5 * 12
    assert sum(row["result"] == "open" for row in items) == 5
    for row in items:
        block = question_at(TEST, int(row["question"]) - 1)
        letters = [option.right for option in block.options]
        at = "ABCD".find(str(row["chosen"])) if row["chosen"] else -1
        assert row["right"] == (at >= 0 and letters[at])


def test_the_record_has_neither_number_nor_nickname_beside_a_test() -> None:
    items, of_class = rows()
    assert not {"number", "nickname"} & {key for row in (*items, *of_class) for key in row}
    names = [str(row["pseudonym"]) for row in items]
    assert len(set(names)) == 3
    assert not any("Nick" in name or "session" in name for name in names)
    assert names == sorted(names)  # not the order in which they joined


def test_the_teacher_sees_the_gain_and_both_distributions() -> None:
    ways = list(WAYS.values())
    hidden, shown = (gain_view(TEST, ways, revealed, ENGLISH) for revealed in (False, True))
    assert f"{GAIN:.2f}" in hidden and "38 % before, 62 % after" in hidden
    assert "3 of 4 have handed in the test before" in hidden
    first = next(iter(ASKED.values())).misconception
    assert str(first) in shown and str(first) not in hidden
    assert "Nick" not in shown
    before, after = (item_distribution(TEST, 3, name, ways) for name in (BEFORE, AFTER))
    assert (sum(before.counts), before.waiting) == (3, 1)
    assert (sum(after.counts), after.waiting) == (2, 2)
    left_out = item_distribution(TEST, 11, BEFORE, ways)
    assert (sum(left_out.counts), left_out.skipped) == (0, 3)
    rounds = [("Once", before), ("Again", after)]
    page = choices_view(question_at(TEST, 3), rounds, False, ENGLISH)
    pairs = zip(before.counts, after.counts, strict=True)
    bars = [f"<b>{count}</b>" for pair in pairs for count in pair]
    assert [part for part in page.split() if part in bars] == bars
    assert page.index("Once") < page.index("Again")
