"""Every lesson is all right, and each task's solution passes where its failure does not."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.lesson_record import Beginning, record_of
from app.lesson_scene import set_up
from app.script_player import ScriptPlayer
from app.session import Session
from lessons.checks import Verdict, judge
from lessons.course import BUILT_IN, REFERENCE, read_course, read_references
from lessons.schema import Lesson, Script, Step, Task
from lessons.words import Words
from tests.lab import run, store

COURSE, PROBLEMS = read_course([BUILT_IN])
ENGLISH = [versions["en"] for versions in COURSE.lessons.values()]
TASKS = [
    (lesson, step, task) for lesson in ENGLISH for step in lesson.steps for task in step.tasks()
]
SCRIPTS = [(lesson, step) for lesson in ENGLISH for step in lesson.steps if step.script]


def label(value: object) -> str:
    """For pytest's names of tests."""
    if isinstance(value, Lesson):
        return value.name
    return value.id if isinstance(value, Task) else getattr(value, "title", "")


def lab_at(lesson: Lesson, step: Step) -> Session:
    """A lab set up for a step of a lesson."""
    session = Session(store())
    set_up(session, lesson, lesson.steps.index(step))
    return session


def played(session: Session, script: Script, task: Task | None = None) -> list[list[Verdict]]:
    """Plays a script; the verdicts on a task, ten times a second."""
    begin, words = Beginning.now(session), Words()
    session.script, session.running = ScriptPlayer(script), True
    verdicts: list[list[Verdict]] = []
    for _ in range(round(3 * script.until / 0.1)):
        run(session, 0.1)
        if task is not None:
            verdicts.append(judge(task, record_of(session, begin), words))
        if session.script is None:
            return verdicts
    raise AssertionError("the script does not end")


def test_every_lesson_is_all_right() -> None:
    assert PROBLEMS == []
    assert len(ENGLISH) >= 8 and "de" in COURSE.languages()


@pytest.mark.parametrize(("lesson", "step", "task"), TASKS, ids=label)
def test_solution_passes_and_failure_does_not(lesson: Lesson, step: Step, task: Task) -> None:
    reference = read_references(lesson, BUILT_IN / lesson.name / REFERENCE)[0][task.id]
    seen = played(lab_at(lesson, step), reference.solution, task)
    assert any(all(v.passed for v in verdicts) for verdicts in seen), [v.words for v in seen[-1]]
    seen = played(lab_at(lesson, step), reference.failure, task)
    assert not any(all(v.passed for v in verdicts) for verdicts in seen), [
        v.words for v in seen[-1]
    ]


@pytest.mark.parametrize(("lesson", "step"), SCRIPTS, ids=label)
def test_what_a_step_shows_by_itself_is_let_happen(lesson: Lesson, step: Step) -> None:
    assert step.script is not None
    session = lab_at(lesson, step)
    played(session, step.script)
    assert session.message_level != "warning", session.message
    assert session.time > 0


def test_references_are_where_the_lessons_are() -> None:
    for lesson in ENGLISH:
        assert Path(BUILT_IN / lesson.name / REFERENCE).is_file()
