"""What a class's record tells of who a student is, and what it gives points for."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from msgspec.structs import replace

from onpath.app.classroom.admission import WORD_DIGITS, word_hash
from onpath.app.classroom.class_state import from_stored, to_stored
from onpath.app.classroom.classroom import Member
from onpath.app.classroom.grade_list import grade_sheet
from onpath.lessons.course import Course, read_course
from onpath.lessons.given import Answer, Given
from onpath.lessons.progress import Notes, Progress
from tests.app.classroom.teaching.test_teacher_form import FIRST, SECOND, Desk
from tests.support.lesson_texts import LESSON, write_lesson
from tests.support.record import sheets

NAME = "01-a"
ASKED = {"1": "sketch", "3": "choice", "7.0": "quiz"}
ITEMS = (*ASKED, "hold", "2", "9.9")  # a task, and what does not exist
SEVERAL = st.lists(
    st.builds(
        Given,
        item=st.sampled_from(ITEMS),
        attempt=st.integers(1, 3),
        answer=st.none() | st.builds(Answer, option=st.none() | st.integers(0, 2)),
        number=st.none() | st.floats(-9, 9),
        right=st.none() | st.booleans(),
        hints=st.integers(0, 3),
    ),
    max_size=12,
)
MAILS = st.sampled_from(["", "a@x.example", "b@x.example"])


@pytest.fixture(scope="module")
def course(tmp_path_factory: pytest.TempPathFactory) -> Course:
    folder: Path = tmp_path_factory.mktemp("course")
    write_lesson(folder, LESSON)
    return read_course([folder])[0]


@given(st.lists(st.tuples(MAILS, SEVERAL), max_size=4))
def test_points_are_for_what_was_answered_and_never_for_being_right(
    course: Course, students: list[tuple[str, list[Given]]]
) -> None:
    def rows(wrong: bool) -> list[dict[str, object]]:
        members = list[Member]()
        for at, (mail, several) in enumerate(students, 1):
            progress = progress_of([wrong_of(each) for each in several] if wrong else several)
            members.append(Member(at, f"Lise {at}", progress, identification=mail))
        sheet = grade_sheet(members, course, "en", "email")
        assert sheet is not None and sheet.columns[0] == "Email address"
        return [dict(row) for row in sheet.rows]

    found = rows(wrong=False)
    assert found == rows(wrong=True)
    assert "Lise" not in str(found)
    best = dict[str, int]()
    for mail, several in students:
        done = {e.item for e in several if not e.is_skipped} & set(ASKED)
        if mail:
            best[mail] = max(best.get(mail, 0), round(100 * len(done) / len(ASKED)))
    assert {row.pop("Email address"): [*row.values()] for row in found} == {
        mail: [points] for mail, points in best.items()
    }


def progress_of(several: list[Given]) -> Progress:
    return Progress(notes={NAME: Notes(given=tuple(several))})


def wrong_of(given: Given) -> Given:
    """The same answer, to which another option is right."""
    return replace(given, right=None if given.right is None else not given.right)


def test_nobody_is_asked_unless_the_teacher_does_and_it_ends_with_the_question() -> None:
    desk = Desk()
    room = desk.room
    room.identify(FIRST, "a@x.example")
    assert not room.members()[FIRST].identification and desk.values["asks"] == ""
    assert "class.grades" not in desk.fields
    desk.set("asks", "email")
    assert "class.grades" in desk.fields
    room.identify(FIRST, " a@x.example\n\x00 ")
    assert room.members()[FIRST].identification == "a@x.example"
    stored = from_stored(to_stored(room.state, 0.0), lambda _: Progress(), 0.0)
    assert (stored.asks, stored.members[FIRST].identification) == ("email", "a@x.example")
    desk.lead("record")
    (data,) = desk.files.values()
    book = sheets(data)
    assert [row["Email address"] for row in book["Grades"]] == ["a@x.example"]
    assert "a@x.example" not in str({name: rows for name, rows in book.items() if name != "Grades"})
    desk.set("asks", "nothing that exists")
    assert room.state.asks == "email"
    desk.set("asks", "")
    assert not room.members()[FIRST].identification
    desk.lead("record")
    assert "Grades" not in sheets(desk.files.popitem()[1])


@given(st.text(min_size=1, max_size=30), st.text(min_size=1, max_size=30))
def test_a_word_links_and_its_hash_says_nothing_without_the_key(word: str, other: str) -> None:
    keys = "k7mf2xqa9tzr", "bn4ws8cd3vyp"
    found = set[str]()
    for key in keys:
        try:
            hashed = word_hash(key, word)
        except ValueError:
            return
        assert word_hash(key, f" {word.upper().lower()} ") == word_hash(key, word.upper().lower())
        if hashed:
            assert len(hashed) == WORD_DIGITS and word not in hashed
            found.add(hashed)
    assert len(found) in (0, len(keys))


def test_two_students_with_one_word_are_one_in_the_test_without_names() -> None:
    desk = Desk()
    room = desk.room
    before = room.members()
    room.link(FIRST, "Grüner Kaktus 7")
    with pytest.raises(ValueError):
        room.link(SECOND, "short")
    room.link(SECOND, "grüner kaktus7")
    words = [each.word for each in room.members().values()]
    assert words[0] == words[1] != ""
    assert [replaced(each) for each in room.members().values()] == list(before.values())
    stored = from_stored(to_stored(room.state, 0.0), lambda _: Progress(), 0.0)
    assert stored.members[FIRST].word == words[0] and "Kaktus" not in str(stored)
    room.link(SECOND, "  ")
    assert not room.members()[SECOND].word


def replaced(member: Member) -> Member:
    return dataclasses.replace(member, word="")
