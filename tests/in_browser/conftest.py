"""Fixtures: one Chromium for all tests in a browser, and one server for each file."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import pytest

from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.server.lab_server import LabServer

if TYPE_CHECKING:
    from playwright.sync_api import Browser


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
