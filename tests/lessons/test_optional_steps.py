"""Optional steps: the student can pass over them, and need not pass their tasks."""

from __future__ import annotations

from pathlib import Path

from msgspec.structs import replace

from onpath.app.lab.commands import GoToStep, OpenLesson, TakeStep
from onpath.app.lab.lab import Lab
from onpath.app.lab.lesson_state import LessonState
from onpath.app.view.lessons import lesson_card
from onpath.lessons.course import Course, read_course
from onpath.lessons.progress import Progress
from tests.support.given import notes_with
from tests.support.lab import do, loop_cache
from tests.support.lesson_texts import LESSON, write_lesson

OPTIONAL = "```step\noptional = true\n```\n"
HEADINGS = ("# predict: Once more\n", "# run: See\n", "# quiz: Say\n")


def course_with_optional_steps(folder: Path) -> Course:
    """Steps 4, 5 and 8 of 8 are optional."""
    text = LESSON
    for heading in HEADINGS:
        text = text.replace(heading, heading + OPTIONAL)
    write_lesson(folder, text)
    course, problems = read_course([folder])
    assert problems == []
    return course


def test_one_press_leads_past_all_optional_steps(tmp_path: Path) -> None:
    lab = Lab(loop_cache(), course=course_with_optional_steps(tmp_path))
    do(lab, OpenLesson("01-a"))
    past = list[int | None]()
    for index in range(8):
        do(lab, TakeStep("01-a", index))
        past.append(lab.lessons.past_optional())
    assert past == [None, None, 3, 2, None, None, 0, None]
    do(lab, TakeStep("01-a", 3), GoToStep(2))
    assert lab.lessons.index == 5 and lab.lessons.notes.answers["3"].skipped


def test_a_lesson_is_finished_without_its_optional_steps(tmp_path: Path) -> None:
    course = course_with_optional_steps(tmp_path)
    lesson = course.lesson("01-a", "en")
    assert lesson.required_steps() == 7 and len(lesson.required_tasks()) == 1
    notes = notes_with(step=6, seen=7, tasks={"hold": 0.0})
    for seen, finished in ((7, True), (6, False)):
        progress = Progress(notes={"01-a": replace(notes, seen=seen)})
        assert lesson_card(lesson, LessonState(course, progress), "1").finished == finished
