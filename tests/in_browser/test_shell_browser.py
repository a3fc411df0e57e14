"""What stands around the stage, in a real browser: head, controls, search, keys and sheets."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import pytest

from tests.support.free_lab import fresh

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Locator, Page

    from onpath.app.server.lab_server import LabServer
    from tests.support.browser import Tab

SHEETS = ("Lessons", "Help and keys", "Language, display")


@pytest.fixture(scope="module")
def ours(browser: Browser, server: LabServer) -> Iterator[Tab]:
    """A tab whose controls are our own."""
    from tests.support.browser import Tab

    context = fresh(browser)
    tab = Tab(server, context, draws=False, path="/?panel=ours&fixedDpr=0.1&then=")
    tab.page.get_by_role("banner").wait_for()
    tab.page.get_by_label("Path", exact=True).get_by_role("radio").first.wait_for()
    yield tab
    assert tab.errors == []
    context.close()


def dialog(page: Page) -> Locator:
    return page.get_by_role("dialog")


@pytest.mark.thorough
@pytest.mark.parametrize("name", SHEETS)
def test_a_sheet_closes_by_escape_cross_and_beside_and_gives_the_focus_back(
    ours: Tab, name: str
) -> None:
    page = ours.page
    button = page.get_by_role("banner").get_by_role("button", name=name)
    closings = (
        lambda: page.keyboard.press("Escape"),
        lambda: dialog(page).get_by_role("button", name="Close").click(),
        lambda: page.mouse.click(5, 300),
    )
    for close in closings:
        button.focus()
        page.keyboard.press("Enter")
        dialog(page).wait_for()
        assert page.evaluate("document.querySelector('dialog').contains(document.activeElement)")
        close()
        dialog(page).wait_for(state="detached")
        assert button.evaluate("button => button === document.activeElement")
