"""Laws are compared in the lab, in a real browser, while the lab goes on."""

from __future__ import annotations

import pytest

pytest.importorskip("playwright")

from playwright.sync_api import Browser, expect

from onpath.app.lab import commands as c
from onpath.app.server.lab_server import LabServer
from onpath.models.control.sides import RIGHT
from tests.support.browser import Tab, wait_for

pytestmark = pytest.mark.thorough

TYPED = "across = -K1*xi - K2*dxi; along = -K5*(dtheta - speed/2)"
STROKES = "lines => lines.map(line => getComputedStyle(line).stroke)"
TABLE = "table:has-text('largest force')"


def test_laws_are_compared_while_the_lab_goes_on(browser: Browser, server: LabServer) -> None:
    context = browser.new_context(viewport={"width": 1280, "height": 800})
    tab = Tab(server, context, draws=False)
    tab.more("Compare laws")
    tab.button("Compare").click()
    before = tab.simulation.time
    rows = tab.page.locator(f"{TABLE} tbody tr")
    expect(rows).to_have_count(3, timeout=60_000)
    wait_for(lambda: tab.simulation.time > before)
    told = {cells[0]: float(cells[1]) for cells in map(str.split, _lines(tab))}
    assert told["Trajectory"] > 40
    assert told["Path"] < 6 and told["Waiting"] < 6
    figure = tab.page.get_by_role("figure").filter(has_text="Distance from the path over time")
    expect(figure).to_be_visible()
    strokes = figure.locator("polyline").evaluate_all(STROKES)
    assert len({*strokes}) == 3 and "none" not in strokes

    tab.page.keyboard.press("Escape")
    tab.ask(c.TypeLaw(RIGHT, TYPED))
    tab.more("Compare laws")
    own = tab.page.get_by_role("checkbox", name="Own law", exact=True)
    own.check(timeout=20_000)
    tab.press("Compare")
    expect(tab.page.locator(f"{TABLE} tbody tr", has_text="Own law")).to_have_count(
        1, timeout=60_000
    )

    tab.ask(c.Set("speed", 0.0))
    tab.press("Compare")
    tab.page.get_by_text("A comparison needs a closed path").wait_for()
    assert tab.errors == []
    context.close()


def _lines(tab: Tab) -> list[str]:
    """First word of the law and the distance of each row."""
    rows = tab.page.locator(f"{TABLE} tbody tr").all()
    cells = [row.locator("th, td").all_inner_texts() for row in rows]
    return [f"{law.split()[0]} {distance}" for law, distance, *_ in cells]
