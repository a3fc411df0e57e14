"""Whoever points at a symbol of a lesson's text, or chooses it by keys, sees it on the robots."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from tests.support.site_export import LESSON, exported_site
from tests.support.site_reader import WAIT, SiteReader
from tests.support.waiting import wait_for

if TYPE_CHECKING:
    from playwright.sync_api import Browser

pytestmark = pytest.mark.thorough
LIT = "site.stage.figure.views.map(each => each.lit)"
MEANT = "spring across the path"


@pytest.fixture(scope="module")
def address(tmp_path_factory: pytest.TempPathFactory) -> str:
    site: Path = exported_site(tmp_path_factory.mktemp("site"), ("en",))
    return (site / f"{LESSON}.html").as_uri()


def test_a_symbol_is_lit_by_pointing_and_by_keys(browser: Browser, address: str) -> None:
    reader = SiteReader(browser, f"{address}#7", reduced_motion="reduce")
    page = reader.page
    reader.ready()
    assert page.evaluate(LIT) == ["", ""]
    page.locator(".step.open span[data-symbol=K_1]").first.hover()
    wait_for(lambda: page.evaluate(LIT) == ["K_1", "K_1"], WAIT)
    assert page.locator(".meaning").inner_text().startswith(f"K1: {MEANT}")
    assert page.locator(".step.open .words [data-symbol=K_1]:not(.lit)").count() == 0
    page.mouse.move(1000, 300)
    wait_for(lambda: page.evaluate(LIT) == ["", ""], WAIT)
    assert page.locator(".meaning").count() == 0
    page.locator(".step.open .symbols summary").focus()
    page.keyboard.press("Enter")
    reader.focus(page.locator(".step.open .symbols button", has_text=MEANT))
    assert page.evaluate(LIT) == ["K_1", "K_1"]
    page.keyboard.press("Tab")
    assert page.evaluate(LIT) != ["K_1", "K_1"]
    assert reader.complaints == []
    reader.context.close()
