"""The concept test on a student's page: opened from the overview or by the teacher, handed in."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

import pytest

from onpath.app.lab.commands import TakeStep
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.server.lab_server import LabServer
from onpath.app.server.server_options import ServerOptions
from onpath.lessons.concept_test.concept_test import (
    AFTER,
    BEFORE,
    dealt,
    name_of,
    questions,
    sitting_of,
)
from onpath.lessons.option_order import option_order
from onpath.lessons.words import ENGLISH
from tests.support import waiting
from tests.support.built_in import built_in_course
from tests.support.student import Student

COURSE = built_in_course()[0]
wait_for = partial(waiting.wait_for, seconds=30.0)  # only ends a test that would hang
TEST = COURSE.lesson(BEFORE, "en")


@pytest.fixture(scope="module")
def server() -> Iterator[LabServer]:
    server = LabServer("127.0.0.1", 0, LoopCache(), ServerOptions(course=COURSE))
    yield server
    server.stop()


@pytest.fixture
def student(server: LabServer) -> Iterator[Student]:
    with Student(f"ws://127.0.0.1:{server.server.get_port()}") as student:
        student.open()
        student.read(lambda: student.code)
        yield student


def test_both_tests_are_in_the_overview_and_open_from_it(
    server: LabServer, student: Student
) -> None:
    lab = wait_for(lambda: server.registry.find(student.code)).scheduled.lab
    *_, first, last = student.ask("lessons")["lessons"]
    for card, name, key in ((first, BEFORE, "before"), (last, AFTER, "after")):
        assert card["title"] == ENGLISH(f"test.title_{key}", title=TEST.front.title)
        student.tell({"do": "OpenLesson", "name": card["name"]})
        wait_for(lambda name=name: sitting_of(lab.lessons.progress.lesson) == name)
    forms = {name_of(BEFORE, dealt(student.code)), name_of(AFTER, 1 - dealt(student.code))}
    assert forms <= set(lab.lessons.progress.notes)
    assert student.ask("lessons")["open"] == AFTER


@pytest.mark.thorough
def test_a_student_answers_is_told_nothing_and_hands_in(
    server: LabServer, student: Student
) -> None:
    lab = wait_for(lambda: server.registry.find(student.code)).scheduled.lab
    lab.post(TakeStep(BEFORE, 11))
    name = name_of(BEFORE, dealt(student.code))
    block = questions(COURSE.lesson(name, "en"))["11.0"]
    order = option_order(4, f"{name} 11.0", student.code)
    wrong = next(place for place, at in enumerate(order) if not block.options[at].right)
    student.read(lambda: student.sees(str(block.question)))
    student.tell({"do": "AnswerQuiz", "block": 0, "option": order[wrong]})
    wait_for(lambda: lab.lessons.notes.quiz.get("11.0") == order[wrong])
    student.read(lambda: student.sees(ENGLISH("test.answered", part=1, all=12)))
    assert not any(str(option.answer) in student.column for option in block.options)
    assert ENGLISH("lesson.not_quite") not in student.column and "✗" not in student.column
    student.press(ENGLISH("test.hand_in"))
    student.read(lambda: student.sees(ENGLISH("test.later")))
    assert lab.lessons.notes.handed_in
