"""The most that a lab's stored state can hold: every answer to every question, at its longest."""

from __future__ import annotations

from typing import Any

import msgspec

from onpath.app.lab.setups.setup import DRAWN, Path, RobotSetup, Setup
from onpath.app.lab.setups.stored import to_data
from onpath.app.lab.sketches import MOST_POINTS as SKETCHED
from onpath.lessons.course import Course
from onpath.lessons.given import MOST_POINTS, MOST_TEXT, SURENESS, Answer, Given
from onpath.lessons.progress import Notes, Progress, Truth
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
MARK = "x" * 40
MARKS = {"mark": MARK, "why_mark": MARK}
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
    hints = {task.id: len(task.hints) for step in lesson.steps for task in step.tasks()}
    texts = _blocks(lesson, OpenQuestion, Derivation)
    option = Answer(option=10)
    given = [_given(key, answer=Answer()) for key in asked]
    given += [_given(key, answer=_answer(each), **MARKS) for key, each in asked.items()] * 2
    given *= 2  # it is asked again
    given += [_given(key, answer=option, mark=MARK) for key in _blocks(lesson, Quiz)] * 3
    given += [_given(key, number=LONG_NUMBER) for key in _blocks(lesson, NumberQuestion)] * 3
    given += [_given(key, number=LONG_NUMBER, hints=10, way=10) for key in hints] * 3
    given += [_given(key, text=WORDS) for key in texts] * 3
    return Notes(
        step=len(steps),
        seen=len(steps),
        truths=dict.fromkeys(asked, _truth()),
        played=tuple(str(i) for i, _ in steps),
        hints=hints,
        asked_again=tuple(asked),
        handed_in=True,
        given=tuple(given),
    )


def _given(key: str, **said: Any) -> Given:
    return Given(
        item=key,
        attempt=10_000,
        time=LONG_NUMBER,
        round=1000,
        right=False,
        lost=True,
        key="x" * 40,
        lesson="x" * 12,
        product="x" * 20,
        **said,
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
