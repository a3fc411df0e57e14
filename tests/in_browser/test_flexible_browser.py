"""Tests of the flexible link in a browser: choose it, pull it, let it diverge, reset it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict

import numpy as np
import pytest

pytest.importorskip("playwright")

from playwright.sync_api import Browser, ViewportSize, expect

from onpath.app.lab import commands as c
from onpath.app.scene.stage_catalogue import HORIZONTAL, IN_PATH_PLANE
from onpath.app.server.lab_server import LabServer
from onpath.models.control.sides import RIGHT
from onpath.models.systems.catalogue import FLEXIBLE
from onpath.models.systems.flexible_robot import UNSTABLE
from tests.support.browser import Tab, wait_for

pytestmark = pytest.mark.thorough

FOLLOWER = RIGHT


@pytest.fixture(scope="module")
def tab(browser: Browser, server: LabServer) -> Iterator[Tab]:
    """A tab in which the flexible link has been chosen from the menu."""
    context = browser.new_context(viewport={"width": 1000, "height": 700})
    tab = Tab(server, context, draws=False)
    choose_robot(tab, FLEXIBLE.label)
    wait_for(lambda: tab.simulation.entry is FLEXIBLE and tab.simulation.time > 0.3)
    tab.settle()
    yield tab
    assert tab.errors == []
    context.close()


def choose_robot(tab: Tab, robot: str) -> None:
    """Choose a robot from all of them."""
    tab.page.locator("#op-panel [data-name=robot] button.do").click()
    tab.card(robot).click()
    tab.wait_until_built()


def deflection(tab: Tab) -> float:
    """Deflection of the follower's tip, or of a robot that has stopped, [m]."""
    robot, runs = tab.simulation.robot, tab.simulation.runs
    still = [run for run in runs.values() if run.diverged is not None]
    rows = [run.shown() for run in still or [runs[FOLLOWER]]]
    bent = [robot.measured(row["q"], row["v"], tab.simulation.parameters) for row in rows]
    return max(float(np.abs(each["deflection"]).max()) for each in bent)


def tip(tab: Tab) -> np.ndarray:
    """Position of the follower's end-point in the robot's frame for drawing, (3,), [m]."""
    lab = tab.lab
    return lab.simulation.robot.position(lab.simulation.runs[FOLLOWER].shown()["y"])


def test_the_tip_is_pulled_in_the_plane_that_was_chosen(tab: Tab) -> None:
    for plane in (IN_PATH_PLANE, HORIZONTAL):
        pulled_in(tab, plane)


def pulled_in(tab: Tab, plane: str) -> None:
    lab = tab.lab
    tab.choose("Pull in", plane)
    tab.ask(c.Set("speed", 0.0), c.Reset(), c.SetRunning(False))
    tab.ask(*[c.StepOnce()] * 50)
    tab.settle()
    before, start = tip(tab), tab.pixel(FOLLOWER, tip(tab))

    def pulled() -> np.ndarray:
        return lab.simulation.robot.position(lab.simulation.forces.hands[FOLLOWER])

    with tab.dragging(start, (start[0] + 45, start[1] + 25)):
        wait_for(lambda: lab.simulation.forces.hands and np.linalg.norm(pulled() - before) > 0.01)
        moved = pulled() - before
        flat = moved[2] if plane == HORIZONTAL else moved @ [0.1, 1.0, 0.0]
        assert abs(flat) < 1e-6
        wait_for(lambda: "Time is paused" in tab.said())
        tab.ask(c.SetRunning(True))
        wait_for(lambda: deflection(tab) > 1e-3)
    wait_for(lambda: not lab.simulation.forces.hands)
    wait_for(lambda: deflection(tab) < 1e-3)
    wait_for(lambda: "Time is paused" not in tab.said())


def test_the_path_is_dragged_in_its_slanted_plane(tab: Tab) -> None:
    lab = tab.lab
    tab.ask(c.ChoosePath("circle"), c.Reset(), c.SetRunning(False))
    tab.settle()
    old = lab.simulation.editor.design.points[3].copy()
    start, end = tab.placed(FOLLOWER, old), tab.placed(FOLLOWER, old + [0.015, 0.012])
    with tab.dragging(start, end):
        wait_for(
            lambda: lab.simulation.editor.design.name == "edited" or lab.simulation.editor.proposed
        )
    wait_for(lambda: lab.simulation.editor.design.name == "edited")
    np.testing.assert_allclose(
        lab.simulation.editor.design.points[3], old + [0.015, 0.012], atol=2e-3
    )
    tab.ask(c.SetRunning(True))
    wait_for(lambda: lab.simulation.time > 1.5)
    assert lab.simulation.runs[FOLLOWER].distance < 2e-3 and tab.said() == ""
    tab.ask(c.ChoosePath("circle"), c.Reset())


def test_a_divergence_is_caught_reported_and_reset(tab: Tab) -> None:
    lab = tab.lab
    tab.ask(c.Set("speed", 2.0), c.Reset(), c.SetRunning(True))
    tab.enter("Drawn larger", "5")
    wait_for(lambda: lab.simulation.settings.larger == 5.0)
    tab.choose("Output", "redefined")
    tab.enter("α", "0.95")
    wait_for(lambda: str(UNSTABLE) in tab.said())
    assert deflection(tab) > 0.01  # the last instant before: seen at a glance
    bar = tab.page.get_by_text("zero dynamics unstable")
    bar.wait_for()
    tab.enter("α", "0.5")
    wait_for(lambda: bar.count() == 0)
    tab.press("Reset")
    wait_for(lambda: tab.said() == "" and lab.simulation.time > 1.5)
    assert lab.simulation.runs[FOLLOWER].distance < 5e-3


def test_a_breakdown_is_shown_slowly_and_mended_from_its_message(
    browser: Browser, server: LabServer
) -> None:
    tab = Tab(server, browser.new_context(viewport={"width": 1280, "height": 800}), draws=False)
    tab.ask(c.ChooseRobot("flexible"), c.Set("output", "redefined"))
    wait_for(tab.is_built)
    tab.ask(c.SetRunning(True))
    time = tab.simulation.time
    wait_for(lambda: tab.simulation.time > time + 1.5)
    tab.ask(c.Set("alpha", 1.0))
    message = tab.page.locator("#op-message")
    wait_for(lambda: tab.lab.breakdown.replaying)  # by itself
    message.get_by_text("drawn 5 times as large").wait_for()
    expect(message).to_contain_text(str(UNSTABLE))
    message.get_by_role("button", name="Stop showing it").click()
    wait_for(lambda: not tab.lab.breakdown.replaying)
    expect(message.get_by_role("button", name="Reset with the same settings")).to_be_visible()
    message.get_by_role("button", name="Show it slowly").click()
    wait_for(lambda: tab.lab.breakdown.replaying)
    tab.page.keyboard.press("Escape")
    wait_for(lambda: not tab.lab.breakdown.replaying)
    expect(message.get_by_role("button", name="Show it slowly")).to_be_visible()
    tab.settle()
    assert not tab.lab.breakdown.replaying  # by itself once only
    message.get_by_role("button", name="Reset with α = 0.5").click()
    wait_for(lambda: asdict(tab.simulation.parameters)["alpha"] == 0.5)
    assert tab.errors == []
    tab.page.context.close()


def blow_up(tab: Tab) -> None:
    """Make the actual tip the output of the flexible robot, until it has stopped."""
    tab.ask(c.ChooseRobot("flexible"), c.Set("output", "redefined"))
    wait_for(tab.is_built)
    tab.ask(c.SetRunning(True))
    tab.ask(c.Set("alpha", 1.0))
    tab.page.locator("#op-message").get_by_role("button", name="Show it slowly").wait_for()


def test_the_replay_is_offered_with_reduced_motion_or_on_a_page_opened_later(
    browser: Browser, server: LabServer
) -> None:
    window: ViewportSize = {"width": 1280, "height": 800}
    tab = Tab(server, browser.new_context(viewport=window, reduced_motion="reduce"), draws=False)
    blow_up(tab)
    tab.settle()
    assert not tab.lab.breakdown.replaying
    tab.page.emulate_media(reduced_motion="no-preference")
    tab.reload()
    tab.page.locator("#op-message").get_by_role("button", name="Show it slowly").wait_for()
    tab.settle()
    assert not tab.lab.breakdown.replaying
    tab.page.context.close()
