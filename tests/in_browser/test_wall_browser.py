"""The wall and the start of a run, with a real mouse and real keys."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
import pytest

pytest.importorskip("playwright")

from playwright.sync_api import Browser, expect

from onpath.app.lab import commands as c
from onpath.app.scene.wall_nodes import ARM
from onpath.app.server.lab_server import LabServer
from onpath.models.closed_loop.obstacles import Wall
from onpath.models.control.sides import LEFT, RIGHT
from tests.support.browser import Tab, wait_for

pytestmark = pytest.mark.thorough

WINDOW = {"width": 1280, "height": 800}
NEAR = 2e-3  # [m]


@pytest.fixture
def tab(browser: Browser, server: LabServer) -> Iterator[Tab]:
    context = browser.new_context(viewport=WINDOW)  # type: ignore[arg-type]
    tab = Tab(server, context, draws=False)
    tab.ask(c.ResetParameters(), c.SetRunning(False), c.Reset())
    yield tab
    assert tab.errors == []
    context.close()


AWAY = np.array([-0.01, -0.05])  # [m], so that the wall's end is not where the end-points are


def wall_of(tab: Tab) -> Wall:
    wall = tab.simulation.wall
    assert wall is not None
    return wall


def test_a_wall_is_placed_moved_turned_and_taken_away(tab: Tab) -> None:
    simulation, keyboard = tab.simulation, tab.page.keyboard
    tab.page.mouse.move(1, 1)
    keyboard.press("m")
    wait_for(lambda: simulation.wall is not None)
    wall = wall_of(tab)
    inside = wall.place - 0.025 * wall.normal + [0.03, 0.0]  # on its solid side
    with tab.dragging(tab.placed(LEFT, inside), tab.placed(LEFT, inside + AWAY)):
        wait_for(lambda: np.linalg.norm(wall_of(tab).place - wall.place - AWAY) < NEAR)
    now = wall_of(tab)
    assert now.angle == wall.angle
    end = now.place + ARM * np.array([-now.normal[1], now.normal[0]])
    goal = now.place + 0.08 * np.array([math.cos(0.5), math.sin(0.5)])
    with tab.dragging(tab.placed(RIGHT, end), tab.placed(RIGHT, goal)):
        wait_for(lambda: abs(wall_of(tab).angle - (0.5 - math.pi / 2)) < 0.05)
    assert wall_of(tab).place == pytest.approx(now.place)
    assert not simulation.forces.hands and simulation.editor.design.name == "circle"
    for key, moved in (("l", [0.002, 0.0]), ("k", [0.0, -0.002])):
        before = wall_of(tab)
        keyboard.press(key)
        wait_for(lambda before=before: simulation.wall is not before)
        assert wall_of(tab).place - before.place == pytest.approx(moved, abs=1e-9)
    for key, turn in (("t", c.TURN), ("v", -c.TURN)):
        before = wall_of(tab)
        keyboard.press(key)
        wait_for(lambda before=before: simulation.wall is not before)
        assert wall_of(tab).angle - before.angle == pytest.approx(turn)
    tab.enter("Wall: up", "35")
    wait_for(lambda: wall_of(tab).z2 == pytest.approx(0.035))
    tab.switch("Wall").uncheck()
    wait_for(lambda: simulation.wall is None)
    expect(tab.page.get_by_role("slider", name="Wall: up")).to_have_count(0)


def test_the_force_on_the_wall_is_shown(tab: Tab) -> None:
    tab.switch("Wall").check()
    wait_for(lambda: tab.simulation.wall is not None)
    tab.elapse(3.0)
    shown = tab.row("Wall").locator("xpath=ancestor::*[@role='group']")
    expect(shown).to_contain_text("Path following 1.0 N")


def test_a_start_is_dragged_and_typed_and_taken_at_reset(tab: Tab) -> None:
    simulation = tab.simulation
    tab.ask(c.Set("speed", 0.0))
    tab.elapse(0.2)
    tab.switch("Show it, to drag it").check()
    tab.settle()
    start = simulation.start.place(simulation.editor.curve)
    goal = np.array([0.03, 0.07])
    with tab.dragging(tab.placed(RIGHT, start), tab.placed(RIGHT, goal)):
        wait_for(
            lambda: np.linalg.norm(simulation.start.place(simulation.editor.curve) - goal) < NEAR
        )
    assert not simulation.forces.hands and simulation.editor.design.name == "circle"
    expect(tab.number("Start: beside the path")).not_to_have_value("0")
    tab.enter("Start: speed along", "150")
    wait_for(lambda: simulation.start.along == pytest.approx(0.15))
    tab.enter("Start: lead of the clock", "20")
    wait_for(lambda: simulation.start.clock_offset == pytest.approx(math.radians(20)))
    before, run = simulation.start, simulation.run_number
    tab.enter("Start: beside the path", "-190")
    wait_for(lambda: "cannot start there" in tab.lab.message)
    assert simulation.start == before
    expect(tab.number("Start: beside the path")).not_to_have_value("-190")
    tab.press("Reset to it")
    wait_for(lambda: simulation.run_number > run)
    tab.ask()  # until it is at the start
    assert tab.tip(LEFT) == pytest.approx(before.place(simulation.editor.curve), abs=1e-9)
    tab.press("On the path")
    wait_for(lambda: simulation.start.beside == 0.0 == simulation.start.along)
