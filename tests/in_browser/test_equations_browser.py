"""No equation of any lesson has to be scrolled sideways, beside the scene or on a telephone."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

pytest.importorskip("playwright")

from playwright.sync_api import Browser

from onpath.app.lab import commands as c
from onpath.app.lab.commands import TakeStep
from onpath.app.server.lab_server import LabServer
from tests.support.browser import Tab
from tests.support.built_in import built_in_course

pytestmark = pytest.mark.thorough

COURSE, _ = built_in_course()
WIDE = """() => {
    for (const fold of document.querySelectorAll("#op-column details")) fold.open = true
    return new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done(
        [...document.querySelectorAll("math")]
            .filter((each) => each.scrollWidth > each.clientWidth + 1)
            .filter((each) => getComputedStyle(each).overflowX !== "visible")
            .map((each) => [each.textContent, each.scrollWidth, each.clientWidth])))))
}"""
"""Equations that are wider than their place, in folds, too."""


SIZES = ((1280, 800), (390, 844))


@pytest.fixture(scope="module")
def tab(browser: Browser, server: LabServer) -> Iterator[Tab]:
    context = browser.new_context()
    yield Tab(server, context, draws=False)
    context.close()


@pytest.mark.parametrize("lesson", COURSE.lessons)
def test_every_equation_is_seen_at_once(tab: Tab, lesson: str) -> None:
    wide = dict[str, object]()
    for index, step in enumerate(COURSE.lesson(lesson, "en").steps):
        tab.ask(TakeStep(lesson, index), c.SetRunning(False))
        tab.page.get_by_role("heading", name=step.title, exact=True).wait_for()
        tab.wait_until_built()
        if step.kind == "run":
            if tab.lab.lessons.waits:
                tab.press("Skip the prediction")
            read = tab.button("Read on without it")
            read.click()
            read.wait_for(state="hidden")
        for width, height in SIZES:
            tab.page.set_viewport_size({"width": width, "height": height})
            if found := tab.page.evaluate(WIDE):
                wide[f"{step.title}, {width} px"] = found
    assert wide == {}
