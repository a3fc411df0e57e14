"""What a lesson's step plots and draws, in a real browser; it goes with its step."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest

pytest.importorskip("playwright")

from playwright.sync_api import Browser, expect

from onpath.app.lab import commands as c
from onpath.app.lab.commands import TakeStep
from onpath.app.server.lab_server import LabServer
from onpath.lessons.course import BUILT_IN
from onpath.lessons.parse import read_lesson
from onpath.lessons.words import ENGLISH
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
    plane = tab.page.get_by_role("img", name=ENGLISH("plot.phase_name"))
    expect(plane).to_be_visible()
    across = "onpathLab.since(-1).map(sample => onpathLab.field(sample, 1, 'xi')?.[0] ?? NaN)"
    wait_for(lambda: len(tab.page.evaluate(across)) > 60)
    told = [each for each in tab.page.evaluate(across) if not np.isnan(each)]
    assert max(told) > 0.005 and abs(told[-1]) < max(told)  # out to the left, and back
    open_step(tab, "06b-friction-and-the-integral", "Stick, slip, wait")
    expect(plane).to_have_count(1)
    expect(tab.page.get_by_role("img", name="ξ₁ [mm]")).to_be_visible()
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
