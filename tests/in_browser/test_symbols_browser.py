"""In the lab, a symbol of a lesson's text is lit on the robots by pointing at it, and by keys."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest

pytest.importorskip("playwright")

from playwright.sync_api import Browser

from onpath.app.lab import commands as c
from onpath.app.lab.commands import TakeStep
from onpath.app.server.lab_server import LabServer
from tests.support.browser import Tab, wait_for

pytestmark = pytest.mark.thorough
LESSON = "04-across-and-along"
SHOWN = """() => {
    const canvas = document.querySelector("#op-stage .lit-up"), found = []
    const { x, y, width } = canvas.getBoundingClientRect()
    if (!canvas.width || !canvas.height) return []
    const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height)
    const zoom = width / canvas.width
    for (let i = 0; i < data.length / 4; i++) {
        const [across, down] = [i % canvas.width, Math.floor(i / canvas.width)]
        if (data[4 * i + 3] > 200) found.push([x + zoom * across, y + zoom * down])
    }
    return found
}"""
"""Places in the window where something is drawn over the robots, [px]."""
PAINTED = """() => [...document.querySelectorAll(".lens canvas")].map(canvas => {
    const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height)
    return data.join()
})"""


@pytest.fixture(params=[(1366, 768), (390, 844)], ids=["desk", "telephone"])
def tab(request: pytest.FixtureRequest, server: LabServer, browser: Browser) -> Iterator[Tab]:
    width, height = request.param
    context = browser.new_context(viewport={"width": width, "height": height})
    tab = Tab(server, context, draws=False)
    tab.ask(c.OpenLesson(LESSON), TakeStep(LESSON, 1), c.SetRunning(False))
    tab.wait_until_built()
    yield tab
    assert tab.errors == []
    context.close()


def test_a_symbol_is_lit_by_pointing_and_by_keys(tab: Tab) -> None:
    page = tab.page
    sign = page.locator(".step.open .words [data-symbol]:visible").first
    sign.wait_for()
    name = sign.get_attribute("data-symbol")
    assert page.evaluate(SHOWN) == []
    before = page.evaluate(PAINTED)
    sign.hover()
    seen = np.array(wait_for(lambda: page.evaluate(SHOWN)))
    for side in tab.session.runs:
        tip = tab.placed(side, tab.tip(side))
        assert np.linalg.norm(seen - tip, axis=1).min() < 25, (name, side)
    wait_for(lambda: all(a != b for a, b in zip(before, page.evaluate(PAINTED), strict=True)))
    page.mouse.move(2, 2)
    wait_for(lambda: page.evaluate(SHOWN) == [])
    page.locator(".step.open .symbols summary").focus()
    page.keyboard.press("Enter")
    page.keyboard.press("Tab")
    wait_for(lambda: page.evaluate(SHOWN))
    tab.ask(c.GoToStep(1))
    wait_for(lambda: page.evaluate(SHOWN) == [])
