"""The lab in a browser whose language is none."""

from __future__ import annotations

import pytest

pytest.importorskip("playwright")

from playwright.sync_api import Browser, expect

from onpath.app.server.lab_server import LabServer
from tests.support.browser import Tab
from tests.support.free_lab import fresh

pytestmark = pytest.mark.thorough
WITHOUT_LANGUAGE = """
    for (const [name, value] of [["language", "C"], ["languages", ["C"]]])
        Object.defineProperty(Navigator.prototype, name, { get: () => value })
"""


def test_a_browser_on_a_system_without_a_language_shows_the_lab(
    browser: Browser, server: LabServer
) -> None:
    context = fresh(browser)
    context.add_init_script(WITHOUT_LANGUAGE)
    tab = Tab(server, context, draws=False)
    expect(tab.page.get_by_role("button", name="Hold both back")).to_be_visible()
    assert not tab.errors
    context.close()
