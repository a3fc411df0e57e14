"""Pages of a real server that is late, starved or killed come back by themselves, and say so."""

from __future__ import annotations

import random
import re
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

pytest.importorskip("playwright")

from playwright.sync_api import Browser, Page, expect

from tests.support.browser import COARSER, SEEN, SELDOM
from tests.support.lab_process import LabProcess, free_ports
from tests.support.late_proxy import LateProxy
from tests.support.starved import starved

pytestmark = [
    pytest.mark.thorough,
    pytest.mark.skipif(sys.platform != "linux", reason="tried on Linux only"),
]

LONGEST = 30.0  # [s] that a first message is late
WHOLE = 12 * LONGEST  # [s] until a page has come, whose first messages come one after another
STARVED, SHARE = 30.0, 0.03  # [s], and the share of a processor; two labs need a tenth
AT_REST = "isWhole() && !document.querySelector('.op-notice')"

# Notes each moment at which a page that is not whole has said nothing for a while.
WATCH = """
const seen = name => document.querySelector(name)
window.isWhole = () => Boolean(window.onpathLab?.connected && seen("#op-strip button")
    && document.querySelectorAll(".lens canvas").length === 2
    && [...document.querySelectorAll("#op-stage .title")].every(each => each.textContent))
window.silent = []
let since = performance.now(), last = since
setInterval(() => {
    const now = performance.now(), stalled = now - last > 500
    last = now
    const fine = stalled || !document.body || isWhole() || seen(".op-notice")?.textContent
    since = fine ? now : since
    if (now - since > 1000) silent.push(now)
}, 50)
"""


@pytest.fixture
def served(tmp_path: Path) -> Iterator[LabProcess]:
    (port,) = free_ports(1)
    database = f"sqlite:///{tmp_path / 'labs.db'}"
    served = LabProcess(port, ["--database", database, "--hang-seconds", "2"], log=tmp_path / "log")
    served.wait_until_well()
    yield served
    if served.process.poll() is None:
        served.kill()


def opened(browser: Browser, port: int) -> Page:
    context = browser.new_context()
    for script in (SEEN, SELDOM, WATCH):
        context.add_init_script(script)
    page = context.new_page()
    page.goto(f"http://127.0.0.1:{port}/?{COARSER}", timeout=60_000)
    return page


def assert_whole(page: Page, within: float = WHOLE) -> None:
    """Assert that a page becomes whole, and has always said something until then."""
    page.wait_for_function(AT_REST, timeout=1e3 * within)
    expect(page.get_by_role("button", name="Hold both back")).to_be_visible()
    assert page.evaluate("silent") == []


@pytest.mark.parametrize("seed", [1, 2])
def test_a_page_whose_first_messages_are_late_becomes_whole(
    browser: Browser, served: LabProcess, seed: int
) -> None:
    draws = random.Random(seed)
    proxy = LateProxy(served.port, lambda: draws.uniform(0, LONGEST))
    page = opened(browser, proxy.port)
    try:
        assert_whole(page)
    finally:
        page.context.close()
        proxy.close()


def test_the_lab_is_there_and_obeys_before_the_script_of_its_picture_has_come(
    browser: Browser, served: LabProcess
) -> None:
    may_come = threading.Event()
    proxy = LateProxy(served.port, lambda: 0.0, may_come)
    page = browser.new_context().new_page()
    try:
        page.goto(f"http://127.0.0.1:{proxy.port}/", wait_until="commit")
        page.get_by_role("button", name="Hold both back").click()
        page.wait_for_function("onpathLab.state.held")
        expect(page.get_by_role("button", name="Draw")).to_be_visible()
        assert page.locator("canvas[data-engine]").count() == 0
        stage, strip = (page.locator(name).bounding_box() for name in ("#op-stage", "#op-strip"))
        assert stage and strip and stage["width"] > 200
        assert stage["height"] > 200 and abs(stage["y"] + stage["height"] - strip["y"]) < 1
        may_come.set()
        page.wait_for_selector("canvas[data-engine]", state="attached")
    finally:
        may_come.set()
        page.context.close()
        proxy.close()


def test_pages_of_a_starved_server_say_so_and_come_back(
    browser: Browser, served: LabProcess
) -> None:
    pages = [opened(browser, served.port) for _ in range(2)]
    for page in pages:
        assert_whole(page)
    with starved(served.process.pid, SHARE):
        begun = time.monotonic()
        for page in pages:
            slow = page.locator('.op-notice[data-cause="slow"]')
            expect(slow).to_contain_text("slow at the moment", timeout=1e3 * STARVED)
        pages[0].get_by_role("button", name="Hold both back").click()
        pages[0].wait_for_timeout(1e3 * max(STARVED - (time.monotonic() - begun), 0.0))
    for page in pages:
        page.wait_for_function(AT_REST, timeout=1e3 * WHOLE)
        assert page.evaluate("silent") == []
        page.context.close()
    assert served.process.poll() is None and "hangs" not in served.said


def test_pages_of_a_server_that_was_killed_come_back_without_being_loaded_anew(
    browser: Browser, served: LabProcess
) -> None:
    pages = [opened(browser, served.port) for _ in range(2)]
    for page in pages:
        assert_whole(page)
        page.evaluate("window.same = true")
    served.kill()
    for page in pages:
        lost = re.compile("is lost|does not answer")  # at first, and once it has asked for it
        expect(page.locator(".op-notice")).to_contain_text(lost, timeout=1e3 * LONGEST)
    served.start_again()
    for page in pages:
        assert_whole(page, 60.0)
        assert page.evaluate("window.same")
        page.context.close()
