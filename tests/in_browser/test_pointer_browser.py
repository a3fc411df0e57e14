"""The mouse and fingers in the scene: what moves a robot never moves the view."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest

pytest.importorskip("playwright")

from playwright.sync_api import Browser

from onpath.app.lab import commands as c
from onpath.app.server.lab_server import LabServer
from tests.support.browser import Tab, wait_for
from tests.support.fingers import fingers

pytestmark = pytest.mark.thorough

SCENES = """window.__THREE_DEVTOOLS__ = new EventTarget()
__THREE_DEVTOOLS__.addEventListener("observe", ({detail}) => {
    if (detail.isScene) (window.scenes ??= []).push(detail)
})"""
ARROWS = """() => scenes.flatMap(scene => scene.children)
    .filter(each => each.type === "ArrowHelper").map(each => each.visible)"""


@pytest.fixture
def tab(browser: Browser, server: LabServer) -> Iterator[Tab]:
    context = browser.new_context(viewport={"width": 1280, "height": 800}, has_touch=True)
    context.add_init_script(SCENES)
    tab = Tab(server, context, draws=False)
    tab.ask(c.SetRunning(False))
    tab.settle()
    yield tab
    assert tab.errors == []
    context.close()


def view(tab: Tab) -> np.ndarray:
    tab.answer()
    return np.concatenate([tab.client.camera.position, tab.client.camera.look_at])


def beside(tab: Tab) -> list[tuple[float, float]]:
    """Two places beside the end-point, in the empty scene."""
    x, y = tab.placed("right", tab.tip("right"))
    return [(x - 90, y - 70), (x - 190, y - 120)]


def test_a_miss_does_not_tilt_the_view_and_the_right_button_turns_it(tab: Tab) -> None:
    before = view(tab)
    for drag in (tab.dragging, tab.touching):
        with drag(*beside(tab), in_scene=False):
            tab.answer()
        assert np.allclose(view(tab), before)
        assert not tab.simulation.forces.hands
    start, end = beside(tab)
    tab.page.mouse.move(*start)
    tab.page.mouse.down(button="right")
    tab.page.mouse.move(*end, steps=4)
    tab.page.mouse.up(button="right")
    wait_for(lambda: np.linalg.norm(view(tab) - before) > 0.1)
    after = view(tab)
    assert np.allclose(after[3:], before[3:], atol=1e-3)  # about the same point


def test_two_fingers_move_the_view(tab: Tab) -> None:
    before = view(tab)
    (x, y), _ = beside(tab)
    with fingers(tab.page) as tell:

        def has_moved() -> bool:
            """Whether it has after another gesture; a page that is busy may miss one."""
            tell("touchStart", (x, y), (x - 80, y))
            for shift in (30, 60):
                tell("touchMove", (x + shift, y), (x + shift - 80, y))
            tell("touchEnd")
            return bool(np.linalg.norm(view(tab) - before) > 0.01)

        wait_for(has_moved)


def test_a_pull_still_pulls_and_shows_no_arrow_of_viser(tab: Tab) -> None:
    x, y = tab.placed("right", tab.tip("right"))
    with tab.dragging((x, y), (x - 40, y - 30)):
        wait_for(lambda: tab.simulation.forces.hands)
        tab.settle()
        assert tab.page.evaluate(ARROWS) == [False]
    wait_for(lambda: not tab.simulation.forces.hands)
