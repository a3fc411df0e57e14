"""At 200 % of its size the page is whole: nothing is cut, hidden or scrolled sideways.

A window of 1280 by 800 pixels then has 640 by 400 of CSS, and two of its own for each of those.
"""

from __future__ import annotations

from collections.abc import Iterator

import pytest

pytest.importorskip("playwright")

from playwright.sync_api import Browser, expect

from onpath.app.lab import commands as c
from onpath.app.lab.commands import TakeStep
from onpath.app.server.lab_server import LabServer
from tests.support.browser import WAIT, Tab

pytestmark = pytest.mark.thorough

LESSON = "01-path-or-timetable"
expect.set_options(timeout=WAIT * 1e3)

SIDEWAYS = """() => [document.documentElement, ...document.querySelectorAll("body *")]
    .filter((box) => box.checkVisibility() && box.scrollWidth > box.clientWidth + 1
        && !box.matches("math[tabindex='0']")
        && ["auto", "scroll"].includes(getComputedStyle(box).overflowX))
    .map((box) => [box.outerHTML.slice(0, 150), box.scrollWidth, box.clientWidth])"""
"""What has to be scrolled sideways; but a wide formula may be, if keys can do it."""

CUT = """() => {
    const cut = []
    for (const box of document.querySelectorAll("body *")) {
        const words = [...box.childNodes].filter((node) => node.nodeType === Node.TEXT_NODE)
            .map((node) => node.textContent.trim()).join("")
        const value = box.matches("input:not([type=hidden])") ? box.value : ""
        if (!words && !value || !box.checkVisibility({ visibilityProperty: true })) continue
        if (box.closest("#op-voice, .op-unseen, math, svg, [hidden], [aria-hidden=true]")) continue
        const { left, right, width } = box.getBoundingClientRect()
        if (width === 0) continue
        const outside = left < -1 || right > innerWidth + 1
        const hides = getComputedStyle(box).overflowX !== "visible"
        if (outside || hides && box.scrollWidth > box.clientWidth + 1)
            cut.push([words || value, Math.round(left), Math.round(right), box.scrollWidth])
    }
    return cut
}"""
"""Words that do not fit where they are."""

BURIED = """async (within) => {
    const buried = []
    for (const box of document.querySelectorAll(within)) {
        if (!box.checkVisibility({ visibilityProperty: true })) continue
        if (box.closest("[aria-hidden=true]")) continue
        box.scrollIntoView({ block: "center" })
        const { x, y, width, height } = box.getBoundingClientRect()
        if (width === 0) continue
        const at = document.elementFromPoint(x + width / 2, y + height / 2)
        const near = at !== null && (at.contains(box) || box.parentElement.contains(at))
        if (!near)
            buried.push([box.outerHTML.slice(0, 150), Math.round(x), Math.round(y)])
    }
    return buried
}"""
"""Controls that are covered, or off the screen, however one scrolls."""
CONTROLS = "button, [role=slider], select, summary, input:not([type=hidden])"


@pytest.fixture(scope="module")
def shared(browser: Browser, server: LabServer) -> Iterator[Tab]:
    context = browser.new_context(viewport={"width": 640, "height": 400}, device_scale_factor=2)
    tab = Tab(server, context, draws=False)
    tab.ask(c.SetRunning(False))
    yield tab
    assert tab.errors == []
    context.close()


@pytest.fixture
def tab(shared: Tab) -> Tab:
    """A tab in which no drawer or sheet is open."""
    while shared.page.locator("dialog[open], #op-panel.open").count():
        shared.page.keyboard.press("Escape")
        shared.settle()
    return shared


def is_whole(tab: Tab, within: str = "") -> None:
    """Assert that nothing on the page is cut, buried or to be scrolled sideways."""
    tab.settle()
    assert tab.page.evaluate(SIDEWAYS) == []
    assert tab.page.evaluate(CUT) == []
    controls = ", ".join(f"{within} {each}" for each in CONTROLS.split(", "))
    assert tab.page.evaluate(BURIED, controls) == []


def test_the_lab_is_whole(tab: Tab) -> None:
    tab.button("Controls").click()
    for group in tab.page.locator("#op-panel summary").all():
        group.click()
        is_whole(tab, "#op-panel")
    tab.page.keyboard.press("Escape")
    is_whole(tab)


SHEETS = "Lessons", "Search", "Help and keys", "Language, display"


def test_every_sheet_is_whole(tab: Tab) -> None:
    dialog = tab.page.get_by_role("dialog")
    for name in SHEETS:
        if name not in SHEETS[:2]:
            tab.button("More").click()
            is_whole(tab, ".op-menu:popover-open")
        tab.button(name).click()
        dialog.wait_for()
        is_whole(tab, "dialog[open]")
        tab.page.keyboard.press("Escape")
        dialog.wait_for(state="detached")


def test_every_step_of_a_lesson_is_whole(tab: Tab) -> None:
    tab.ask(c.OpenLesson(LESSON), c.SetRunning(False))
    lesson = tab.lab.lessons.lesson
    assert lesson is not None
    for index in (0, 1, 3, 4, 6, 8, 9):
        tab.ask(TakeStep(LESSON, index), c.SetRunning(False))
        tab.page.get_by_role("heading", name=lesson.steps[index].title, exact=True).wait_for()
        tab.wait_until_built()
        is_whole(tab)
