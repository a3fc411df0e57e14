"""The page of a lesson's step opens at its top, and says what can be done now."""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import pairwise

import pytest

pytest.importorskip("playwright")

from playwright.sync_api import Browser, expect

from onpath.app.lab import commands as c
from onpath.app.lab.commands import TakeStep
from onpath.app.server.lab_server import LabServer
from onpath.lessons.schema import Sketch
from tests.support.browser import WAIT, Tab, wait_for
from tests.support.built_in import built_in_course

pytestmark = pytest.mark.thorough
expect.set_options(timeout=WAIT * 1e3)

COURSE, _ = built_in_course()
SKETCHED = c.Predict(times=(0.0, 1.0), values=(1.0, 2.0))


def longest() -> Iterator[tuple[str, int, bool]]:
    """Steps that ask for a curve, or show a run, with the longest German text of their kind.

    What else is on the page depends on the plots of a run, and on what was predicted.
    """
    kinds = dict[tuple[bool, bool, bool], list[tuple[int, str, int]]]()
    for name, versions in COURSE.lessons.items():
        steps = versions["de"].steps
        for index, (before, step) in enumerate(pairwise((steps[0], *steps))):
            sketch = next((each for each in step.predictions() if isinstance(each, Sketch)), None)
            if sketch is None and step.script is None:
                continue
            text = step.watch if sketch is None else sketch.question
            after = any(isinstance(each, Sketch) for each in before.predictions())
            kind = (sketch is not None, after, bool(versions["de"].setup_at(index).plots))
            kinds.setdefault(kind, []).append((len(step.title) + len(text or ""), name, index))
    for (drawn, *_), found in kinds.items():
        _, name, index = max(found)
        yield name, index, drawn


LONGEST = list(longest())
LESSON, LONG = "01-path-or-timetable", "03-the-five-bar"
LINE = 24  # [px]; the browser itself may scroll so far, to keep what is read in its place
SCROLL = """(to) => {
    const words = document.querySelector("#op-column .step.open .words")
    if (to !== null) words.scrollTop = to
    return words.scrollTop
}"""
"""Scrolls the text of the open step, and returns how far it is scrolled, [px]."""
SEEN = """(heading) => {
    const { x, y, height } = heading.getBoundingClientRect()
    return heading.contains(document.elementFromPoint(x + 5, y + height / 2))
}"""


BELOW = """index => {
    const words = document.querySelector(`#step-${index + 1}.open .words`)
    const form = words?.querySelector(".form")
    if (!words || onpathLab.forms.get("step").groups.length && !form) return null
    const task = words.querySelector(".task > div")
    const row = form && [...form.querySelectorAll(".field, .acts")].find(each => each.offsetHeight)
    const { bottom } = words.getBoundingClientRect()
    return [task, row].map(each => each ? each.getBoundingClientRect().bottom - bottom : 0)
}"""
"""How far the text of a step's task, and the first row of its form, are below the fold, [px]."""
CUT = """([index, part]) => {
    const step = document.querySelector(`#step-${index + 1}.open`)
    if (!step || !step.querySelector(".ways .lead")) return null
    const {bottom} = step.querySelector(".words").getBoundingClientRect()
    const {height, bottom: own} = step.querySelector(part).getBoundingClientRect()
    const ways = [...step.querySelectorAll(".pager button")].filter(each => each.checkVisibility())
    const rows = ways.map(each => each.getBoundingClientRect())
    return [height ? own - bottom : 1e3, ...rows.map(each => each.bottom - innerHeight),
        ...rows.map(each => Math.abs(each.top + each.bottom - rows[0].top - rows[0].bottom) - 2)]
}"""
"""How far a part of a step's text is below the fold, its buttons are below the window, and how far
these are from being in one row, [px]."""
SIZES = ((1280, 800), (390, 844))
TELEPHONES = ((390, 844), (360, 640))
ENLARGED = (640, 400)  # the page of a laptop at 200 %


@pytest.fixture(scope="module")
def shared(server: LabServer, browser: Browser) -> Iterator[Tab]:
    context = browser.new_context(has_touch=True)
    tab = Tab(server, context, draws=False)
    yield tab
    assert tab.errors == []
    context.close()


@pytest.fixture(params=SIZES, ids=["desk", "telephone"])
def tab(request: pytest.FixtureRequest, shared: Tab) -> Tab:
    """A tab of some size with a lesson that has just been begun."""
    give(shared, request.param)
    shared.ask(c.CloseLesson(), c.OpenLesson(LESSON), c.BeginStepAnew())
    return shared


def give(tab: Tab, size: tuple[int, int]) -> None:
    """Give the window a size."""
    tab.page.set_viewport_size({"width": size[0], "height": size[1]})


def is_seen(tab: Tab, index: int) -> bool:
    """Whether the title of a step of the lesson is on the screen."""
    run = tab.lab.lessons
    assert run.lesson is not None
    heading = tab.page.get_by_role("heading", name=run.lesson.steps[index].title)
    return heading.count() == 1 and heading.evaluate(SEEN)


def test_a_step_opens_at_its_top(tab: Tab) -> None:
    tab.ask(TakeStep(LONG, 5))
    wait_for(lambda: is_seen(tab, 5))
    before = 5
    for index, name in ((6, "Next"), (5, "Back"), (6, "Next")):
        tab.wait_until_built()
        assert tab.page.evaluate(SCROLL, 1e6) > 0 and not is_seen(tab, before)
        tab.button(name).click()
        wait_for(lambda index=index: is_seen(tab, index))
        assert tab.page.evaluate(SCROLL, None) == 0
        before = index


@pytest.mark.parametrize("tab", SIZES[:1], indirect=True, ids=["desk"])
def test_a_hint_leaves_the_page_where_it_is(tab: Tab) -> None:
    tab.ask(TakeStep(LESSON, 6))
    wait_for(lambda: is_seen(tab, 6))
    tab.wait_until_built()
    hint = tab.page.get_by_role("button", name=re.compile(r"^Hint \(")).first
    named = hint.inner_text()
    tab.page.evaluate(SCROLL, 150)
    hint.focus()
    tab.settle()
    before = tab.page.evaluate(SCROLL, None)
    tab.page.keyboard.press("Enter")
    expect(hint).not_to_have_text(named)
    assert abs(tab.page.evaluate(SCROLL, None) - before) < LINE < before


@pytest.mark.parametrize("tab", SIZES[:1], indirect=True, ids=["desk"])
def test_what_happens_can_be_seen_without_a_prediction(tab: Tab) -> None:
    tab.ask(TakeStep(LESSON, 2))
    wait_for(lambda: is_seen(tab, 2))
    tab.page.get_by_text("First go back and make the prediction").wait_for()
    assert tab.button("Let it happen").is_disabled()
    tab.press("Skip the prediction")
    wait_for(lambda: not tab.lab.lessons.waits)
    assert tab.lab.lessons.index == 2
    tab.press("Let it happen")
    wait_for(lambda: tab.lab.lessons.playing)


def test_question_board_and_commit_are_seen_together_and_next_always(
    browser: Browser, server: LabServer
) -> None:
    context = browser.new_context(has_touch=True)
    tab, sizes = Tab(server, context, draws=False), (*SIZES, (1366, 768), ENLARGED)
    tab.ask(TakeStep(LESSON, 1))
    for size in sizes:
        give(tab, size)
        wait_for(lambda: is_seen(tab, 1))
        question = tab.page.locator(".asked.sketch .question")
        board, commit = tab.page.locator(".board"), tab.button("Commit to this prediction")
        for each in (question, board, commit):
            expect(each).to_be_in_viewport(ratio=0.99)
        box = board.bounding_box()
        assert box is not None and box["height"] > 120 and box["width"] > 250
        assert tab.button("Skip the prediction").evaluate(SEEN)
    for index in range(2, 10):
        tab.ask(c.Predict(), TakeStep(LESSON, index))
        tab.wait_until_built()
        for size in sizes:
            give(tab, size)
            forward = tab.page.locator("#op-column .ways button").last
            wait_for(lambda forward=forward: forward.evaluate(SEEN), state=lambda: f"{index}")
    assert tab.errors == []
    context.close()


@pytest.mark.parametrize("tab", SIZES[1:], indirect=True, ids=["telephone"])
def test_a_task_is_seen_at_once_with_what_it_sets(tab: Tab) -> None:
    """In German, whose words are longer."""
    tab.ask(c.SetLanguage("de"), c.SetRunning(False))
    tab.page.wait_for_function("onpathLab.lab.language === 'de'")
    for name, versions in COURSE.lessons.items():
        for index, step in enumerate(versions["de"].steps):
            if not step.tasks() or step.optional:
                continue
            tab.ask(TakeStep(name, index))
            tab.page.wait_for_function("name => onpathLab.lesson.lesson === name", arg=name)
            below = tab.page.wait_for_function(BELOW, arg=index).json_value()
            assert max(below) <= 0, (name, index, below)
            expect(tab.page.locator(".transport .brake > button")).to_be_in_viewport(ratio=0.99)
    tab.ask(c.SetLanguage("en"))
    tab.page.wait_for_function("onpathLab.lab.language === 'en'")


def test_what_is_asked_or_to_be_watched_is_read_whole_on_a_telephone(
    browser: Browser, server: LabServer
) -> None:
    """In German, whose words are longer; with the main button, before anything is pressed."""
    context = browser.new_context(has_touch=True)
    tab = Tab(server, context, draws=False)
    tab.ask(c.SetLanguage("de"), c.SetRunning(False))
    tab.page.wait_for_function("onpathLab.lab.language === 'de'")
    for name, index, drawn in LONGEST:
        before = COURSE.lesson(name, "de").steps[index - 1].predictions()
        for prediction in () if drawn else before:
            given = SKETCHED if isinstance(prediction, Sketch) else c.Predict(option=0)
            tab.ask(TakeStep(name, index - 1), given)
        tab.ask(TakeStep(name, index))
        tab.page.wait_for_function("name => onpathLab.lesson.lesson === name", arg=name)
        for size in TELEPHONES:
            give(tab, size)
            part = ".asked.sketch .question" if drawn else ".op-watch"
            cut = tab.page.wait_for_function(CUT, arg=[index, part]).json_value()
            assert max(cut) <= 0, (name, index, size, cut)
    assert tab.errors == []
    context.close()


def test_a_step_s_controls_are_in_its_card_and_the_robots_keep_their_room(shared: Tab) -> None:
    tab = shared
    tab.ask(c.CloseLesson(), c.OpenLesson(LESSON), TakeStep(LESSON, 6))
    tab.wait_until_built()
    for (width, height), least in ((SIZES[0], 0.6), (SIZES[1], 1.0), (ENLARGED, 0.5)):
        give(tab, (width, height))
        for name in ("K1", "K2", "K5", "Speed"):
            tab.slider(name).scroll_into_view_if_needed()
            expect(tab.slider(name)).to_be_in_viewport()
        expect(tab.button("Hold both back")).to_be_in_viewport(ratio=0.99)
        expect(tab.button("Next")).to_be_in_viewport(ratio=0.99)
        wait_for(lambda part=least * width: tab._canvas()["width"] > part - 1)
