"""Tests that every task of every lesson is passed by doing what its last hint says."""

from __future__ import annotations

import html
import re
from collections.abc import Iterator

import numpy as np
import pytest

pytest.importorskip("playwright")

from playwright.sync_api import Browser

from onpath.app.lab import commands as c
from onpath.app.server.lab_server import LabServer
from onpath.lessons.task_schema import Task
from tests.support.browser import Tab, wait_for
from tests.support.built_in import built_in_course
from tests.support.cases import some
from tests.support.hands import (
    ROBOT,
    Choose,
    DragBall,
    Enter,
    Gesture,
    Hands,
    Key,
    Press,
    Pull,
    Slide,
    Wait,
)

COURSE, _ = built_in_course()
TASKS = {
    (lesson.name, task.id): (index, task)
    for lesson in (versions["en"] for versions in COURSE.lessons.values())
    for index, step in enumerate(lesson.steps)
    for task in step.tasks()
}
HOLD, LET_GO, RESET = Press("Hold both back"), Press("Let both go"), Press("Reset")
TWO_BULGES = (DragBall((0, 50), (0, 65)), DragBall((0, -50), (0, -65)))
TWO_HOLDS = (HOLD, Wait(2.2), LET_GO, Wait(2), HOLD, Wait(2.2), LET_GO, Wait(3.2))

# In the order of the course; there is no reset between the tasks of one step.
SOLUTIONS: dict[str, dict[str, tuple[Gesture, ...]]] = {
    "01-path-or-timetable": {
        "hold-two-seconds": (Enter("K1", 600), Enter("K2", 50), Key("h"), Wait(3), Key("h")),
        "thirty-times": (Enter("K1", 1600), Enter("K2", 80), HOLD, Wait(3), LET_GO),
        "push-across": (Key("d", 6), Wait(1), Key("x"), Wait(2)),
    },
    "01b-let-the-clock-wait": {
        "wait-in-time": (Enter("Clock waits", 80), Key("h"), Wait(3), Key("h")),
        "throw-it-off": (Enter("Speed", 10), Wait(2), Enter("Speed", -10), Wait(2)),
        "keep-it-on": (
            *(Enter("Speed", 6.3), Enter("Speed ramp", 20), RESET),
            *(Wait(2), Enter("Speed", -6.3), Wait(2)),
        ),
    },
    "02-what-is-the-error": {
        "half-a-round-late": (RESET, Wait(1), HOLD, Wait(1.3), LET_GO, Wait(2)),
        "the-other-side": (Pull(-70, 0, seconds=1), Wait(2)),
        "deeper-than-deep": (Enter("Target", 1.57), Wait(2), Key("s", 12), Wait(0.5), Key("x")),
    },
    "03-the-five-bar": {
        "dear": (DragBall((35, 35), (67, 67)), Wait(3)),
        "cheap": (Press("the circle"), DragBall((-35, 35), (-67, 67)), Wait(3)),
        "carry": (Enter("K1", 1600), Enter("K2", 80), Enter("K5", 30), Wait(4)),
    },
    "04-across-and-along": {
        "rail": (Enter("K1", 1600), Enter("K2", 80), RESET, Key("w", 5), Wait(2), Key("x")),
        "spring-board": (
            *(Enter("K1", 100), Enter("K2", 20), Enter("K4", 400), Enter("K5", 40)),
            *(RESET, Key("d", 4), Wait(1), Key("x")),
        ),
    },
    "04b-poles-and-gains": {
        "no-overshoot": (
            *(Enter("K4", 100), Enter("K5", 20), RESET),
            *(Key("w", 6), Wait(1), Key("x"), Wait(2)),
        ),
        "enough": (Enter("K1", 400), Enter("K2", 40), Wait(4)),
    },
    "05-invariance": {
        "tour": (Slide("Target", 3.1), Wait(2), Slide("Target", 0), Wait(2)),
        "obstruction": (
            *(Press("run round the circle"), Enter("K1", 2500), Enter("K2", 100), RESET),
            *(Wait(1), HOLD, Wait(2.2), LET_GO, Wait(2)),
        ),
    },
    "06-exact-cancellation": {
        "quiet-and-close": (Enter("K3", 2000), RESET, Wait(5)),
        "excite": (Enter("Speed", 6), Wait(3), Press("Identify M and b"), Wait(4)),
        "excite-well": (
            Press("the same with coarse encoders, at a crawl"),
            *(Enter("Speed", 5), Wait(1), Enter("Speed", -5), Wait(1), Enter("Speed", 5), Wait(1)),
            Press("Identify M and b"),
        ),
    },
    "06b-friction-and-the-integral": {
        "lower-the-jumps": (Enter("K1", 1600), Enter("K2", 80), Wait(8)),
        "get-it-going": (Enter("K5", 30), Wait(4)),
    },
    "07-flexible-link": {
        "choose-alpha": (Enter("α", 0.7), Wait(4)),
        "broken-promise": (
            *(Choose("Modes", "1"), Enter("α", 0.8), Wait(1), Choose("Modes", "3"), Wait(0.5)),
        ),
        "hold-the-tip": (
            *(Choose("Output", "composite"), RESET, Wait(3), HOLD, Wait(2.2), LET_GO),
        ),
        "turn-gently": (
            *(Choose("Output", "redefined"), RESET, Wait(2)),
            *(Enter("K5", 1), Enter("Speed", -2), Wait(4)),
        ),
    },
    "08-challenge": {
        "own-path": (
            *(*TWO_BULGES, Enter("K1", 1600), Enter("K2", 80), Enter("K5", 5)),
            *(RESET, Wait(3.4), *TWO_HOLDS),
        ),
        "clover": (
            *(Enter("Speed", 4), Enter("K1", 2500), Enter("K2", 100), Enter("K5", 5)),
            *(RESET, Wait(3), *TWO_HOLDS),
        ),
        "real-one": (
            *(*TWO_BULGES, Enter("Speed", 5.2), Enter("K1", 2500), Enter("K2", 100)),
            *(Enter("K3", 8000), Enter("K5", 7), RESET, Wait(3.3), *TWO_HOLDS),
        ),
    },
}
QUICK = ("01-path-or-timetable", "03-the-five-bar", "05-invariance")
"""Lessons whose tasks show every kind of gesture; those of the others are marked `thorough`."""
BY_TOUCH: dict[str, dict[str, tuple[Gesture, ...]]] = {
    "01-path-or-timetable": {"push-across": (Pull(30, 0, seconds=1), Wait(2))},
    "03-the-five-bar": {"dear": SOLUTIONS["03-the-five-bar"]["dear"]},
    "05-invariance": SOLUTIONS["05-invariance"],
}
"""At least one task for each kind of gesture: pull, drag of a control point, slider, button."""


def cases(solutions: dict[str, dict[str, tuple[Gesture, ...]]]) -> list[tuple[str, str]]:
    """Lesson and task of each solution, in order."""
    return [(lesson, task) for lesson, tasks in solutions.items() for task in tasks]


def opened(browser: Browser, server: LabServer, touch: bool) -> Iterator[Hands]:
    """Open a student's tab."""
    context = browser.new_context(viewport={"width": 1280, "height": 800}, has_touch=touch)
    tab = Tab(server, context, draws=False)
    yield Hands(tab, touch)
    assert tab.errors == []
    context.close()


@pytest.fixture(scope="module")
def mouse(browser: Browser, server: LabServer) -> Iterator[Hands]:
    yield from opened(browser, server, touch=False)


@pytest.fixture(scope="module")
def finger(browser: Browser, server: LabServer) -> Iterator[Hands]:
    yield from opened(browser, server, touch=True)


def go_to(tab: Tab, lesson: str, index: int) -> None:
    """Open a step unless it is open, and pause the lab."""
    run = tab.lab.lessons
    if run.lesson is None or run.lesson.name != lesson:
        tab.ask(c.OpenLesson(lesson))
    if run.index != index:
        step = c.GoToStep(1 if index > run.index else -1)
        tab.ask(*[step] * abs(index - run.index))
    tab.ask(c.SetRunning(False))
    title = COURSE.lesson(lesson, "en").steps[index].title
    tab.page.get_by_role("heading", name=title, exact=True).wait_for()
    tab.settle()


def do(hands: Hands, lesson: str, task: str, gestures: tuple[Gesture, ...]) -> None:
    """Do the gestures, and assert that the page shows the task as passed."""
    index, wanted = TASKS[lesson, task]
    go_to(hands.tab, lesson, index)
    for gesture in gestures:
        gesture(hands)
    try:
        wait_for(lambda: passed(hands.tab, wanted), seconds=10.0)
    except AssertionError:
        points = np.round(hands.session.editor.design.points * 1e3).tolist()
        pytest.fail("\n".join([*verdicts(hands.tab, wanted), hands.lab.message, f"{points}"]))


def passed(tab: Tab, task: Task) -> bool:
    """Whether the page shows a task as passed."""
    box = tab.page.locator(".op-box").filter(has_text=first_words(task))
    return box.filter(has_text="✓ Passed").count() == 1


def verdicts(tab: Tab, task: Task) -> list[str]:
    """The lab's verdicts on a task, in words."""
    return [verdict.words for verdict in tab.lab.lessons.verdicts.get(task.id, [])]


def first_words(task: Task) -> str:
    """The first words of a task's text, as the page shows them."""
    return html.unescape(re.sub(r"<[^>]+>", "", task.text))[:40]


def test_every_task_of_every_lesson_has_gestures_here() -> None:
    assert set(cases(SOLUTIONS)) == set(TASKS)
    assert set(cases(BY_TOUCH)) <= set(TASKS)


@pytest.mark.parametrize(("lesson", "task"), cases(SOLUTIONS))
def test_typed_numbers_are_in_the_hints(lesson: str, task: str) -> None:
    said = " ".join([TASKS[lesson, task][1].text, *TASKS[lesson, task][1].hints])
    numbers = re.findall(r"[-−]?\d+(?:\.\d+)?", html.unescape(said))
    known = {float(number.replace("−", "-")) for number in numbers}
    typed = {g.value for g in SOLUTIONS[lesson][task] if isinstance(g, Enter | Slide)}
    assert typed <= known


@pytest.mark.parametrize(
    ("lesson", "task"),
    some(cases(SOLUTIONS), [case for case in cases(SOLUTIONS) if case[0] in QUICK]),
)
def test_a_task_is_passed_by_doing_what_its_last_hint_says(
    mouse: Hands, lesson: str, task: str
) -> None:
    do(mouse, lesson, task, SOLUTIONS[lesson][task])


@pytest.mark.parametrize(("lesson", "task"), cases(BY_TOUCH))
def test_a_task_is_passed_by_touch(finger: Hands, lesson: str, task: str) -> None:
    do(finger, lesson, task, BY_TOUCH[lesson][task])


@pytest.mark.parametrize("by", ["mouse", "finger"])
def test_the_ball_under_the_end_point_is_dragged(by: str, request: pytest.FixtureRequest) -> None:
    """The first step of lesson 3 asks for it: the end-point rests on the ball at the right."""
    hands: Hands = request.getfixturevalue(by)
    tab, lab = hands.tab, hands.lab
    go_to(tab, "03-the-five-bar", 0)
    tab.elapse(2)  # both come to rest there
    end = lab.session.editor.design.points[-1] * 1e3
    assert np.linalg.norm(tab.tip(ROBOT) * 1e3 - end) < 1
    DragBall((end[0], end[1]), (end[0] - 10, end[1] + 25))(hands)
