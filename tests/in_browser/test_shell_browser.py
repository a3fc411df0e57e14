"""What stands around the stage, in a real browser: head, controls, search, keys and sheets."""

from __future__ import annotations

from typing import Literal

import pytest

pytest.importorskip("playwright")

from playwright.sync_api import expect

from tests.support.axe import violations
from tests.support.browser import Tab

pytestmark = pytest.mark.thorough

SHEETS = "Lessons", "File…"
MORE = "Compare laws", "Keep and share", "Help and keys", "Language, display"
"""Sheets that the menu of the head opens."""
FOREIGN = """() => [...document.querySelectorAll("#root *")].filter(each =>
    each.matches("button, input, select, textarea, a, [tabindex='0']")
    && each.checkVisibility({visibilityProperty: true}))
    .map(each => each.outerHTML.slice(0, 200))"""
"""Controls of viser's that can be seen, or reached by Tab."""


def test_a_sheet_can_be_read_and_closes_by_escape_cross_and_beside_and_gives_the_focus_back(
    tab: Tab,
) -> None:
    page = tab.page
    dialog = page.get_by_role("dialog")
    closings = (
        lambda: page.keyboard.press("Escape"),
        lambda: dialog.get_by_role("button", name="Close", exact=True).click(),
        lambda: page.mouse.click(5, 300),
    )
    tab.open("Gains and path")
    for name in (*SHEETS, *MORE):
        button, asked = tab.button("More" if name in MORE else name), tab.lab.asked
        for close in closings:
            button.focus()
            page.keyboard.press("Enter")
            if name in MORE:
                tab.button(name).focus()
                page.keyboard.press("Enter")
            dialog.wait_for()
            assert dialog.evaluate("dialog => dialog.contains(document.activeElement)")
            if close in closings[:2]:
                scheme: Literal["light", "dark"] = "light" if close is closings[0] else "dark"
                page.emulate_media(color_scheme=scheme)
                assert violations(tab) == [], (name, scheme)
            close()
            dialog.wait_for(state="detached")
            expect(button).to_be_focused()
        assert tab.lab.asked == asked


def test_no_control_of_viser_is_seen_or_reached(tab: Tab) -> None:
    assert tab.page.evaluate(FOREIGN) == []
    tab.page.evaluate("document.activeElement.blur()")
    for _ in range(60):
        tab.page.keyboard.press("Tab")
        assert not tab.page.evaluate("document.activeElement.matches('#root *')")
