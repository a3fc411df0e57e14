"""What newcomers stumbled over, each once: buttons, plots, boards and boxes on the page."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

pytest.importorskip("playwright")

from playwright.sync_api import Browser, expect

from onpath.app.lab import commands as c
from onpath.app.lab.commands import TakeStep
from onpath.app.server.lab_server import LabServer
from onpath.models.control.sides import SIDES
from tests.support.browser import WAIT, Tab, wait_for

pytestmark = pytest.mark.thorough

LESSON = "01-path-or-timetable"
expect.set_options(timeout=WAIT * 1e3)

PRIMARY = """() => [...document.querySelectorAll("button")].filter((each) =>
    each.checkVisibility({ visibilityProperty: true }) && !each.disabled
    && (each.matches(".main") || getComputedStyle(each).backgroundColor === "rgb(0, 114, 178)"))
    .map((each) => each.innerText.trim())"""


@pytest.fixture(scope="module")
def tab(browser: Browser, server: LabServer) -> Iterator[Tab]:
    context = browser.new_context(viewport={"width": 1280, "height": 800})
    tab = Tab(server, context, draws=False)
    tab.ask(c.SetRunning(False))
    yield tab
    assert tab.errors == []
    context.close()


def take(tab: Tab, index: int, lesson: str = LESSON) -> None:
    """Open a step."""
    tab.ask(TakeStep(lesson, index), c.SetRunning(False))
    found = tab.lab.lessons.lesson
    assert found is not None
    tab.page.get_by_role("heading", name=found.steps[index].title, exact=True).wait_for()
    wait_for(tab.is_built)
    tab.settle()


def test_one_button_is_the_primary_one_and_help_is_one_press_away(tab: Tab) -> None:
    """While a prediction is awaited, it is the one that commits it."""
    assert tab.page.evaluate(PRIMARY) == ["Hold both back"]
    tab.press("More")
    expect(tab.button("Help and keys")).to_be_in_viewport()
    tab.page.keyboard.press("Escape")
    expect(tab.button("Hold both back")).to_be_in_viewport()
    take(tab, 4)
    assert tab.page.evaluate(PRIMARY) == []
    tab.page.locator("#op-column .step.open").get_by_role("radio").first.click()
    wait_for(lambda: tab.page.evaluate(PRIMARY) == ["Commit"])


def test_the_plot_a_step_speaks_of_is_seen_with_its_text_and_both_robots(tab: Tab) -> None:
    plot = tab.page.get_by_role("img", name="ξ₁ [mm]")
    take(tab, 0, "04-across-and-along")
    expect(plot).to_be_in_viewport(ratio=1)
    box = plot.bounding_box()
    assert box is not None and box["height"] >= 80
    wait_for(lambda: all(tab.placed(name, tab.tip(name))[1] < box["y"] for name in SIDES))
    expect(tab.page.locator("#op-column").get_by_role("heading").first).to_be_in_viewport()
    take(tab, 1)
    expect(plot).to_have_count(0)


def test_no_gap_is_left_for_the_hidden_buttons_on_a_telephone(
    browser: Browser, server: LabServer
) -> None:
    context = browser.new_context(viewport={"width": 390, "height": 844}, has_touch=True)
    tab = Tab(server, context, draws=False)
    take(tab, 4)
    expect(tab.page.locator("#op-strip .transport")).to_be_hidden()
    expect(tab.page.locator("#op-column .over .title")).to_be_in_viewport(ratio=1)
    gaps = """() => {
        const [strip, numbers] = ["#op-strip", "#op-strip .numbers"]
            .map(each => document.querySelector(each).getBoundingClientRect())
        return [numbers.top - strip.top, strip.bottom - numbers.bottom]
    }"""
    wait_for(lambda: all(0 <= gap < 16 for gap in tab.page.evaluate(gaps)))
    context.close()
