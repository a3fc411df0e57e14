"""A step runs with exactly its own set-up, however it is reached."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from onpath.app.lab import commands as c
from onpath.app.lab.commands import TakeSetup, TakeStep
from onpath.app.lab.lab import Lab
from onpath.app.lab.setups.capture import capture
from onpath.app.lab.setups.setup import Setup
from onpath.app.storage.lab_state import LabState, keep, put_back
from onpath.lessons.course import Course, read_course
from onpath.models.closed_loop.simulation import FREE
from onpath.models.control.settable import changed
from onpath.models.control.sides import RIGHT, SIDES
from onpath.models.systems.catalogue import ROBOTS
from tests.support.built_in import built_in_course
from tests.support.lab import do, loop_cache, run
from tests.support.lesson_texts import LESSON, write_lesson

COURSE = built_in_course()[0]
STEPS = [
    (name, index)
    for name in COURSE.lessons
    for index in range(len(COURSE.lesson(name, "en").steps))
]
steps = st.sampled_from(STEPS)


def new_lab() -> Lab:
    """A lab with all lessons, none of them open."""
    return Lab(loop_cache(), course=COURSE)


def setting(lab: Lab) -> Setup:
    """A lab's set-up, with what it draws larger."""
    return capture(lab.simulation)


@lru_cache
def wanted(name: str, index: int) -> tuple[Setup, dict[str, np.ndarray]]:
    """Set-up and state of a new lab that came straight to a step."""
    lab, lesson = new_lab(), COURSE.lesson(name, "en")
    do(lab, TakeStep(name, index))
    assert lab.lessons.index == index
    parameters, path = ROBOTS[lesson.front.robot].parameters(), "circle"
    for setup in (step.setup for step in lesson.steps[: index + 1] if step.setup):
        if not setup.keep:
            robot = setup.robot or lesson.front.robot
            parameters, path = ROBOTS[robot].parameters(), "circle"
        for parameter, value in setup.set.items():
            parameters = changed(parameters, parameter, value)
        path = setup.path or path
    assert lab.simulation.parameters == parameters
    assert lab.simulation.editor.design is lab.simulation.presets[path]
    return setting(lab), {n: run.state.copy() for n, run in lab.simulation.runs.items()}


def here(lab: Lab) -> tuple[str, int]:
    """Lesson and step."""
    return lab.lessons.progress.lesson, lab.lessons.index


def assert_at_the_beginning(lab: Lab) -> None:
    """Assert the state of a new lab that came straight to this step."""
    setup, states = wanted(*here(lab))
    assert setting(lab) == setup
    for name, one in lab.simulation.runs.items():
        assert np.array_equal(one.state, states[name])
    assert lab.simulation.time == 0.0 and lab.simulation.viewing is None
    assert (
        lab.simulation.forces.pushes == dict.fromkeys(SIDES, FREE)
        and not lab.simulation.forces.held
    )
    assert lab.simulation.editor.selected is None and lab.simulation.editor.proposed is None
    assert np.array_equal(lab.simulation.editor.table, lab.simulation.editor.design.curve.table())


def arrived(lab: Lab) -> Lab:
    """Assert that the lab has just arrived at a step; return it."""
    run_, lesson = lab.lessons, lab.lessons.lesson
    assert lesson is not None and lab.script is None
    assert_at_the_beginning(lab)
    assert lab.simulation.running == (lesson.setup_at(run_.index).running and not run_.waits)
    return lab


def turned(by: int) -> Callable[[Lab], Lab]:
    """Next, or Back; where a prediction is skipped first, nothing is arrived at."""

    def turn(lab: Lab) -> Lab:
        stays = by > 0 and lab.lessons.waits and lab.lessons.step_is("run")
        do(lab, c.GoToStep(by))
        return lab if stays else arrived(lab)

    return turn


def asked(*commands: c.Command) -> Callable[[Lab], Lab]:
    """Something done in the lab meanwhile."""

    def ask(lab: Lab) -> Lab:
        do(lab, *commands)
        run(lab, 0.1)
        return lab

    return ask


def set_up_again(lab: Lab) -> Lab:
    do(lab, c.BeginStepAnew())
    return arrived(lab)


def played(lab: Lab) -> Lab:
    """The script, from its beginning, seen at any speed."""
    do(lab, c.Predict())
    rate = lab.simulation.settings.rate
    c.PlayStep().apply(lab)  # and nothing of the script yet
    if lab.lessons.playing:
        assert lab.simulation.settings.rate == rate and lab.simulation.running
        lab.simulation.set(rate=1.0)
        assert_at_the_beginning(lab)
    run(lab, 0.3)
    return lab


def left_and_opened(lab: Lab) -> Lab:
    name = lab.lessons.progress.lesson
    do(lab, c.CloseLesson(), c.OpenLesson(name))
    return arrived(lab)


def reloaded(lab: Lab) -> Lab:
    """The lab as restored in another process, at the start."""
    kept: list[LabState] = []
    keep(lab, lambda make: kept.append(make()))
    again = new_lab()
    put_back(again, kept[0])
    assert capture(again.simulation) == capture(lab.simulation) and here(again) == here(lab)
    assert (
        again.simulation.time == 0.0
        and not again.simulation.forces.held
        and not again.simulation.events
    )
    return again


def pushed(step: tuple[str, int]) -> Callable[[Lab], Lab]:
    """The teacher opens a step for all."""

    def push(lab: Lab) -> Lab:
        do(lab, TakeStep(*step))
        return arrived(lab)

    return push


def pushed_setup(lab: Lab) -> Lab:
    """The teacher sends a set-up; then the student comes back."""
    name = lab.lessons.progress.lesson
    do(lab, TakeSetup(Setup(robot="flexible", settings={"rate": 2.0})), c.OpenLesson(name))
    return arrived(lab)


MEDDLING = (
    asked(c.Set("K1", 77.0), c.Set("K2", 7.0)),
    asked(c.Set("speed", -2.0), c.Set("task", "position")),
    asked(c.Set("payload", 0.2), c.Set("control_rate", 50)),
    asked(c.ChoosePath("clover")),
    asked(c.SelectPoint(2), c.NudgePoint(0.003, 0.0)),
    asked(*(c.ChooseRobot(name) for name in ROBOTS), c.Set("K1", 55.0)),
    asked(c.Set("rate", 0.25), c.Set("copy", False)),
    asked(c.Hold(True)),
    asked(c.MoveHand(0.02, 0.01)),
    asked(c.SetRunning(True)),
    asked(c.SetRunning(True), c.LookAt(0.05)),
    asked(c.SetRunning(True), c.LookAt(0.05), c.GoOn()),
    asked(*(c.ChooseLaw(side, "waiting_clock") for side in SIDES)),
    asked(c.TypeLaw(RIGHT, "across = -300*xi - 30*dxi; along = -5*dtheta")),
    asked(
        c.Set("wall", True),
        *(
            c.Set(f"wall_{name}", value)
            for name, value in (("z1", 0.04), ("z2", 0.01), ("angle", 0.3))
        ),
    ),
    asked(c.Set("hold_direction", "both"), c.Hold(True)),
    asked(c.Set("start_beside", 0.01), c.Set("start_clock_offset", 0.1), c.Reset()),
    asked(c.Set("speed_profile", "sine"), c.Set("ramp", 3.0)),
    asked(c.Set("tracker_integral", "on"), c.Set("K3", 500.0)),
    asked(c.Set("larger", 5.0), c.Pulse()),
)
meddling = st.sampled_from(MEDDLING)
ways = st.one_of(
    st.sampled_from((turned(1), turned(-1), set_up_again, left_and_opened, pushed_setup)),
    st.builds(pushed, steps),
)


@pytest.mark.thorough
@example(STEPS[0], [MEDDLING[-1], played])  # a pull that is a script, in a step without one
@given(steps, st.lists(st.one_of(meddling, ways, st.just(played), st.just(reloaded)), max_size=12))
@settings(max_examples=30)
def test_random_walks(first: tuple[str, int], walk: list[Callable[[Lab], Lab]]) -> None:
    lab = pushed(first)(new_lab())
    for move in walk:
        lab = move(lab)
    assert set_up_again(lab)


@pytest.mark.thorough
@settings(max_examples=4)
@example("07-flexible-link")
@given(st.sampled_from(list(COURSE.lessons)))
def test_there_and_back_through_a_lesson_while_meddling(name: str) -> None:
    lab = pushed((name, 0))(new_lab())
    last = len(COURSE.lesson(name, "en").steps) - 1
    places = [0]
    for by in (1, -1):
        for _ in range(2 * last):
            lab = MEDDLING[len(places) % len(MEDDLING)](lab)
            lab = turned(by)(lab)
            places.append(lab.lessons.index)
            if lab.lessons.index == (last if by > 0 else 0):
                break
    assert sorted(set(places)) == list(range(last + 1)) and places[-1] == 0


@pytest.mark.thorough
@settings(max_examples=20)
@given(
    meddle=st.sampled_from(MEDDLING),
    way=st.sampled_from([set_up_again, turned(1), turned(-1), left_and_opened]),
)
def test_whatever_was_done_nothing_of_it_is_left(
    meddle: Callable[[Lab], Lab], way: Callable[[Lab], Lab]
) -> None:
    lab = pushed(("05-invariance", 1))(new_lab())
    do(lab, c.Predict(), c.PlayStep())
    lab = meddle(lab)
    assert lab.message_level != "warning", lab.message
    way(lab)


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
        lab = Lab(loop_cache(), course=Course(course.lessons))
        do(lab, *ways, c.Set("K1", 50.0), c.BeginStepAnew())
        assert lab.lessons.index == 2
        assert (lab.simulation.parameters.K1, lab.simulation.parameters.K2) == (300.0, 30.0)


def test_no_undo_brings_the_path_of_another_step_back() -> None:
    lab = new_lab()
    do(lab, TakeStep(*STEPS[0]), c.ChoosePath("ellipse"), c.ChoosePath("clover"), c.Undo())
    for leave in (c.GoToStep(1), c.GoToStep(-1), c.CloseLesson()):
        do(lab, c.ChoosePath("ellipse"), leave)
        design = lab.simulation.editor.design
        for command in (c.Undo(), c.Redo()):
            do(lab, command)
            assert lab.simulation.editor.design is design
