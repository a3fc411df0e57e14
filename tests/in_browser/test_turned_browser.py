"""A window that is turned or stretched keeps the robots in sight, and its panel beside or below."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest

pytest.importorskip("playwright")

from playwright.sync_api import Browser

from onpath.app.lab import commands as c
from onpath.app.scene.stage_catalogue import stage_of
from onpath.app.server.lab_feed import LabFeed
from onpath.app.server.lab_server import LabServer
from tests.support.browser import Tab, wait_for

pytestmark = pytest.mark.thorough

WIDE, UPRIGHT, DESK, TALL = (1180, 820), (820, 1180), (1280, 800), (1280, 1600)
WINDOWS = [(640, 400), (844, 390), (1024, 768), (1180, 820), (1280, 800), (1366, 768), (1920, 1080)]
LESSON = "01-path-or-timetable"
SHEET = '.mantine-Paper-root[style*="bottom: 0"]'


@pytest.fixture(params=[(WIDE, UPRIGHT, WIDE), (UPRIGHT, WIDE, UPRIGHT), (DESK, TALL, DESK)])
def sizes(request: pytest.FixtureRequest) -> list[tuple[int, int]]:
    return list(request.param)


@pytest.fixture
def tab(browser: Browser, server: LabServer, sizes: list[tuple[int, int]]) -> Iterator[Tab]:
    width, height = sizes[0]
    context = browser.new_context(viewport={"width": width, "height": height})
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


@pytest.mark.parametrize("lesson", [False, True])
def test_the_robots_stay_in_sight(tab: Tab, sizes: list[tuple[int, int]], lesson: bool) -> None:
    if lesson:
        tab.ask(c.OpenLesson(LESSON))
    for width, height in sizes:
        tab.page.set_viewport_size({"width": width, "height": height})
        upright = width <= 0.8 * height
        view = tab.display
        assert isinstance(view, LabFeed)
        wait_for(
            lambda v=view, u=upright: (
                (page := v.page) is not None and page.is_ready and page._narrow == u
            )
        )
        wait_for(lambda u=upright: bool(tab.page.locator(SHEET).count()) == u)
        wait_for(lambda: in_sight(tab), state=lambda: str(seen(tab)))
        tab.ask(c.SetRunning(False))


@pytest.mark.parametrize("step", [None, 0, 6])  # no lesson, and steps without and with controls
def test_the_robots_have_their_share_of_every_window(
    browser: Browser, server: LabServer, step: int | None
) -> None:
    tab = Tab(server, browser.new_context(), draws=False)
    if step is not None:
        tab.ask(c.TakeStep(LESSON, step), c.SetRunning(False))
    for width, height in WINDOWS:
        tab.page.set_viewport_size({"width": width, "height": height})
        least = 0.5 if step is not None and width < 1280 else 0.4
        wait_for(
            lambda w=width, part=least: tab._canvas()["width"] >= part * w,
            state=lambda: str(tab._canvas()),
        )
        wait_for(lambda: in_sight(tab), state=lambda: str(seen(tab)))
        slider, low = tab.page.get_by_role("slider", name="K1 across"), height < 500
        if step == 6 and not low:
            wait_for(lambda s=slider: s.evaluate(IN_SIGHT))
        if step is not None:
            for each in (tab.page.locator("#op-column .open h2").first, tab.button("Next")):
                wait_for(lambda each=each: each.evaluate(IN_SIGHT))
    assert tab.errors == []
    tab.page.context.close()
