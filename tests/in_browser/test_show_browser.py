"""What is shown in the scene on demand, switched with a real mouse."""

from __future__ import annotations

import io
from collections.abc import Iterator

import numpy as np
import pytest

pytest.importorskip("playwright")

from matplotlib.image import imread
from playwright.sync_api import Browser, expect

from onpath.app.common import palette
from onpath.app.lab import commands as c
from onpath.app.server.lab_server import LabServer
from onpath.models.control.sides import RIGHT
from tests.support.browser import Tab, wait_for

pytestmark = pytest.mark.thorough

WINDOW = {"width": 1280, "height": 800}
NODES = ("/show/arcs", "/show/axes_0", "/show/tube", "/show/grid", "/show/rank/left")


@pytest.fixture
def tab(browser: Browser, server: LabServer) -> Iterator[Tab]:
    context = browser.new_context(viewport=WINDOW)  # type: ignore[arg-type]
    tab = Tab(server, context)
    tab.ask(c.SetRunning(False))
    yield tab
    assert tab.errors == []
    context.close()


def switch(tab: Tab, name: str) -> None:
    """Press a switch."""
    tab.switch(name).click()


def drawn(tab: Tab) -> set[str]:
    """Those of `NODES` that the scene has."""
    return {name for name in NODES if tab.client.scene.get_handle_by_name(name) is not None}


def share_of_scale(tab: Tab) -> float:
    """Share of the scene's pixels that are as bright and yellow as the map's largest values."""
    box = tab._canvas()
    clip = {**box, "width": 900.0}  # without the panel
    picture = imread(io.BytesIO(tab.page.screenshot(clip=clip)))[..., :3]  # type: ignore[arg-type]
    white = np.ones(3)
    wanted = white + 0.7 * (np.array(palette.SCALE[-1].rgb) / 255 - white)
    return float((np.abs(picture - wanted).max(axis=-1) < 0.1).mean())


def test_each_switch_draws_and_removes(tab: Tab) -> None:
    controls = tab.page.locator("#op-panel")
    tab.open("View")
    for name in (
        "Labels, axes",
        "Tube",
        "Grid along and across the path",
        "Where the laws are defined",
    ):
        expect(tab.switch(name)).not_to_be_checked()
    assert drawn(tab) == set() and share_of_scale(tab) < 0.01

    switch(tab, "Where the laws are defined")
    controls.get_by_text("in (m/s²)/(N m)").wait_for()
    wait_for(lambda: share_of_scale(tab) > 0.05)
    switch(tab, "Tube")
    controls.get_by_text("unique up to 50.0 mm").wait_for()
    tab.ask(c.SetRunning(True), c.ChoosePath("ellipse"))
    controls.get_by_text("unique up to 17.5 mm").wait_for()
    tab.ask(c.SetRunning(False))
    switch(tab, "Grid along and across the path")
    controls.get_by_text("every 5 mm of ξ").wait_for()
    switch(tab, "Labels, axes")
    wait_for(lambda: drawn(tab) == set(NODES))

    end = tab.placed(RIGHT, tab.tip(RIGHT))
    with tab.dragging(end, (end[0] + 40, end[1] - 20)):  # nothing of it is in the mouse's way
        wait_for(lambda: tab.simulation.forces.grabbed == RIGHT)
    wait_for(lambda: tab.simulation.forces.grabbed is None)

    tab.ask(c.SetLanguage("de"))  # the page is built anew, and shows the same
    wait_for(tab.is_built)
    wait_for(lambda: drawn(tab) == set(NODES))
    tab.open("Ansicht")
    for name in (
        "Namen, Achsen",
        "Schlauch",
        "Netz längs und quer zur Bahn",
        "Wo die Gesetze definiert sind",
    ):
        expect(tab.switch(name)).to_be_checked()
        switch(tab, name)
    wait_for(lambda: drawn(tab) == set() and share_of_scale(tab) < 0.01)
