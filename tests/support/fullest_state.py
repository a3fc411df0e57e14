"""The most that a lab's stored state can hold: every answer to every question, at its longest."""

from __future__ import annotations

from typing import Any

import msgspec

from onpath.app.lab.setups.setup import DRAWN, Path, RobotSetup, Setup
from onpath.app.lab.setups.stored import to_data
from onpath.app.lab.sketches import MOST_POINTS as SKETCHED
from onpath.lessons.course import Course
from onpath.lessons.kept.option_keys import second_key
from onpath.lessons.progress import (
    MOST_POINTS,
    MOST_TEXT,
    SURENESS,
    Answer,
    Given,
    Notes,
    Progress,
    Truth,
)
from onpath.lessons.record import QUANTITIES
from onpath.lessons.schema import (
    Derivation,
    Lesson,
    NumberQuestion,
    OpenQuestion,
    Prediction,
    Quiz,
    Sketch,
    Step,
)
from onpath.models.closed_loop.lab_settings import settings_kept
from onpath.models.control.laws.expressions import LONGEST
from onpath.models.control.settable import specs
from onpath.models.control.sides import SIDES
from onpath.models.paths.curves import TERMS
from onpath.models.systems.catalogue import ROBOTS

WORDS = "x" * MOST_TEXT
NUMBER = -12345.678
LONG_NUMBER = -1.2345678901234567e-100


def size(state: object) -> int:
    """Size of a state as it is stored, [characters]."""
    return len(msgspec.json.encode(state).decode())


def fullest_state(course: Course) -> dict[str, Any]:
    """A state with everything that a student can store in a course, at its longest."""
    named = {**course.lessons, **course.tests}
    lessons = {name: course.lesson(name, "en") for name in named}
    notes = {name: _notes(lesson) for name, lesson in lessons.items()}
    longest = max([*lessons, ""], key=len)
    route = max([*course.routes, ""], key=len)
    progress = Progress(lesson=longest, notes=notes, route=route, ended=True)
    setup = to_data(_setup())
    return {"setup": setup, "lessons": msgspec.to_builtins(progress), "before": setup}


def _notes(lesson: Lesson) -> Notes:
    steps = list(enumerate(lesson.steps))
    asked = {str(i): step.predictions()[0] for i, step in steps if step.predictions()}
    answers = {key: _answer(prediction) for key, prediction in asked.items()}
    marks = [*lesson.keys, *map(second_key, lesson.keys)]
    hints = {task.id: len(task.hints) for step in lesson.steps for task in step.tasks()}
    return Notes(
        step=len(steps),
        seen=len(steps),
        answers=answers,
        truths=dict.fromkeys(asked, _truth()),
        played=tuple(str(i) for i, _ in steps),
        tasks=dict.fromkeys(hints, NUMBER),
        hints=hints,
        quiz=dict.fromkeys(_blocks(lesson, Quiz), 10),
        numbers=dict.fromkeys(_blocks(lesson, NumberQuestion), LONG_NUMBER),
        written=dict.fromkeys(_blocks(lesson, OpenQuestion, Derivation), WORDS),
        twice=(*_blocks(lesson, Quiz), *_blocks(lesson, NumberQuestion)),
        asked_again=tuple(asked),
        second=answers,
        marks=dict.fromkeys(marks, "x" * 40),
        unknown=tuple(marks),
        handed_in=True,
        given=tuple(_given(key, answer) for key, answer in answers.items() for _ in range(3))
        + tuple(_given(key) for kind in (Quiz, NumberQuestion) for key in _blocks(lesson, kind))
        + tuple(
            Given(key, text=WORDS)
            for key in _blocks(lesson, OpenQuestion, Derivation)
            for _ in range(2)
        ),
    )


def _given(key: str, answer: Answer | None = None) -> Given:
    return Given(
        item=key,
        time=LONG_NUMBER,
        round=1000,
        answer=answer,
        number=LONG_NUMBER,
        mark="x" * 40,
        why_mark="x" * 40,
        key="x" * 40,
    )


def _blocks(lesson: Lesson, *kinds: type[Any]) -> list[str]:
    def keys(index: int, step: Step) -> list[str]:
        return [f"{index}.{n}" for n, block in enumerate(step.blocks) if isinstance(block, kinds)]

    return [key for index, step in enumerate(lesson.steps) for key in keys(index, step)]


def _answer(prediction: Prediction) -> Answer:
    points = SKETCHED if isinstance(prediction, Sketch) else 0
    return Answer(
        option=10,
        times=(NUMBER,) * points,
        values=(NUMBER,) * points,
        sure=max(SURENESS, key=len),
        reason=10,
        why=WORDS if prediction.why else "",
    )


def _truth() -> Truth:
    numbers = (10 * NUMBER,) * MOST_POINTS
    return Truth(max(QUANTITIES, key=len), numbers, numbers, numbers)


def _setup() -> Setup:
    """All robots with another value of every parameter, a drawn path, a start and a wall."""
    robots = {
        name: RobotSetup(
            parameters=dict.fromkeys(specs(entry.parameters), -1.23456e-10),
            path=Path(DRAWN, False, (-123456,) * (2 * TERMS)),
            settings=dict.fromkeys(settings_kept("code", of_robot=True), -1.23456e-10),
        )
        for name, entry in ROBOTS.items()
    }
    laws: dict[str, str] = {side: "x" * LONGEST for side in SIDES}
    longest = max(ROBOTS, key=len)
    return Setup(
        robot=longest,
        robots=robots,
        laws=laws,
        settings=dict.fromkeys(settings_kept("code"), -1.23456e-10),
    )
