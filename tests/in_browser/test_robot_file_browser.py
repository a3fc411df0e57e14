"""A robot from a file in the lab: its tip is chosen, and its joints are dragged, in the picture."""

from __future__ import annotations

from collections.abc import Iterator

import casadi as ca
import numpy as np
import pytest

pytest.importorskip("playwright")

from playwright.sync_api import Browser

from onpath.app.cli.robot_options import RobotOptions
from onpath.app.common.robot_files import given_file, other_tips
from onpath.app.lab import commands as c
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.server.lab_server import LabServer
from onpath.app.server.server_options import ServerOptions
from onpath.lessons.words import ENGLISH
from onpath.models.arrays import Array
from onpath.models.systems.home_pose import length_of
from onpath.models.systems.rigid_chain import chain_frames
from tests.support.browser import Place, Tab, wait_for
from tests.support.fingers import fingers
from tests.support.free_lab import WINDOW, fresh
from tests.support.robot_files import PLANAR, urdf

pytestmark = pytest.mark.thorough

FORK = (
    '<joint name="a" type="fixed"><parent link="link3"/><child link="tool0"/>'
    '<origin xyz="0.06 0.05 0"/></joint><link name="tool0"/></robot>'
)


@pytest.fixture(scope="module")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[LabServer]:
    """A server for an arm whose file suggests three tips."""
    file = tmp_path_factory.mktemp("robot") / "fork.urdf"
    file.write_text(urdf("own", PLANAR).replace("</robot>", FORK), "utf-8")
    entry = RobotOptions(tip="tool0").entry_of(str(file))
    server = LabServer("127.0.0.1", 0, LoopCache(), ServerOptions(robot=entry))
    yield server
    server.stop()


@pytest.fixture
def tab(browser: Browser, server: LabServer) -> Iterator[Tab]:
    context = fresh(browser, viewport=WINDOW, has_touch=True)
    tab = Tab(server, context, draws=False)
    tab.ask(c.SetRunning(False))
    yield tab
    assert tab.errors == []
    context.close()


def bars_of(tab: Tab) -> Array:
    """Ends of the bars of the robot as it stands, (3, 2 k), [m]."""
    robot = tab.simulation.robot
    q = robot.system.q
    bars = ca.Function("bars", [q], [robot.skeleton(q, ca.SX(1))[0]])
    return np.array(bars(tab.simulation.runs["right"].shown()["q"]))


def ball(tab: Tab, tip: str) -> Place:
    """Where the ball of a tip is seen, of a tip on the last body."""
    robot = tab.simulation.robot
    assert robot.chain is not None
    at, q = other_tips(robot.name)[tip], robot.system.q
    assert at.body == robot.chain.n
    frames = chain_frames(robot.chain, q)
    there = frames.origins[-1] + frames.rotations[-1] @ ca.DM(at.place)
    place = ca.Function("place", [q], [there])(tab.simulation.runs["right"].shown()["q"])
    return tab.pixel("right", np.array(place)[:, 0])


def chosen(tab: Tab) -> str:
    given = given_file(tab.simulation.entry.name)
    return "" if given is None else given.tip


def test_a_tip_is_chosen_by_pressing_it_with_mouse_and_finger(tab: Tab) -> None:
    assert chosen(tab) == "tool0"
    tab.switch(ENGLISH("robots.show_tips")).check()
    tab.wait_until_built()
    tab.settle()
    tab.page.mouse.click(*ball(tab, "tip"))
    wait_for(lambda: chosen(tab) == "tip")
    tab.ask(c.SetRunning(False))
    tab.wait_until_built()
    wait_for(tab.is_framed)
    tab.settle()
    with fingers(tab.page) as tell:
        tell("touchStart", ball(tab, "tool0"))
        tell("touchEnd")
    wait_for(lambda: chosen(tab) == "tool0")


def test_the_start_is_set_by_dragging_a_link_with_mouse_and_finger(tab: Tab) -> None:
    tab.switch(ENGLISH("start.show")).check()
    for drag in (tab.dragging, tab.touching):
        tab.ask(c.StartOnPath(), c.Reset())
        tab.settle()
        before, ends = tab.simulation.start, bars_of(tab)
        middle = ends[:, -4:-2].mean(axis=1)  # of the link before the last one
        assert tab.simulation.robot.chain is not None
        away = 0.1 * length_of(tab.simulation.robot.chain)
        places = [tab.pixel("right", middle + [0.0, 0.0, dz]) for dz in (0.0, away)]
        with drag(*places):
            wait_for(lambda before=before: tab.simulation.start != before)
        assert not tab.simulation.forces.hands
