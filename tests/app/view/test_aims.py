"""A lesson's first page says what the student needs and will learn; later pages do not."""

from __future__ import annotations

from functools import partial
from pathlib import Path

import msgspec
import pytest

from onpath.app.lab.commands import TakeStep
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.server.lab_server import LabServer
from onpath.app.server.server_options import ServerOptions
from onpath.app.steps.step_html import step_html
from onpath.assets.messages import languages
from onpath.lessons.course import read_course
from onpath.lessons.schema import Front
from onpath.lessons.words import ENGLISH, Words
from tests.support import waiting
from tests.support.built_in import built_in_course
from tests.support.lesson_texts import LESSON, write_lesson
from tests.support.student import Student

wait_for = partial(waiting.wait_for, seconds=30.0)  # only ends a test that would hang
SUMMARY = 'summary = "For tests."'
TEXTS = {"needs": "a ruler", "goals": "draw a line", "misconception": "lines are circles"}


@pytest.mark.parametrize("language", languages())
def test_every_lesson_says_it_and_keeps_the_teachers_part(language: str) -> None:
    words, course = Words(language), built_in_course()[0]
    for name in course.lessons:
        lesson = course.lesson(name, language)
        said = step_html(lesson, 0, [], words)
        assert words("lesson.needs") in said and words("lesson.goals") in said
        assert lesson.front.misconception not in said
        bare = msgspec.structs.replace(lesson, front=Front("T", "S"))
        assert words("lesson.needs") not in step_html(bare, 0, [], words)


@pytest.mark.thorough
def test_a_student_reads_it_on_the_first_page_only(tmp_path: Path) -> None:
    lines = "\n".join(f'{name} = "{text}"' for name, text in TEXTS.items())
    write_lesson(tmp_path, LESSON.replace(SUMMARY, f"{SUMMARY}\n{lines}"))
    server = LabServer(
        "127.0.0.1", 0, LoopCache(), ServerOptions(course=read_course([tmp_path])[0])
    )
    try:
        with Student(f"ws://127.0.0.1:{server.server.get_port()}") as student:
            student.open()
            student.read(lambda: student.code)
            lab = wait_for(lambda: server.registry.find(student.code)).scheduled.lab
            lab.post(TakeStep("01-a", 0))
            student.read(lambda: student.sees("Step 1 of") and student.sees(TEXTS["goals"]))
            assert student.sees(ENGLISH("lesson.needs")) and student.sees(TEXTS["needs"])
            assert not student.sees(TEXTS["misconception"])
            lab.post(TakeStep("01-a", 5))
            student.read(lambda: student.sees("Step 6 of") and not student.sees(TEXTS["goals"]))
    finally:
        server.stop()
