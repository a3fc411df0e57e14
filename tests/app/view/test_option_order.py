"""What a student chooses is kept in the author's numbering, whatever order the page shows."""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import partial

import pytest

from onpath.app.lab import commands as c
from onpath.app.lab.commands import TakeStep
from onpath.app.lab.lab import Lab
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.server.lab_server import LabServer
from onpath.app.server.server_options import ServerOptions
from onpath.lessons.course import Course, read_course
from onpath.lessons.option_order import LETTERS, option_order
from onpath.lessons.schema import Choice, Quiz
from tests.support import waiting
from tests.support.lesson_texts import LESSON, write_lesson
from tests.support.student import Student

NAME = "01-a"
PREDICTION, QUIZ = 3, 7  # steps
wait_for = partial(waiting.wait_for, seconds=30.0)  # only ends a test that would hang


@pytest.fixture(scope="module")
def course(tmp_path_factory: pytest.TempPathFactory) -> Course:
    folder = tmp_path_factory.mktemp("course")
    more = "".join(
        f'  {{ text = "{each} option", answer = "{each}" }},\n' for each in ("third", "fourth")
    )
    write_lesson(folder, re.sub(r"(?m)^\]\n```", f"{more}]\n```", LESSON), name=NAME)
    return read_course([folder])[0]


@pytest.fixture(scope="module")
def server(course: Course) -> Iterator[LabServer]:
    server = LabServer("127.0.0.1", 0, LoopCache(), ServerOptions(course=course))
    yield server
    server.stop()


def block_of(course: Course, step: int) -> Choice | Quiz:
    """The question of a step."""
    blocks = course.lesson(NAME, "en").steps[step].blocks
    return next(block for block in blocks if isinstance(block, Choice | Quiz))


def shown(student: Student) -> list[str]:
    """The options of the question on the page, from the top."""
    found = re.findall(
        r'<b class="letter">([A-H])</b>\s*<span>(.*?)\s*</span>', student.column, re.DOTALL
    )
    assert [letter for letter, _ in found] == list(LETTERS[: len(found)])
    return [text for _, text in found]


def chosen(lab: Lab) -> int | None:
    """The kept answer to the open step's question."""
    notes = lab.lessons.notes
    if lab.lessons.step_is("quiz"):
        return next(iter(notes.quiz.values()), None)
    answer = notes.answers.get(str(PREDICTION))
    return answer.option if answer else None


@pytest.mark.thorough
@pytest.mark.parametrize("step", [PREDICTION, QUIZ], ids=["prediction", "quiz"])
def test_a_letter_means_the_option_that_stands_beside_it(
    server: LabServer, course: Course, step: int
) -> None:
    with Student(f"ws://127.0.0.1:{server.server.get_port()}") as student:
        student.open()
        student.read(lambda: student.code)
        entry = wait_for(lambda: server.registry.find(student.code))
        lab = entry.scheduled.lab
        lab.post(TakeStep(NAME, step))
        student.read(lambda: student.sees(f"Step {step + 1} of"))
        block = block_of(course, step)
        key = str(step) if isinstance(block, Choice) else f"{step}.0"
        order = option_order(len(block.options), f"{NAME} {key}", student.code)
        texts = [str(block.options[index].text) for index in order]
        student.read(lambda: shown(student) == texts)

        student.close()
        student.reopen()  # a reload keeps the order
        student.read(lambda: student.sees(f"Step {step + 1} of") and shown(student) == texts)

        blocks = course.lesson(NAME, "en").steps[step].blocks
        place = next(i for i, each in enumerate(blocks) if each is block)
        ask = {"do": "AnswerQuiz", "block": place}
        do = {"do": "Predict"} if isinstance(block, Choice) else ask
        student.tell({**do, "option": order[3]})
        wait_for(lambda: chosen(lab) == order[3])

        lab.post(c.Set("presenting", True))  # a projector shows what the teacher's page counts
        author = [str(option.text) for option in block.options]
        student.read(lambda: shown(student) == author)
