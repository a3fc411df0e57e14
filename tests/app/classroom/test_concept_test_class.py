"""The concept test of a class: teacher's page and record know the gain, and no names."""

from __future__ import annotations

from collections import Counter

import pytest

from onpath.app.classroom.class_html import choices_view
from onpath.app.classroom.class_sync import ClassSync
from onpath.app.classroom.classroom import Classroom, Member
from onpath.app.classroom.concept_test_results import (
    Students,
    gain_view,
    item_distribution,
    question_at,
    sheets_without_names,
)
from onpath.app.classroom.pace_html import whereabouts
from onpath.app.lab import commands as c
from onpath.app.lab.lab import Lab
from onpath.lessons.concept_test.concept_test import AFTER, BEFORE, SITTINGS, name_of, questions
from onpath.lessons.concept_test.estimates import FEWEST
from onpath.lessons.concept_test.gain import class_gain, people
from onpath.lessons.pace import Pace
from onpath.lessons.progress import Notes, Progress
from onpath.lessons.words import ENGLISH
from onpath.models.systems.catalogue import FIVE_BAR
from tests.support.built_in import built_in_course
from tests.support.given import notes_with
from tests.support.lab import do, loop_cache
from tests.support.record import Row, record

COURSE = built_in_course()[0]
FORMS = COURSE.forms("en")
CODE = "abcd"


def sat(form: int, right: int) -> Notes:
    """Notes of a student who answers the first questions rightly, and leaves out the last one."""
    chosen = dict[str, int]()
    for number, (key, block) in enumerate(list(questions(FORMS[form]).items())[:-1]):
        good = number < right
        chosen[key] = next(i for i, o in enumerate(block.options) if o.right == good)
    return notes_with(quiz=chosen, handed_in=True)


def both(first: int, before: int, after: int) -> Progress:
    """A student who has handed in both forms; `first` is the one before the course."""
    sittings = (BEFORE, first, before), (AFTER, 1 - first, after)
    return Progress(notes={name_of(name, form): sat(form, n) for name, form, n in sittings})


HALF = FEWEST // 2
WAYS: dict[str, Progress] = {
    **{f"session a{n}": both(0, 3, 9) for n in range(HALF)},
    **{f"session b{n}": both(1, 6, 6) for n in range(HALF)},
    "session three": Progress(notes={BEFORE: sat(0, 0)}),
    "session four": Progress(),
}
STUDENTS: Students = list(WAYS.items())
MEMBERS = [Member(n, f"Nick {n}", way) for n, way in enumerate(WAYS.values(), 1)]
GAIN = (62.5 - 37.5) / (100 - 37.5)  # of those who have handed in both


def rows(students: Students = STUDENTS) -> tuple[list[Row], list[Row], list[Row]]:
    """The sheets of the tests, of the class and of the questions."""
    found = record(MEMBERS, COURSE, sheets_without_names(FORMS, students, CODE))
    assert not any(row["lesson"] in COURSE.tests for row in found["Answers"])
    return tuple(found[f"Concept test{of}"] for of in ("", ", class", ", questions"))  # type: ignore[return-value]


def test_the_record_has_every_answer_in_the_author_s_letters() -> None:
    tests, _, _ = rows()
    count = len(questions(FORMS[0]))
    assert len(tests) == count * (2 * FEWEST + 1)
    assert Counter((row["test"], row["form"]) for row in tests) == {
        (BEFORE, "A"): count * (HALF + 1),
        (BEFORE, "B"): count * HALF,
        (AFTER, "A"): count * HALF,
        (AFTER, "B"): count * HALF,
    }
    for row in tests:
        block = question_at(FORMS["AB".index(str(row["form"]))], int(row["question"]) - 1)
        at = "ABCD".find(str(row["chosen"])) if row["chosen"] else -1
        assert row["right"] == (at >= 0 and block.options[at].right)
        assert (row["result"] == "open") == (at < 0)


def test_the_record_has_numbers_of_the_class_and_of_each_question_from_twenty_on() -> None:
    for students, told in ((STUDENTS, True), (STUDENTS[1:], False)):
        _, of_class, of_items = rows(students)
        assert [bool(row["low"]) or row["value"] != "" for row in of_class] == [told] * 3
        assert {row["students"] for row in of_class} == {FEWEST if told else FEWEST - 1}
        assert len(of_items) == 2 * 2 * len(questions(FORMS[0]))
        for row in of_items:
            enough = int(row["students"]) >= FEWEST
            assert row["of"] == "discrimination" or (row["value"] != "") == enough
            assert enough or row["value"] == ""
        assert sum(int(row["other bodies"]) for row in of_items) == len(of_items) / 2
    found = {row["of"]: row for row in rows()[1]}
    assert found["normalised gain"]["value"] == pytest.approx(GAIN)


def test_the_record_has_neither_number_nor_nickname_beside_a_test() -> None:
    tests, *others = rows()
    every = [*tests, *others[0], *others[1]]
    assert not {"number", "nickname"} & {key for row in every for key in row}
    names = [str(row["pseudonym"]) for row in tests]
    assert len(set(names)) == FEWEST + 1
    assert not any("Nick" in name or "session" in name for name in names)
    assert names == sorted(names)  # not the order in which they joined


def test_the_teacher_sees_the_gain_and_each_question_from_twenty_on() -> None:
    hidden, shown = (gain_view(FORMS, STUDENTS, revealed, ENGLISH) for revealed in (False, True))
    few = gain_view(FORMS, STUDENTS[1:], True, ENGLISH)
    gain, first = f"<b>{ENGLISH('test.gain', gain=f'{GAIN:.2f}')}", question_at(FORMS[0], 0)
    for view in (hidden, shown):
        assert gain in view and f"{FEWEST + 1} of {FEWEST + 2} have handed in" in view
        assert ENGLISH("test.fewest", count=FEWEST) not in view
    assert first.misconception in shown and first.misconception not in hidden
    assert shown.count("<table") == 3 and ENGLISH("test.discrimination") in shown
    assert gain not in few and ENGLISH("test.fewest", count=FEWEST) in few
    assert "%" not in few.split("<table")[0] and first.misconception not in few
    assert "Nick" not in hidden + shown + few


def test_the_teacher_sees_both_distributions_of_each_form() -> None:
    before, after = (item_distribution(FORMS, 0, 3, sitting, STUDENTS) for sitting in SITTINGS)
    assert (sum(before.counts), before.here, before.waiting) == (HALF + 1, HALF + 1, 0)
    assert (sum(after.counts), after.here, after.waiting) == (HALF, HALF, 0)
    left_out = item_distribution(FORMS, 0, 11, BEFORE, STUDENTS)
    assert (sum(left_out.counts), left_out.skipped) == (0, HALF + 1)
    alone = item_distribution(FORMS[:1], 0, 3, BEFORE, STUDENTS)
    assert (alone.here, alone.waiting) == (FEWEST + 2, HALF + 1)
    rounds = [("Once", before), ("Again", after)]
    page = choices_view(question_at(FORMS[0], 3), rounds, False, ENGLISH)
    pairs = zip(before.counts, after.counts, strict=True)
    bars = [f"<b>{count}</b>" for pair in pairs for count in pair]
    assert [part for part in page.split() if part in bars] == bars
    assert page.index("Once") < page.index("Again")


def test_a_class_gets_each_form_by_halves_and_is_kept_in_both() -> None:
    room, labs = Classroom(), {f"{n:012}": Lab(loop_cache(), FIVE_BAR, COURSE) for n in range(4)}
    for code in labs:
        room.join(code, room.code, code)
    room.push(c.TakeStep(BEFORE, 2))
    room.keep_within(Pace(BEFORE, 1, 3))
    sync = ClassSync(room, lambda code: (labs[code], True))
    for _ in range(2):
        sync.check()
        for lab in labs.values():
            do(lab)
    opened = Counter(lab.lessons.progress.lesson for lab in labs.values())
    assert opened == {BEFORE: 2, name_of(BEFORE, 1): 2}
    assert {lab.lessons.index for lab in labs.values()} == {2}
    progress = [lab.lessons.progress for lab in labs.values()]
    assert whereabouts(FORMS[0], progress).steps[2] == 4
    for lab in labs.values():
        do(lab, c.GoToStep(1), c.GoToStep(1))
        assert lab.lessons.index == 3  # the last one that the teacher has opened
    room.keep_within(None)
    for code, lab in labs.items():
        do(lab, c.KeepWithin(None), c.FinishLesson(), c.TakeStep(AFTER, 0))
        other = name_of(AFTER, 0 if name_of(BEFORE, 1) in lab.lessons.progress.notes else 1)
        assert lab.lessons.progress.lesson == other, code


def test_the_labs_of_a_student_with_a_word_are_one_student() -> None:
    room, labs = Classroom(), {f"{n:012}": Lab(loop_cache(), FIVE_BAR, COURSE) for n in range(6)}
    sync = ClassSync(room, lambda code: (labs[code], True))
    for n, code in enumerate(labs):
        room.join(code, room.code, code)
        room.link(code, f"a long word {n % 3}")  # two labs of each of three students
    for sitting, part in ((BEFORE, list(labs)[:3]), (AFTER, list(labs)[3:])):
        for _ in range(2):
            sync.check()
            for lab in labs.values():
                do(lab)
        for code in part:
            do(labs[code], c.TakeStep(sitting, 0), c.FinishLesson())
    sync.check()
    who = [(member.word, member.progress) for member in room.members().values()]
    known = people(FORMS, who)
    assert len(known) == 3 and class_gain(FORMS, known).students == 3
