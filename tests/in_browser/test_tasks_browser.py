"""Tests that tasks are passed by touch; `test_course_browser.py` passes all with mouse and keys."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np
import pytest

pytest.importorskip("playwright")

from playwright.sync_api import Browser

from onpath.app.lab import commands as c
from onpath.app.server.lab_server import LabServer
from tests.support.browser import Tab, wait_for
from tests.support.built_in import built_in_course
from tests.support.hands import ROBOT, DragBall, Gesture, Hands, Pull, Wait
from tests.support.pupil import sketch
from tests.support.solutions import SOLUTIONS, passed, verdicts

pytestmark = pytest.mark.thorough

COURSE, _ = built_in_course()
TASKS = {
    (lesson.name, task.id): (index, task)
    for lesson in (versions["en"] for versions in COURSE.lessons.values())
    for index, step in enumerate(lesson.steps)
    for task in step.tasks()
}
BY_TOUCH: dict[str, dict[str, tuple[Gesture, ...]]] = {
    "01-path-or-timetable": {"push-across": (Pull(30, 0, seconds=1), Wait(2))},
    "03-the-five-bar": {"dear": SOLUTIONS["03-the-five-bar"]["dear"]},
    "05-invariance": SOLUTIONS["05-invariance"],
}
"""At least one task for each kind of gesture: pull, drag of a control point, slider, button."""


def cases(solutions: dict[str, dict[str, tuple[Gesture, ...]]]) -> list[tuple[str, str]]:
    """Lesson and task of each solution, in order."""
    return [(lesson, task) for lesson, tasks in solutions.items() for task in tasks]


@contextmanager
def opened(browser: Browser, server: LabServer) -> Iterator[Hands]:
    """Open the tab of a student with a touch screen."""
    context = browser.new_context(viewport={"width": 1280, "height": 800}, has_touch=True)
    tab = Tab(server, context, draws=False)
    yield Hands(tab, touch=True)
    assert tab.errors == []
    context.close()


@pytest.fixture(scope="module")
def finger(browser: Browser, server: LabServer) -> Iterator[Hands]:
    with opened(browser, server) as hands:
        yield hands


def go_to(tab: Tab, lesson: str, index: int) -> None:
    """Open a step unless it is open, and pause the lab."""
    run = tab.lab.lessons
    if run.lesson is None or (run.lesson.name, run.index) != (lesson, index):
        tab.ask(c.TakeStep(lesson, index))
    tab.ask(c.SetRunning(False))
    title = COURSE.lesson(lesson, "en").steps[index].title
    tab.page.get_by_role("heading", name=title, exact=True).wait_for()
    tab.wait_until_built()
    wait_for(tab.is_framed)
    tab.settle()


def do(hands: Hands, lesson: str, task: str, gestures: tuple[Gesture, ...]) -> None:
    """Do the gestures, and assert that the page shows the task as passed.

    After a failure the step is set up again, since a second attempt is made on the same page.
    """
    index, wanted = TASKS[lesson, task]
    go_to(hands.tab, lesson, index)
    try:
        for gesture in gestures:
            gesture(hands)
        wait_for(lambda: passed(hands.tab, wanted), seconds=10.0)
    except Exception as error:
        points = np.round(hands.simulation.editor.design.points * 1e3).tolist()
        found = [*verdicts(hands.tab, wanted), hands.lab.message, f"{points}"]
        hands.tab.ask(c.BeginStepAnew())
        raise AssertionError("\n".join(found)) from error


def test_every_task_of_every_lesson_has_gestures_here() -> None:
    assert set(cases(SOLUTIONS)) == set(TASKS)
    assert set(cases(BY_TOUCH)) <= set(TASKS)


def test_tasks_are_passed_by_touch(finger: Hands) -> None:
    for lesson, task in cases(BY_TOUCH):
        do(finger, lesson, task, BY_TOUCH[lesson][task])


def test_the_ball_under_the_end_point_is_dragged(finger: Hands) -> None:
    """The first step of lesson 3 asks for it: the end-point rests on the ball at the right."""
    hands, tab, lab = finger, finger.tab, finger.lab
    go_to(tab, "03-the-five-bar", 0)
    tab.elapse(2)  # both come to rest there
    end = lab.simulation.editor.design.points[-1] * 1e3
    assert np.linalg.norm(tab.tip(ROBOT) * 1e3 - end) < 1
    DragBall((end[0], end[1]), (end[0] - 10, end[1] + 25))(hands)


def test_a_curve_is_drawn_on_the_board(browser: Browser, server: LabServer) -> None:
    """In a tab of its own: a prediction counts as skipped once a later step has been opened."""
    with opened(browser, server) as hands:
        go_to(hands.tab, "01-path-or-timetable", 1)
        hands.tab.page.get_by_text("Draw in the chart with the mouse or a finger").wait_for()
        sketch(hands)
