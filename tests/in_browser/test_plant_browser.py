"""A page that drives a plant, and one that watches, at the sizes of a desk and of a telephone."""

from __future__ import annotations

import multiprocessing
import socket
import struct
import threading
import time
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

pytest.importorskip("playwright")

from playwright.sync_api import Browser, Page, ViewportSize, expect

from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.plant import controller_process, lab_plant
from onpath.app.plant.datagrams import Measured, measurement
from onpath.app.plant.lab_plant import PlantChoice
from onpath.app.server.lab_server import LabServer
from onpath.app.server.server_options import ServerOptions
from onpath.models.paths.curves import circle
from onpath.models.systems.catalogue import ROBOTS
from tests.support.browser import NO_TRIANGLES, SEEN, SELDOM, WAIT, wait_for

expect.set_options(timeout=WAIT * 1e3)
DESK: ViewportSize = {"width": 1280, "height": 800}
TELEPHONE: ViewportSize = {"width": 390, "height": 844}
SETTINGS = {"torque_limit": "5", "control_rate": "50"}
IN_SIGHT = """button => {
    const { left, right, top, bottom } = button.getBoundingClientRect()
    const inside = left >= 0 && top >= 0 && right <= innerWidth && bottom <= innerHeight
    const hit = document.elementFromPoint((left + right) / 2, (top + bottom) / 2)
    return inside && hit === button && right - left >= 120 && bottom - top >= 60
}"""
"""Whether a button is large, and nothing covers it."""


class Arm:
    """An arm that stands still and measures; notes the codes of what is answered."""

    def __init__(self, port: int) -> None:
        self.codes, self._goes_on = list[int](), True
        self._port = port
        self._thread = threading.Thread(target=self._run)
        self._thread.start()

    def _run(self) -> None:
        robot = ROBOTS["two_link_arm"].make(ROBOTS["two_link_arm"].parameters())
        q, number = robot.rest(robot.frame.lift(circle(0.03).at(np.array(0.0)))), 0
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as arm:
            arm.connect(("127.0.0.1", self._port))
            arm.settimeout(0.02)
            begun = time.monotonic()
            while self._goes_on:
                number += 1
                t = time.monotonic() - begun
                try:
                    arm.send(measurement(Measured(number, t, q, np.zeros(2))))
                    self.codes.append(struct.unpack_from("<4sIq", arm.recv(999))[2])
                    time.sleep(0.01)
                except OSError:  # nobody answers
                    continue

    def leave(self) -> None:
        self._goes_on = False
        self._thread.join()


@pytest.fixture(scope="module")
def plant_server() -> Iterator[LabServer]:
    begun, controller_process.START = controller_process.START, "forkserver"
    lost, lab_plant.LOST = lab_plant.LOST, WAIT  # since a busy machine lets a page wait
    multiprocessing.set_forkserver_preload([controller_process.__name__])
    plant = PlantChoice(address=("127.0.0.1", 0), fastest=50.0, silence=100)
    robot = ROBOTS["two_link_arm"]
    options = ServerOptions(robot=robot, settings=SETTINGS, plant=plant)
    server = LabServer("127.0.0.1", 0, LoopCache(), options)
    yield server
    server.stop()
    controller_process.START, lab_plant.LOST = begun, lost


def opened(browser: Browser, server: LabServer, size: ViewportSize, key: str = "") -> Page:
    """A page in a browser of its own, once it shows the lab."""
    context = browser.new_context(viewport=size)
    context.set_default_timeout(WAIT * 1e3)
    context.add_init_script(SEEN + NO_TRIANGLES + SELDOM)
    page = context.new_page()
    page.goto(f"{server.address}/{key and f'#drive={key}'}")
    page.locator("#op-plant").wait_for()
    return page


def phase(page: Page) -> Any:
    return page.locator("#op-plant").get_attribute("data-phase")


def begin(page: Page, server: LabServer) -> Arm:
    """Start, and let an arm measure."""
    page.get_by_role("button", name="START").click()
    expect(page.locator("#op-plant")).to_have_attribute("data-phase", "waiting")
    assert server.desk is not None and server.desk.scheduled.lab.plant is not None
    arm = Arm(int(server.desk.scheduled.lab.plant.address.rpartition(":")[2]))
    expect(page.locator("#op-plant")).to_have_attribute("data-phase", "running")
    return arm


def test_one_page_drives_and_a_page_that_watches_cannot(
    browser: Browser, plant_server: LabServer
) -> None:
    """What ends it is seen, whatever is open; a page that watches cannot do anything."""
    assert plant_server.desk is not None
    driver = opened(browser, plant_server, DESK, plant_server.desk.key)
    watcher = opened(browser, plant_server, TELEPHONE)
    simulation = plant_server.desk.scheduled.simulation
    stop = driver.get_by_role("button", name="STOP")
    assert "drive" not in driver.url
    for page in (driver, watcher):
        for name in ("Pause", "Reset", "Hold both back", "Lessons"):
            expect(page.get_by_role("button", name=name, exact=True)).to_be_hidden()
    expect(watcher.get_by_text("This page watches")).to_be_visible()
    expect(watcher.get_by_role("button", name="STOP")).to_be_hidden()
    arm = begin(driver, plant_server)
    for command in (
        {"is": "drive", "what": "stop"},
        {"do": "Set", "name": "K1", "value": 49},
        {"is": "set", "name": "K1", "value": 49, "number": 1},
    ):
        watcher.evaluate("command => window.onpathLab.send(command)", command)
    driver.evaluate("() => window.onpathLab.send({ do: 'Reset' })")
    expect(driver.get_by_text("With a real arm this cannot be done.").first).to_be_visible()
    assert phase(watcher) == "running", watcher.locator("#op-plant").inner_text()
    assert simulation.parameters.K1 != 49
    driver.get_by_role("button", name="More").click()
    driver.get_by_role("button", name="Help and keys").click()
    for size in (DESK, TELEPHONE):
        driver.set_viewport_size(size)
        wait_for(lambda: stop.evaluate(IN_SIGHT))
    stop.click()
    expect(driver.locator("#op-plant")).to_have_attribute("data-phase", "ended")
    expect(watcher.locator("#op-plant")).to_contain_text("somebody has pressed STOP")
    wait_for(lambda: arm.codes[-1] != 0)
    arm.leave()
    driver.keyboard.press("Escape")  # closes the help
    wait_for(lambda: stop.evaluate(IN_SIGHT))
    arm = begin(driver, plant_server)
    driver.keyboard.press("Escape")
    wait_for(lambda: arm.codes[-1] != 0)
    arm.leave()
    arm = begin(driver, plant_server)
    driver.context.close()
    expect(watcher.locator("#op-plant")).to_contain_text("the page that drives it is lost")
    wait_for(lambda: arm.codes[-1] != 0)
    arm.leave()
    watcher.context.close()
