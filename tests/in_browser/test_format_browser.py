"""What a lesson's step plots and draws, in a real browser; it goes with its step."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

pytest.importorskip("playwright")

from playwright.sync_api import Browser, expect

from onpath.app.lab import commands as c
from onpath.app.lab.commands import TakeStep
from onpath.app.server.lab_server import LabServer
from onpath.lessons.course import BUILT_IN
from onpath.lessons.parse import read_lesson
from tests.support.browser import Tab, wait_for

pytestmark = pytest.mark.thorough

ERRORS, TUBE, MASS = "/show/errors/e_0", "/show/tube", "/show/mass"


@pytest.fixture
def tab(browser: Browser, server: LabServer) -> Iterator[Tab]:
    context = browser.new_context(viewport={"width": 1280, "height": 800})
    tab = Tab(server, context, draws=False)
    yield tab
    assert tab.errors == []
    context.close()


def open_step(tab: Tab, lesson: str, title: str) -> None:
    """Open a step by its title."""
    steps = read_lesson(BUILT_IN / lesson / "en.md").steps
    tab.ask(TakeStep(lesson, [step.title for step in steps].index(title)))
    tab.page.get_by_role("heading", name=title).wait_for()


def is_drawn(tab: Tab, name: str) -> bool:
    return tab.client.scene.get_handle_by_name(name) is not None


def test_the_phase_plane_shows_the_way_of_the_state(tab: Tab) -> None:
    open_step(tab, "05-invariance", "The price of a velocity across")
    plane = tab.page.locator("svg[data-plot=phase]").filter(visible=True)
    expect(plane).to_have_count(1)
    ways = plane.locator("polyline")
    wait_for(lambda: len((ways.first.get_attribute("points") or "").split()) > 30)
    xs = [float(pair.split(",")[0]) for pair in (ways.last.get_attribute("points") or "").split()]
    assert max(xs) > 190 and abs(xs[-1] - 150) < 40  # out to the right, and back to the middle
    open_step(tab, "06b-friction-and-the-integral", "Stick, slip, wait")
    expect(plane).to_have_count(1)
    expect(tab.page.locator(".uplot").filter(has_text="ξ₁ [mm]", visible=True)).to_have_count(1)
    tab.ask(c.CloseLesson())
    expect(plane).to_have_count(0)


def test_drawings_come_and_go_with_their_step(tab: Tab) -> None:
    open_step(tab, "02-what-is-the-error", "Two errors, one triangle")
    wait_for(lambda: is_drawn(tab, ERRORS))
    open_step(tab, "02-what-is-the-error", "Which point is closest?")
    wait_for(lambda: is_drawn(tab, TUBE) and not is_drawn(tab, ERRORS))
    open_step(tab, "04-across-and-along", "Cancelled, not neglected")
    wait_for(lambda: is_drawn(tab, MASS) and not is_drawn(tab, TUBE))
    tab.ask(c.CloseLesson())
    wait_for(lambda: not is_drawn(tab, MASS))
