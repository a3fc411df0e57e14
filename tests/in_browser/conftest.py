"""Fixtures: one Chromium for all tests in a browser, one server for each file, and its free lab."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import pytest

from onpath.app.lab import commands as c
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.server.lab_server import LabServer
from tests.support.free_lab import begin_anew, fresh

if TYPE_CHECKING:
    from playwright.sync_api import Browser

    from tests.support.browser import Tab


@pytest.fixture(scope="package")
def browser() -> Iterator[Browser]:
    """A browser for the tests of this folder; while it is open, no test can use asyncio here."""
    from playwright.sync_api import sync_playwright

    from tests.support.browser import CHROMIUM, PLAIN

    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=PLAIN)
        yield browser
        browser.close()


@pytest.fixture(scope="module")
def server() -> Iterator[LabServer]:
    """A server without a class and without a database."""
    server = LabServer("127.0.0.1", 0, LoopCache())
    yield server
    server.stop()


@pytest.fixture(scope="module")
def free_lab(browser: Browser, server: LabServer) -> Iterator[Tab]:
    """A tab for a whole file; see `tab`."""
    from tests.support.browser import Tab

    context = fresh(browser)
    yield Tab(server, context, draws=False)
    context.close()


@pytest.fixture
def tab(free_lab: Tab) -> Iterator[Tab]:
    """A tab in its initial state; asserts afterwards that its page reports no error."""
    begin_anew(free_lab)
    yield free_lab
    free_lab.ask(c.SetRunning(False))  # stops drawing: other tabs need the processor
    assert free_lab.errors == []


@pytest.fixture
def other(browser: Browser, server: LabServer) -> Iterator[Tab]:
    """A tab in another browser."""
    from tests.support.browser import Tab

    context = fresh(browser)
    yield Tab(server, context, draws=False)
    context.close()
