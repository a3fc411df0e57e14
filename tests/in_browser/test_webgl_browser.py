"""A lost picture comes back, a browser that cannot draw says so, one without a language draws."""

from __future__ import annotations

from collections.abc import Iterator
from io import BytesIO

import numpy as np
import pytest

pytest.importorskip("playwright")

from PIL import Image
from playwright.sync_api import Browser, Page, expect

from onpath.app.lab import commands as c
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.server.lab_server import LabServer
from onpath.app.server.server_options import ServerOptions
from tests.support.browser import CHROMIUM, COARSER, PLAIN, WAIT, Tab, wait_for
from tests.support.free_lab import fresh

pytestmark = pytest.mark.thorough

COURSE = "https://school.example/course/?a=1&b=</script>"
LOSE = """
    window.isFirst = true
    window.lose = document.querySelector("canvas[data-engine]").getContext("webgl2")
        .getExtension("WEBGL_lose_context")
    window.lose.loseContext()
"""
NONE = """
    const get = HTMLCanvasElement.prototype.getContext
    HTMLCanvasElement.prototype.getContext = function (kind, ...how) {
        return kind.startsWith("webgl") ? null : get.call(this, kind, ...how)
    }
"""
SAID = "The robots are not drawn"


def test_a_lost_picture_is_reported_and_comes_back_with_the_lab(
    browser: Browser, server: LabServer
) -> None:
    context = fresh(browser)
    tab = Tab(server, context, draws=False)
    tab.ask(c.Set("K1", 640.0))
    lab, time = tab.lab, tab.simulation.time
    told = tab.page.get_by_role("alert").filter(has_text="picture of the robots was lost")
    assert told.count() == 0
    tab.page.evaluate(LOSE)
    told.wait_for(timeout=WAIT * 1e3)
    wait_for(lambda: tab.simulation.time > time + 0.5)  # the lab goes on
    tab.page.evaluate("setTimeout(() => window.lose.restoreContext())")
    tab.page.wait_for_function("window.isFirst === undefined", timeout=WAIT * 1e3)
    tab.button("Pause").wait_for()
    wait_for(lambda: tab.scheduled.display is not None and tab.scheduled.display is not tab.display)
    assert tab.scheduled.lab is lab and lab.simulation.parameters.K1 == 640.0
    assert told.count() == 0
    context.close()


@pytest.fixture(scope="module")
def with_course() -> Iterator[LabServer]:
    server = LabServer("127.0.0.1", 0, LoopCache(), ServerOptions(course_url=COURSE))
    yield server
    server.stop()


def test_without_webgl_the_lab_works_and_says_what_is_missing(
    browser: Browser, with_course: LabServer
) -> None:
    context = browser.new_context(locale="en-GB")
    context.add_init_script(NONE)
    page = context.new_page()
    page.goto(f"{with_course.address}?{COARSER}")
    page.get_by_text(SAID).wait_for(timeout=WAIT * 1e3)
    expect(page.get_by_role("link", name="To the course")).to_have_attribute("href", COURSE)
    hold(page, with_course)
    assert not with_course.server.get_clients()  # viser's part does not come
    context.close()


def hold(page: Page, server: LabServer) -> None:
    """Hold the robots back by the only page's button."""
    page.get_by_role("button", name="Hold both back").click(timeout=WAIT * 1e3)
    (visit,) = server.visits
    feed = wait_for(lambda: visit.feed)
    wait_for(lambda: feed._lab is not None and feed._lab.simulation.forces.held)


def test_a_browser_whose_3d_is_switched_off_is_told_so(browser: Browser, server: LabServer) -> None:
    arguments = (*PLAIN, "--disable-3d-apis")
    without = browser.browser_type.launch(executable_path=CHROMIUM, args=arguments)
    page = without.new_page(locale="en")
    page.goto(f"{server.address}?{COARSER}")
    page.get_by_text(SAID).wait_for(timeout=WAIT * 1e3)
    without.close()


def test_a_page_that_is_darkened_by_force_has_readable_axes(
    browser: Browser, server: LabServer
) -> None:
    """Such a browser asks for dark pages, and leaves canvases as they are: dark on dark paper."""
    arguments = (*PLAIN, "--force-dark-mode", "--enable-features=WebContentsForceDark")
    forced = browser.browser_type.launch(executable_path=CHROMIUM, args=arguments)
    tab = Tab(server, forced.new_context(color_scheme="null"), draws=False)
    plot = tab.page.locator("#op-strip .plot canvas").first
    plot.scroll_into_view_if_needed()
    tab.settle()
    picture = Image.open(BytesIO(plot.screenshot())).convert("L")
    numbers = np.asarray(picture)[:-20, :30] / 255.0  # left of the axis
    paper = float(np.median(numbers))
    assert np.abs(numbers - paper).max() > 0.5
    forced.close()
