"""A window that is turned or stretched keeps the robots in sight, and its panel beside or below."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest

pytest.importorskip("playwright")

from playwright.sync_api import Browser

from onpath.app.lab import commands as c
from onpath.app.scene.stage_catalogue import stage_of
from onpath.app.server.lab_server import LabServer
from tests.support import browser as support
from tests.support.browser import Tab, wait_for

pytestmark = pytest.mark.thorough

TURNS = [(1180, 820), (820, 1180), (1180, 820), (1280, 800), (1280, 1600), (1280, 800)]
WINDOWS = [(640, 400), (844, 390), (1024, 768), (1180, 820), (1280, 800), (1366, 768), (1920, 1080)]
LESSON = "01-path-or-timetable"
SHEET = "#op-panel.open"


@pytest.fixture(scope="module")
def tab(browser: Browser, server: LabServer) -> Iterator[Tab]:
    context = browser.new_context()
    with pytest.MonkeyPatch.context() as patch:  # fewer pixels round the canvas
        patch.setattr(support, "COARSER", support.COARSE)
        tab = Tab(server, context, draws=False)
    yield tab
    assert tab.errors == []
    context.close()


IN_SIGHT = """box => {
    const {left, top, width, height} = box.getBoundingClientRect()
    const at = document.elementFromPoint(left + width / 2, top + height / 2)
    return box.contains(at) || at?.contains(box)
}"""


def seen(tab: Tab) -> tuple[np.ndarray, dict[str, float]]:
    """Pixels of the corners of the robots' boxes, and the part of the scene that is in sight."""
    stage = stage_of(tab.simulation.robot)
    left = next(iter(stage.bases))
    corners = [tab.pixel(left, corner - stage.bases[left]) for corner in stage.corners]
    box = tab._canvas()
    sheet = tab.page.locator(SHEET)
    covered = sheet.bounding_box() if sheet.count() else None
    bottom = box["y"] + box["height"]
    if covered:
        bottom = min(bottom, covered["y"])
    return np.array(corners), {**box, "bottom": bottom}


def in_sight(tab: Tab) -> bool:
    """Whether both robots are large and in the uncovered part of the scene."""
    corners, box = seen(tab)
    low, high = corners.min(axis=0), corners.max(axis=0)
    free = np.array([box["width"], box["bottom"] - box["y"]])
    inside = low[0] > box["x"] - 5 and high[0] < box["x"] + box["width"] + 5
    above = low[1] > box["y"] - 5 and high[1] < box["bottom"] + 5
    return bool(inside and above and ((high - low) / free).max() > 0.75)


def test_the_robots_stay_in_sight_while_a_window_is_turned_and_stretched(tab: Tab) -> None:
    for command in (c.CloseLesson(), c.OpenLesson(LESSON)):
        tab.ask(command)
        for width, height in TURNS:
            tab.page.set_viewport_size({"width": width, "height": height})
            wait_for(lambda: in_sight(tab), state=lambda: str(seen(tab)))
            tab.ask(c.SetRunning(False))


def test_the_robots_have_their_share_of_every_window(tab: Tab) -> None:
    for step in (None, 0, 6):  # no lesson, and steps without and with controls
        command = c.CloseLesson() if step is None else c.TakeStep(LESSON, step)
        tab.ask(command, c.SetRunning(False))
        tab.wait_until_built()
        for width, height in WINDOWS:
            tab.page.set_viewport_size({"width": width, "height": height})
            least = 0.5 if step is not None and width < 1280 else 0.4
            wait_for(
                lambda w=width, part=least: tab._canvas()["width"] >= part * w,
                state=lambda: str(tab._canvas()),
            )
            wait_for(lambda: in_sight(tab), state=lambda: str(seen(tab)))
            if step == 6:
                slider = tab.slider("K1")
                slider.scroll_into_view_if_needed()
                wait_for(lambda slider=slider: slider.evaluate(IN_SIGHT))
                tab.page.locator("#op-column .open h2").first.scroll_into_view_if_needed()
            if step is not None:
                for each in (tab.page.locator("#op-column .open h2").first, tab.button("Next")):
                    wait_for(lambda each=each: each.evaluate(IN_SIGHT))
