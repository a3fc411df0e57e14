"""A step runs with exactly its own set-up, whichever way one comes to it."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from msgspec.structs import replace

from onpath.app.lab import commands as c
from onpath.app.lab.commands import TakeSetup, TakeStep
from onpath.app.lab.session import Session
from onpath.app.lab.setup import Setup, capture
from onpath.app.storage.lab_state import LabState, keep, put_back
from onpath.lessons.course import BUILT_IN, Course, read_course
from onpath.models.closed_loop.simulation import FREE
from onpath.models.control.laws import NAMES
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.parameters import changed
from tests.support.lab import do, run, store
from tests.support.lesson_texts import LESSON, write_lesson

COURSE = read_course([BUILT_IN])[0]
STEPS = [
    (name, index)
    for name in COURSE.lessons
    for index in range(len(COURSE.lesson(name, "en").steps))
]
steps = st.sampled_from(STEPS)


def new_lab() -> Session:
    """With all lessons, none of them open."""
    return Session(store(), course=COURSE)


def setting(session: Session) -> Setup:
    """What of a lab decides what happens in it."""
    return replace(capture(session), exaggeration=1.0)


@lru_cache
def wanted(name: str, index: int) -> tuple[Setup, dict[str, np.ndarray]]:
    """Set-up and state of a new lab that came straight to a step."""
    session, lesson = new_lab(), COURSE.lesson(name, "en")
    do(session, TakeStep(name, index))
    assert session.lessons.index == index
    scene = [step.scene for step in lesson.steps[: index + 1] if step.scene][-1]
    parameters = ROBOTS[lesson.front.robot].lab
    for parameter, value in scene.set.items():
        parameters = changed(parameters, parameter, value)
    assert session.parameters == parameters
    assert session.editor.design is session.presets[scene.path or "circle"]
    return setting(session), {n: run.state.copy() for n, run in session.runs.items()}


def here(session: Session) -> tuple[str, int]:
    """Lesson and step."""
    return session.lessons.progress.lesson, session.lessons.index


def assert_at_the_beginning(session: Session) -> None:
    """As a new lab that came straight to this step."""
    setup, states = wanted(*here(session))
    assert setting(session) == setup
    for name, one in session.runs.items():
        assert np.array_equal(one.state, states[name])
    assert session.time == 0.0 and session.viewing is None
    assert session.grips.pushes == dict.fromkeys(NAMES, FREE) and not session.grips.held
    assert session.editor.selected is None and session.editor.proposed is None
    assert np.array_equal(session.editor.table, session.editor.design.curve.table())


def arrived(session: Session) -> Session:
    """Just now, by some way."""
    run_, lesson = session.lessons, session.lessons.lesson
    assert lesson is not None and session.script is None
    assert_at_the_beginning(session)
    assert session.running == (lesson.scene_at(run_.index).running and not run_.waits)
    return session


def turned(by: int) -> Callable[[Session], Session]:
    """Next, or Back; where a prediction is skipped first, nothing is arrived at."""

    def turn(session: Session) -> Session:
        stays = by > 0 and session.lessons.waits and session.lessons.step_is("run")
        do(session, c.GoToStep(by))
        return session if stays else arrived(session)

    return turn


def asked(*commands: c.Command) -> Callable[[Session], Session]:
    """Something done in the lab meanwhile."""

    def ask(session: Session) -> Session:
        do(session, *commands)
        run(session, 0.1)
        return session

    return ask


def set_up_again(session: Session) -> Session:
    do(session, c.BeginStepAnew())
    return arrived(session)


def played(session: Session) -> Session:
    """The script, from its beginning, seen at any speed."""
    do(session, c.Predict())
    rate = session.rate
    session.lessons.play(session)  # and nothing of the script yet
    if session.script is not None:
        assert session.rate == rate and session.running
        session.rate = 1.0
        assert_at_the_beginning(session)
    run(session, 0.3)
    return session


def left_and_opened(session: Session) -> Session:
    name = session.lessons.progress.lesson
    do(session, c.CloseLesson(), c.OpenLesson(name))
    return arrived(session)


def reloaded(session: Session) -> Session:
    """In another process, as it was left, at the start."""
    kept: list[LabState] = []
    keep(session, lambda make: kept.append(make()))
    again = new_lab()
    put_back(again, kept[0])
    assert capture(again) == capture(session) and here(again) == here(session)
    assert again.time == 0.0 and not again.grips.held and not again.happenings
    return again


def pushed(step: tuple[str, int]) -> Callable[[Session], Session]:
    """The teacher opens a step for all."""

    def push(session: Session) -> Session:
        do(session, TakeStep(*step))
        return arrived(session)

    return push


def pushed_setup(session: Session) -> Session:
    """The teacher sends a set-up; then the student comes back."""
    name = session.lessons.progress.lesson
    do(session, TakeSetup(Setup(robot="flexible", rate=2.0)), c.OpenLesson(name))
    return arrived(session)


MEDDLING = (
    asked(c.SetParameter("K1", 77.0), c.SetParameter("K2", 7.0)),
    asked(c.SetParameter("speed", -2.0), c.SetParameter("task", "position")),
    asked(c.SetParameter("payload", 0.2), c.SetParameter("control_rate", 50)),
    asked(c.ChoosePath("clover")),
    asked(c.SelectPoint(2), c.Arrow(0.003, 0.0)),
    asked(*(c.ChooseRobot(name) for name in ROBOTS), c.SetParameter("K1", 55.0)),
    asked(c.SetRate(0.25), c.SetCopy(False)),
    asked(c.Hold(True)),
    asked(c.MoveHand(0.02, 0.01)),
    asked(c.SetRunning(True)),
    asked(c.SetRunning(True), c.LookAt(0.05)),
)
meddling = st.sampled_from(MEDDLING)
ways = st.one_of(
    st.sampled_from((turned(1), turned(-1), set_up_again, left_and_opened, pushed_setup)),
    st.builds(pushed, steps),
)


@given(steps, st.lists(st.one_of(meddling, ways, st.just(played), st.just(reloaded)), max_size=12))
@settings(max_examples=30)
def test_random_walks(first: tuple[str, int], walk: list[Callable[[Session], Session]]) -> None:
    session = pushed(first)(new_lab())
    for move in walk:
        session = move(session)
    assert set_up_again(session)


@pytest.mark.parametrize("name", COURSE.lessons)
def test_there_and_back_through_a_lesson_while_meddling(name: str) -> None:
    session = pushed((name, 0))(new_lab())
    last = len(COURSE.lesson(name, "en").steps) - 1
    places = [0]
    for by in (1, -1):
        for turn in range(2 * last):
            session = MEDDLING[turn % len(MEDDLING)](session)
            session = turned(by)(session)
            places.append(session.lessons.index)
            if session.lessons.index == (last if by > 0 else 0):
                break
    assert sorted(set(places)) == list(range(last + 1)) and places[-1] == 0


def test_what_a_step_keeps_is_what_the_step_before_has(
    tmp_path_factory: pytest.TempPathFactory,
) -> None:
    folder = tmp_path_factory.mktemp("keeping")
    kept = "```scene\nkeep = true\n[set]\nK2 = 30\n```\n\n```script\nuntil = 2.0"
    write_lesson(folder, LESSON.replace("```script\nuntil = 2.0", kept))
    course, problems = read_course([folder])
    assert problems == []
    for ways in (
        [TakeStep("01-a", 2)],
        [c.OpenLesson("01-a"), *3 * [c.GoToStep(1)], c.GoToStep(-1)],
    ):
        session = Session(store(), course=Course(course.lessons))
        do(session, *ways, c.SetParameter("K1", 50.0), c.BeginStepAnew())
        assert session.lessons.index == 2
        assert (session.parameters.K1, session.parameters.K2) == (300.0, 30.0)
