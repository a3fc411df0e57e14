"""A speed profile and the poles at a place, in a real browser."""

from __future__ import annotations

import re

import pytest

pytest.importorskip("playwright")

from playwright.sync_api import Browser, expect

from onpath.app.lab import commands as c
from onpath.app.server.lab_server import LabServer
from onpath.models.control.sides import RIGHT
from tests.support.browser import Tab, wait_for

pytestmark = pytest.mark.thorough


def test_a_profile_is_chosen_and_the_poles_tell_their_place(
    browser: Browser, server: LabServer
) -> None:
    context = browser.new_context(viewport={"width": 1280, "height": 800})
    tab = Tab(server, context, draws=False)
    tab.choose("Speed profile", "stop and go")
    wait_for(lambda: tab.simulation.parameters.speed_profile == "stop_and_go")
    speeds = set[bool]()

    def has_stopped_and_gone() -> bool:
        speeds.add(abs(tab.simulation.runs[RIGHT].shown()["speed_ref"][0]) < 1e-9)
        return len(speeds) == 2

    wait_for(has_stopped_and_gone)
    tab.ask(c.ChooseLaw(RIGHT, "virtual_constraint"), c.ChoosePath("ellipse"))
    there = tab.page.get_by_text(re.compile("at θ = [0-9]+°; they vary along the path"))
    expect(there).to_be_visible(timeout=20_000)
    assert tab.errors == []
    context.close()
