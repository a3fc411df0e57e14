"""A page that drives a plant, and one that watches, at the sizes of a desk and of a telephone."""

from __future__ import annotations

import multiprocessing
from collections.abc import Iterator
from contextlib import contextmanager

import pytest

pytest.importorskip("playwright")

from playwright.sync_api import Browser, Page, ViewportSize, expect

from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.plant import controller_process, lab_plant
from onpath.app.plant.lab_plant import PlantChoice
from onpath.app.server.lab_server import LabServer
from onpath.app.server.server_options import ServerOptions
from onpath.models.systems.catalogue import ROBOTS
from tests.support.browser import NO_TRIANGLES, SEEN, SELDOM, WAIT, wait_for
from tests.support.still_arm import StillArm

pytestmark = pytest.mark.thorough
DESK: ViewportSize = {"width": 1280, "height": 800}
TELEPHONE: ViewportSize = {"width": 390, "height": 844}
TURNED: ViewportSize = {"width": 844, "height": 390}
SETTINGS = {"torque_limit": "5", "control_rate": "50"}
IN_SIGHT = """button => {
    const { left, right, top, bottom } = button.getBoundingClientRect()
    const inside = left >= 0 && top >= 0 && right <= innerWidth && bottom <= innerHeight
    const hit = document.elementFromPoint((left + right) / 2, (top + bottom) / 2)
    const isLarge = right - left >= 120 && bottom - top >= 60
    return inside && hit === button && (isLarge || button.className !== "stop")
}"""
"""Whether a button is whole, and large if it is STOP, and nothing covers it."""
BOTH_MOVE = """() => [0, 1].every(side => {
    const along = onpathLab.since(-1).map(each => onpathLab.field(each, side, "theta")?.[0])
    const known = along.filter(each => each !== undefined)
    return known.length > 1 && Math.max(...known) - Math.min(...known) > 0.05
})"""
"""Whether the page has seen both robots at places along their path that are 3° apart."""


@pytest.fixture(scope="module")
def plant_server() -> Iterator[LabServer]:
    """A server of which nothing but its pages ends a plant, however busy the machine is."""
    begun, controller_process.START = controller_process.START, "forkserver"
    lost, lab_plant.LOST = lab_plant.LOST, WAIT
    multiprocessing.set_forkserver_preload([controller_process.__name__])
    plant = PlantChoice(address=("127.0.0.1", 0), fastest=50.0, silence=3000, asked=WAIT)
    options = ServerOptions(robot=ROBOTS["two_link_arm"], settings=SETTINGS, plant=plant)
    server = LabServer("127.0.0.1", 0, LoopCache(), options)
    yield server
    server.stop()
    controller_process.START, lab_plant.LOST = begun, lost


def opened(browser: Browser, server: LabServer, size: ViewportSize, key: str = "") -> Page:
    """A page in a browser of its own, once it shows the plant."""
    context = browser.new_context(viewport=size)
    context.set_default_timeout(WAIT * 1e3)
    context.add_init_script(SEEN + NO_TRIANGLES + SELDOM)
    page = context.new_page()
    page.goto(f"{server.address}/{key and f'#drive={key}'}")
    page.locator("#op-plant").wait_for()
    return page


def is_in(page: Page, phase: str, cause: str = "") -> None:
    """Return once a page is told that the plant is in a phase, and why."""
    plant = page.locator("#op-plant")
    expect(plant).to_have_attribute("data-phase", phase, timeout=WAIT * 1e3)
    expect(plant).to_contain_text(cause, timeout=WAIT * 1e3)


@contextmanager
def run_from(page: Page, server: LabServer) -> Iterator[StillArm]:
    """Press START once that is possible, and let an arm go round until the plant has ended."""
    assert server.desk is not None
    lab = server.desk.scheduled.lab
    page.get_by_role("button", name="START").click()  # waits until it can be pressed
    is_in(page, "waiting")
    assert lab.plant is not None
    with StillArm(int(lab.plant.address.rpartition(":")[2]), speed=1.0) as arm:
        is_in(page, "running")
        yield arm
        arm.wait_for_an_end()


def test_one_page_drives_and_a_page_that_watches_cannot(
    browser: Browser, plant_server: LabServer
) -> None:
    """What ends it is seen on both, whatever is open."""
    assert plant_server.desk is not None
    driver = opened(browser, plant_server, DESK, plant_server.desk.key)
    watcher = opened(browser, plant_server, TELEPHONE)
    simulation = plant_server.desk.scheduled.simulation
    stop = driver.get_by_role("button", name="STOP")
    assert "drive" not in driver.url
    for page in (driver, watcher):
        for name in ("Pause", "Reset", "Hold both back", "Lessons"):
            expect(page.get_by_role("button", name=name, exact=True)).to_be_hidden()
    is_in(watcher, "off", "This page watches")
    expect(watcher.get_by_role("button", name="STOP")).to_be_hidden()
    with run_from(driver, plant_server):
        for page in (driver, watcher):
            page.wait_for_function(BOTH_MOVE)
        for command in (
            {"is": "drive", "what": "stop"},
            {"do": "Set", "name": "K1", "value": 49},
            {"is": "set", "name": "K1", "value": 49, "number": 1},
        ):
            watcher.evaluate("command => onpathLab.send(command)", command)
        driver.evaluate("() => onpathLab.send({ do: 'Reset' })")
        expect(driver.get_by_text("With a real arm this cannot be done.").first).to_be_visible()
        watcher.evaluate("async () => { await onpathLab.ask('help') }")  # after all it has sent
        is_in(watcher, "running")
        assert simulation.parameters.K1 != 49
        driver.get_by_role("button", name="More").click()
        driver.get_by_role("button", name="Help and keys").click()
        wait_for(lambda: stop.evaluate(IN_SIGHT))
        stop.click()
        for page in (driver, watcher):
            is_in(page, "ended", "somebody has pressed STOP")
    driver.keyboard.press("Escape")  # closes the help
    start = driver.get_by_role("button", name="START")
    for size in (TURNED, TELEPHONE):
        driver.set_viewport_size(size)
        wait_for(lambda: start.evaluate(IN_SIGHT))
    with run_from(driver, plant_server):
        wait_for(lambda: stop.evaluate(IN_SIGHT))
        driver.wait_for_function(BOTH_MOVE)
        driver.keyboard.press("Escape")
        is_in(watcher, "ended", "somebody has pressed STOP")
    with run_from(driver, plant_server):
        driver.context.close()
        is_in(watcher, "ended", "the page that drives it is lost")
    watcher.context.close()
