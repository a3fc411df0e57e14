"""Tabs of the free lab for tests with the mouse and keys; see the fixtures in in_browser."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from onpath.app.lab import commands as c

if TYPE_CHECKING:
    from playwright.sync_api import Browser, BrowserContext

    from tests.support.browser import Tab

WINDOW = {"width": 1000, "height": 700}


def fresh(browser: Browser, **options: Any) -> BrowserContext:
    """A new browser that the lab does not know."""
    return browser.new_context(**{"viewport": WINDOW, "accept_downloads": True, **options})


def begin_anew(tab: Tab) -> None:
    """Bring a tab of the free lab into its initial state, with time running."""
    from tests.support.browser import wait_for

    tab.page.keyboard.press("Escape")
    tab.page.mouse.move(1, 1)
    tab.blur()
    tab.ask(c.ResetParameters(), c.ChoosePath("circle"), c.SelectPoint(None), c.Reset())
    tab.ask(c.Set("copy", True), c.Set("rate", 1.0), c.SetRunning(True))
    wait_for(lambda: tab.simulation.time > 0.1)
