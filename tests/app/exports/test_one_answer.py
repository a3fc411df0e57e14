"""An answer is one event: the lab's notes and the site's, the class's record, the grade and what a
learning platform is told say the same of it."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import pytest
from pytest import approx

from onpath.app.classroom.classroom import Member
from onpath.app.common.product import product_version
from onpath.app.exports.site import step_data
from onpath.app.exports.site.step_data import site_step
from onpath.app.lab.lesson_state import LessonState, Sent
from onpath.lessons.course import REFERENCE, Course, read_course, read_references
from onpath.lessons.given import Answer, Given
from onpath.lessons.progress import Notes, Progress, Truth
from onpath.lessons.second_try import SECOND_TRY
from onpath.lessons.words import ENGLISH
from onpath.models.errors import CodedError
from tests.support.lesson_texts import LESSON, write_lesson
from tests.support.node_page import judging_page, needs_node
from tests.support.record import record

pytestmark = needs_node
NAME, TASK = "01-a", "hold"
NUMBER = """
```number
question = "How many?"
number = 60
tolerance = 0.5
answer = "60."
```
"""
SECOND = """second.question = "Why?"
second.options = [
  { text = "so", answer = "So." },
  { text = "thus", answer = "Thus.", right = true },
]
"""
SECOND_NUMBER = """second.question = "How far?"
second.number = 5
second.tolerance = 0.5
second.answer = "Five."
"""
SAME = ("item", "attempt", "answer", "number", "right", "hints", "way", "lesson", "product")
PLAYED = """([page, moves]) => {
    const values = {}, told = []
    const API = globalThis.API_1484_11 = {
        Initialize: () => "true", Terminate: () => "true", Commit: () => "true",
        GetValue: name => name.endsWith("_count") ? String(told.length) : values[name] ?? "",
        SetValue: (name, value) => {
            const [, at, field] = /interactions\\.(\\d+)\\.(\\w+)/.exec(name) ?? []
            if (at === undefined) values[name] = value
            else (told[at] ??= {})[field] = value
            return "true"
        },
        GetLastError: () => "0", GetErrorString: () => "",
    }
    const platform = ScormProgress.found({version: "2004", partial: true}, () => {})
    const student = new LocalStudent(page, platform)
    for (const [name, ...given] of moves) student[name](...given)
    return {notes: student.notes, told, score: gradeOf(page.steps, student.notes).score}
}"""


@pytest.fixture
def course(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Course:
    monkeypatch.setattr(step_data, "figure_of", lambda figure, words: {})
    text = LESSON.replace('question = "Which?"', f'{SECOND_NUMBER}question = "Which?"')
    write_lesson(tmp_path, text.replace('question = "And?"', f'{SECOND}question = "And?"') + NUMBER)
    found, problems = read_course([tmp_path])
    assert not problems
    return found


def moved(rng: np.random.Generator) -> list[list[Any]]:
    """What a student does, as calls of a `Student` of the page."""
    moves, hints = list[list[Any]](), 0
    for _ in range(rng.integers(1, 16)):
        option = int(rng.integers(2))
        drawn = {"times": [0.0, 1.0], "values": [0.0, float(rng.integers(3))]}
        kinds: list[list[Any]] = [
            ["predicts", 1, {} if option else drawn],
            ["predicts", 3, {"option": option, "sure": "certain"}],
            ["chooses", "7.0", option],
            ["gives", "7.1", (60.0, 30.0, 59.5)[int(rng.integers(3))]],
            ["chooses", "7.0.second", option],
            ["gives", "3.0.second", float(5 + option)],
            ["sees", 4, 3, {"times": [0.0], "tracker": [0.0], "follower": [0.0]}],
            ["pass", TASK, float(rng.integers(3)), 0],
            ["reads", TASK, hints + 1],
        ]
        moves.append(kinds[int(rng.integers(len(kinds) - (hints == 2)))])
        hints += moves[-1][0] == "reads"
    return moves


def in_a_lab(course: Course, moves: list[list[Any]]) -> tuple[Notes, list[list[Any]]]:
    """The notes of a lab in which the same is done, and what it has not refused: a second try
    before its question was missed, and another answer after it, which no page offers.
    """
    run = LessonState(course, Progress(lesson=NAME, notes={NAME: Notes(step=6)}))
    done = list[list[Any]]()
    for move in moves:
        try:
            do_in_a_lab(run, *move)
        except CodedError:
            assert move[0] in ("chooses", "gives")
        else:
            done.append(move)
    return run.notes, done


def do_in_a_lab(run: LessonState, name: str, item: Any, *said: Any) -> None:
    second = str(item).endswith(SECOND_TRY)
    match name:
        case "predicts":
            run.note_answer(msgspec.convert(said[0], Answer), Sent(NAME, item))
        case "sees":
            truth = msgspec.convert({"quantity": "distance", **said[1]}, Truth)
            run.note(truths={str(said[0]): truth})
        case "chooses":
            run.answer_quiz(0, said[0], Sent(NAME, 7), second=second)
        case "gives":
            step, block = map(int, item.split(".")[:2])
            run.answer_number(block, said[0], Sent(NAME, step), second=second)
        case "reads":
            run.hint(TASK)
        case _:
            run.note_passed(TASK, *said)


def of_lab(given: Given) -> dict[str, Any]:
    stored = json.loads(msgspec.json.encode(given))
    return {name: each for name, each in stored.items() if name in SAME}


def of_page(given: dict[str, Any]) -> dict[str, Any]:
    """The same fields, without those that have their defaults."""
    answer = {} if "answer" not in given else {"answer": given["answer"]}
    found = {name: each for name, each in given.items() if name in SAME and name != "attempt"}
    return found | answer | ({"attempt": given["attempt"]} if given["attempt"] > 1 else {})


def score_of(notes: Notes) -> float | None:
    """A right first answer counts in full, a right second one or a second try half, a task without
    its recipe.
    """
    points = list[float]()
    for item in ("7.0", "7.1"):
        right = [each.right for each in notes.by_item.get(item, ())]
        right[1:2] = [each.right for each in notes.by_item.get(f"{item}.second", ())] or right[1:2]
        points.append(1.0 if right[:1] == [True] else 0.5 if right[1:2] == [True] else 0.0)
    passed = notes.by_item.get(TASK, ())
    points.append(float(bool(passed) and passed[0].hints < 2))
    judged = notes.by_item.keys() & {"7.0", "7.1", TASK}
    return sum(points) / len(points) if judged else None


def test_all_readers_of_an_answer_say_the_same(course: Course, tmp_path: Path) -> None:
    """Whatever a student does, in whatever order."""
    rng, seen, tried = np.random.default_rng(5), 0, set[str]()
    lesson = course.lesson(NAME, "en")
    references, _ = read_references(lesson, tmp_path / NAME / REFERENCE)
    steps = [site_step(lesson, i, references, ENGLISH).data for i in range(len(lesson.steps))]
    data = {"words": {}, "lesson": NAME, "version": lesson.version, "product": product_version()}
    asked = json.loads(json.dumps({**data, "steps": steps}))
    page = judging_page()
    for _ in range(60):
        moves = moved(rng)
        notes, done = in_a_lab(course, moves)
        found = page.evaluate(PLAYED, [asked, done])
        events = [of_lab(each) for each in notes.given]
        seen += len(events)
        tried |= notes.by_item.keys()
        assert [of_page(each) for each in found["notes"]["given"]] == events

        rows = record([Member(1, "Ada", Progress(notes={NAME: notes}))], course)["Answers"]
        kept = [row for row in rows if row["attempt"] != ""]
        assert sorted(map(said_by_row, kept)) == sorted(map(said, notes.given))

        assert found["score"] == (None if (score := score_of(notes)) is None else approx(score))

        told = {each["id"]: each for each in found["told"]}
        for each in notes.given:
            one = told[f"{NAME}.{each.item}.{each.attempt}"]
            judged = each.right is not None and each.item[0] != "3"  # predictions do not count
            verdict = {True: "correct", False: "incorrect"}[bool(each.right)]
            assert one["result"] == (verdict if judged else "neutral")
            assert json.loads(one["description"])["hints"] == each.hints
    page.close()
    assert seen > 200 and {"7.0.second", "3.0.second"} <= tried


def said(given: Given) -> tuple[Any, ...]:
    """What the class's record says of an answer."""
    option = None if given.answer is None else given.answer.option
    chosen = "" if option is None else "AB"[option]
    value = "" if given.number is None or given.item == TASK else given.number
    right = "" if given.right is None else float(given.right)
    return given.attempt, chosen, str(value), str(right), given.lesson


def said_by_row(row: dict[str, Any]) -> tuple[Any, ...]:
    return (
        row["attempt"],
        row["chosen"],
        str(row["value"]),
        str(row["right"]),
        row["lesson version"],
    )
