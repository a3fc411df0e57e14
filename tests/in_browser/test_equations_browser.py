"""No equation of any lesson has to be scrolled sideways, beside the scene or on a telephone."""

from __future__ import annotations

import pytest

pytest.importorskip("playwright")

from playwright.sync_api import Browser

from onpath.app.lab.commands import TakeStep
from onpath.app.server.lab_server import LabServer
from onpath.app.steps.step_html import part_of, step_html
from onpath.lessons.schema import Lesson
from onpath.lessons.words import ENGLISH
from tests.support.browser import Tab
from tests.support.built_in import built_in_course

pytestmark = pytest.mark.thorough

COURSE, _ = built_in_course()
SIZES = ((1280, 800), (390, 844))
SUM = "<mi>x</mi><mo>+</mo>" * 300  # wider than any page
WIDE = """(html) => {
    const words = document.querySelector("#op-column .step.open .words")
    words.innerHTML = html
    for (const fold of words.querySelectorAll("details")) fold.open = true
    dispatchEvent(new Event("resize"))  // the page makes them smaller if need be
    return [...words.querySelectorAll("math")]
        .filter((each) => each.scrollWidth > each.clientWidth + 1)
        .filter((each) => getComputedStyle(each).overflowX !== "visible")
        .map((each) => [each.textContent, each.scrollWidth, each.clientWidth])
}"""
"""Equations that are wider than their place, in folds, too, if a step has this text."""
CUT = """() => {
    const words = document.querySelector("#op-column .step.open .words")
    const { right } = words.getBoundingClientRect()
    return [...words.querySelectorAll(".math.inline:not(td *)")]
        .filter((each) => each.getBoundingClientRect().right > right + 1)
        .map((each) => each.textContent)
}"""
"""Formulas in the same text of which nobody can see the end."""


def html_of(lesson: Lesson, index: int) -> str:
    parts = [part_of(lesson, index, i, ENGLISH) for i in range(len(lesson.steps[index].blocks))]
    return step_html(lesson, index, parts, ENGLISH)


def test_every_equation_is_seen_at_once(browser: Browser, server: LabServer) -> None:
    context = browser.new_context()
    tab, wide, equations = Tab(server, context, draws=False), dict[str, object](), 0
    tab.ask(TakeStep(next(iter(COURSE.lessons)), 0))
    tab.wait_until_built()
    for width, height in SIZES:
        tab.page.set_viewport_size({"width": width, "height": height})
        tab.settle()
        assert tab.page.evaluate(WIDE, f"<p class=op-text><math display=block>{SUM}</math></p>")
        assert tab.page.evaluate(CUT) == []
        for name in COURSE.lessons:
            lesson = COURSE.lesson(name, "en")
            for index, step in enumerate(lesson.steps):
                equations += (html := html_of(lesson, index)).count("<math")
                if found := tab.page.evaluate(WIDE, html) + tab.page.evaluate(CUT):
                    wide[f"{step.title}, {width} px"] = found
    assert wide == {} and equations > 300
    context.close()
