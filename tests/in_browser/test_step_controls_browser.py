"""On a telephone, what a step of a lesson speaks of is seen and touched beside its text."""

from __future__ import annotations

from collections.abc import Iterator
from io import BytesIO

import numpy as np
import pytest
from PIL import Image

pytest.importorskip("playwright")

from playwright.sync_api import Browser, Locator, expect

from onpath.app.lab import commands as c
from onpath.app.lab.commands import TakeStep
from onpath.app.server.lab_server import LabServer
from tests.support.browser import THREE_FRAMES, WAIT, Tab, wait_for
from tests.support.built_in import built_in_course

pytestmark = pytest.mark.thorough

expect.set_options(timeout=WAIT * 1e3)
COURSE, _ = built_in_course()
LESSON, STEP = "01-path-or-timetable", 6
PINNED = ":has(> * [data-pinned])"
SCENE = 30, 20, 790, 260  # on an upright tablet, [px]
UNCOVERED = """(thing) => {
    const { x, y, width, height } = thing.getBoundingClientRect()
    const at = document.elementFromPoint(x + width / 2, y + height / 2)
    return at !== null && (thing.contains(at) || at.contains(thing))
}"""
"""Whether the middle of something is on the screen, and nothing covers it."""


@pytest.fixture(scope="module")
def tab(browser: Browser, server: LabServer) -> Iterator[Tab]:
    context = browser.new_context(viewport={"width": 390, "height": 844}, has_touch=True)
    tab = Tab(server, context, draws=False)
    yield tab
    assert tab.errors == []
    context.close()


def take(tab: Tab, lesson: str, index: int) -> None:
    """Open a step."""
    tab.ask(TakeStep(lesson, index), c.SetRunning(False))
    run = tab.lab.lessons
    wait_for(lambda: run.lesson is not None and (run.lesson.name, run.index) == (lesson, index))
    heading(tab).wait_for()
    wait_for(tab.is_built)
    tab.settle()


def heading(tab: Tab) -> Locator:
    lesson = tab.lab.lessons.lesson
    assert lesson is not None
    title = lesson.steps[tab.lab.lessons.index].title
    return tab.page.get_by_role("heading", name=title, exact=True)


def test_a_slider_is_dragged_by_a_finger_while_the_text_stays(tab: Tab) -> None:
    take(tab, LESSON, STEP)
    slider = tab.slider("K1")
    box = slider.bounding_box()
    assert box is not None
    begin = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    before = tab.session.parameters.K1
    with tab.touching(begin, (begin[0] + 80, begin[1]), in_scene=False):
        wait_for(lambda: before + 200 < tab.session.parameters.K1)
        assert heading(tab).evaluate(UNCOVERED) and slider.evaluate(UNCOVERED)


def test_what_is_below_the_text_is_not_hidden_by_the_controls(tab: Tab) -> None:
    take(tab, LESSON, STEP)
    for name in ("Next", "Back", "Set up again"):
        button = tab.button(name)
        button.scroll_into_view_if_needed()
        tab.page.wait_for_function(UNCOVERED, arg=button.element_handle())
        assert tab.slider("K1").evaluate(UNCOVERED)


def test_a_step_without_controls_leaves_its_text_all_the_room(tab: Tab) -> None:
    take(tab, LESSON, STEP)
    pinned = tab.page.locator("[data-pinned]")
    expect(pinned).to_have_count(1)
    take(tab, LESSON, 3)
    expect(pinned).to_have_count(0)
    take(tab, LESSON, STEP)
    expect(pinned).to_have_count(1)
    tab.ask(c.FinishLesson())
    expect(pinned).to_have_count(0)


@pytest.mark.parametrize("lesson", COURSE.lessons)
def test_a_control_of_every_step_is_seen_together_with_its_text(tab: Tab, lesson: str) -> None:
    front = COURSE.lesson(lesson, "en")
    covered = []
    for index, step in enumerate(front.steps):
        names = set(front.scene_at(index).controls) - {"hold"}
        if not names:
            continue
        take(tab, lesson, index)
        first = tab.page.locator(f"{PINNED} label, {PINNED} button").first
        if not heading(tab).evaluate(UNCOVERED) or not first.evaluate(UNCOVERED):
            covered.append((step.title, names))
    assert covered == []


def test_controls_with_more_than_fits_leave_the_robots_to_be_seen(
    browser: Browser, server: LabServer
) -> None:
    """Chromium without a GPU painted the background of the controls over the scene as well."""
    context = browser.new_context(viewport={"width": 820, "height": 1180})
    tab = Tab(server, context)
    take(tab, "07-flexible-link", 7)
    controls = tab.page.locator(f".mantine-Paper-root{PINNED}").last
    assert controls.evaluate("each => each.scrollHeight > each.clientHeight")
    tab.page.evaluate(THREE_FRAMES)
    picture = Image.open(BytesIO(tab.page.screenshot())).convert("L")
    assert np.asarray(picture.crop(SCENE)).min() < 128
    context.close()
