"""The laws of the benches, chosen with a real mouse."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

pytest.importorskip("playwright")

from playwright.sync_api import Browser, expect

from onpath.app.lab import commands as c
from onpath.app.server.lab_server import LabServer
from onpath.models.control.benches import DEFAULT_LAWS, LEFT, RIGHT
from onpath.models.control.laws.registry import LAWS
from tests.support.browser import Tab, wait_for

WINDOW = {"width": 1280, "height": 800}


@pytest.fixture
def tab(browser: Browser, server: LabServer) -> Iterator[Tab]:
    context = browser.new_context(viewport=WINDOW)  # type: ignore[arg-type]
    tab = Tab(server, context, draws=False)
    yield tab
    assert tab.errors == []
    context.close()


def test_a_law_is_chosen_while_the_robot_moves(tab: Tab) -> None:
    session, page = tab.session, tab.page
    wait_for(lambda: session.time > 0.5)
    run = session.run_number
    tab.choose("Law, left", "Waiting clock")
    wait_for(lambda: session.laws == {**DEFAULT_LAWS, LEFT: "waiting_clock"})
    assert session.run_number == run and session.time > 0.5 and session.running
    expect(page.get_by_text(LAWS["waiting_clock"].text)).to_be_visible()
    expect(page.get_by_role("cell", name="Waiting clock")).to_be_visible()
    expect(page.locator(".u-legend").first).to_contain_text("Waiting clock")
    tab.choose("Law, right", "Waiting clock")
    wait_for(lambda: session.laws == {LEFT: "waiting_clock", RIGHT: "waiting_clock"})
    expect(page.get_by_role("cell", name="Waiting clock, right")).to_be_visible()
    expect(page.locator(".u-legend").first).to_contain_text("Waiting clock, left")
    tab.ask(c.Reset())
    assert session.laws == {LEFT: "waiting_clock", RIGHT: "waiting_clock"}


def test_the_menu_follows_the_lab_and_lists_what_suits_the_robot(tab: Tab) -> None:
    menu = tab.page.get_by_label("Law, right", exact=True).filter(visible=True).first
    expect(menu).to_have_value("Path following")
    tab.ask(c.ChooseLaw(RIGHT, "set_point"))
    expect(menu).to_have_value("Set point")
    tab.ask(c.ChooseRobot("flexible"))
    menu = tab.page.get_by_label("Law, right", exact=True).filter(visible=True).first
    expect(menu).to_have_value("Set point")
    menu.click()
    shown = tab.page.get_by_role("option")
    expect(shown.filter(has_text="Path following")).to_be_visible()
    unsuitable = [law.label for law in LAWS.values() if law.square]
    assert unsuitable and not {*unsuitable} & {*shown.all_inner_texts()}
