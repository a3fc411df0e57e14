"""The record of a class opens in columns, holds one type in each, and no formula."""

from __future__ import annotations

import zipfile
from datetime import UTC, datetime
from io import BytesIO

import pytest
from hypothesis import given
from hypothesis import strategies as st
from msgspec.structs import replace

from onpath.app.classroom.class_record import ANSWERS, Sheet, class_record, workbook
from onpath.app.classroom.classroom import Member
from onpath.app.lab.lesson_state import LessonState, Sent
from onpath.lessons.course import Course, read_course
from onpath.lessons.given import Answer, Given
from onpath.lessons.progress import Notes, Progress
from onpath.lessons.votes import Vote
from tests.support.given import notes_with
from tests.support.lesson_texts import LESSON, write_lesson
from tests.support.record import MADE, record, sheets

NUMBERS = {"number", "step", "attempt", "late", "right", "value", "time", "drawn", "hints"}
NAME, CHOICE, QUIZ = "01-a", 3, 7  # of a lesson, and indices of its steps
STARTS = "=+-@|%\t\r\n;,\"'\uff1d\u2212"
hostile = st.builds(
    lambda parts: "".join(parts),
    st.lists(
        st.sampled_from([*STARTS, "a", " ", "cmd|'/C calc'!A0", "HYPERLINK(1)", "1", "_x0041_"]),
        min_size=1,
        max_size=8,
    ),
)
text = st.text(st.characters(exclude_categories=["Cs", "Cc", "Cn", "Co"]), min_size=1, max_size=30)


@pytest.fixture(scope="module")
def course(tmp_path_factory: pytest.TempPathFactory) -> Course:
    folder = tmp_path_factory.mktemp("course")
    write_lesson(folder, LESSON)
    return read_course([folder])[0]


@given(st.lists(hostile | text, min_size=1, max_size=5))
def test_what_students_write_is_text_in_one_cell(cells: list[str]) -> None:
    """No separator splits a cell and no sign makes it a formula, unlike in any reading of a CSV."""
    sheet = Sheet("Answers", ("a", "b"), [{"a": cell, "b": 1.5} for cell in cells])
    found = sheets(workbook([sheet], MADE))["Answers"]
    assert [row["a"] for row in found] == cells
    assert [row["b"] for row in found] == [1.5] * len(cells)


def test_a_column_has_one_type_and_a_lesson_its_title(course: Course) -> None:
    name = next(iter(course.lessons))
    task = Given("hold", number=0.0, right=True, way=0, hints=2)
    noted = notes_with(
        answers={"1": Answer(times=(0.0, 1.0), values=(-1.0, 2.5)), "3": Answer(option=1)},
        second={"3": Answer()},
        hints={"hold": 2},
    )
    notes = replace(noted, given=(*noted.given, task))
    members = [
        Member(1, "=1+1", Progress(notes={name: notes})),
        Member(2, "Hana (late)", Progress(notes={name: Notes(asked_again=("3",))})),
        Member(3, "Bob"),
    ]
    found = record(members, course)
    for rows in (found["Answers"], found["Sketches"], found["Students"]):
        for row in rows:
            assert set(row) <= {*ANSWERS, "time", "drawn"}
            for heading, cell in row.items():
                assert isinstance(cell, float) == (heading in NUMBERS), (heading, cell)
    assert [row["nickname"] for row in found["Students"]] == ["=1+1", "Hana (late)", "Bob"]
    points = [(row["step"], row["time"], row["drawn"]) for row in found["Sketches"]]
    assert points == [(2, 0, -1), (2, 1, 2.5)]
    first = [row for row in found["Answers"] if row["step"] == 4 and row["kind"] == "prediction"]
    assert [(row["result"], row["chosen"]) for row in first] == [("answered", "B"), ("open", "")]
    second = [row for row in found["Answers"] if row["kind"] == "second"]
    assert [row["result"] for row in second] == ["skipped", "open"]
    tasks = [row for row in found["Answers"] if row["kind"] == "task"]
    assert [(row["right"], row["hints"]) for row in tasks] == [(1, 2), (0, 0)]
    title = course.lesson(name, "en").front.title
    assert {row["title"] for row in found["Answers"]} == {title}
    about = {row["of"]: row["is"] for row in found["About"]}
    assert about["made (UTC)"] == "2026-01-01 12:30:00" and about["language"] == "en"


GIVEN = st.lists(
    st.tuples(st.sampled_from(["choice", "quiz"]), st.integers(0, 1), st.integers(0, 200)),
    max_size=8,
)


@given(GIVEN, st.integers(0, 200))
def test_there_is_a_row_for_the_first_two_answers_and_the_last_one_with_time_and_lateness(
    course: Course, moves: list[tuple[str, int, int]], closes: int
) -> None:
    """Answers, in any order of items and options, at increasing times."""
    now = 1e9
    run = LessonState(course, clock=lambda: now)
    given: dict[str, list[tuple[float, int]]] = {"prediction": [], "question": []}
    for kind, option, wait in moves:
        now += wait
        if kind == "choice":
            run.note_answer(Answer(option=option), Sent(NAME, CHOICE))
        else:
            run.answer_quiz(0, option, Sent(NAME, QUIZ))
        before = given["prediction" if kind == "choice" else "question"]
        if not before or before[-1][1] != option:  # the same again is no answer
            before.append((now, option))
    votes = [Vote(NAME, str(CHOICE), CHOICE, closes=1e9 + closes)]
    found = record([Member(1, "Ada", run.progress)], course, votes=votes)["Answers"]
    for kind, step in (("prediction", CHOICE), ("question", QUIZ)):
        rows = [row for row in found if row["step"] == step + 1 and row["kind"] == kind]
        every = list(enumerate(given[kind], 1))
        wanted = [*every[:2], *every[2:][-1:]]
        if not moves:
            assert rows == []
        elif not wanted:
            assert [row["result"] for row in rows] == ["open"]
        else:
            told = [(row["attempt"], row["given (UTC)"], row["chosen"]) for row in rows]
            assert told == [
                (attempt, f"{datetime.fromtimestamp(time, UTC):%Y-%m-%d %H:%M:%S}", "AB"[option])
                for attempt, (time, option) in wanted
            ]
            late = [
                int(time > 1e9 + closes) if kind == "prediction" else "" for _, (time, _) in wanted
            ]
            assert [row["late"] for row in rows] == late


def test_the_same_class_gives_the_same_bytes(course: Course) -> None:
    members = [Member(1, "Ada")]
    one, other = (class_record(members, course, "de", MADE) for _ in range(2))
    assert one == other and zipfile.ZipFile(BytesIO(one)).testzip() is None
