"""The laws of the sides, chosen with a real mouse."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

pytest.importorskip("playwright")

from playwright.sync_api import Browser, expect

from onpath.app.lab import commands as c
from onpath.app.server.lab_server import LabServer
from onpath.models.control.laws.own import PATH_FOLLOWING, VIEW
from onpath.models.control.laws.registry import LAWS
from onpath.models.control.sides import DEFAULT_LAWS, LEFT, RIGHT
from tests.support.browser import Tab, wait_for

pytestmark = pytest.mark.thorough

WINDOW = {"width": 1280, "height": 800}


@pytest.fixture
def tab(browser: Browser, server: LabServer) -> Iterator[Tab]:
    context = browser.new_context(viewport=WINDOW)  # type: ignore[arg-type]
    tab = Tab(server, context, draws=False)
    yield tab
    assert tab.errors == []
    context.close()


def test_a_law_is_chosen_while_the_robot_moves(tab: Tab) -> None:
    simulation, page = tab.simulation, tab.page
    wait_for(lambda: simulation.time > 0.5)
    run = simulation.run_number
    tab.choose("Left robot", "Waiting clock")
    wait_for(lambda: simulation.laws == {**DEFAULT_LAWS, LEFT: "waiting_clock"})
    assert simulation.run_number == run and simulation.time > 0.5 and simulation.running
    told = page.locator("#op-panel [data-kind=note]")
    expect(told.get_by_text(LAWS["waiting_clock"].text)).to_be_visible()
    expect(page.get_by_role("heading", name="Waiting clock")).to_be_visible()
    expect(page.locator("#op-strip").get_by_text("Waiting clock", exact=True)).to_be_visible()
    tab.choose("Right robot", "Waiting clock")
    wait_for(lambda: simulation.laws == {LEFT: "waiting_clock", RIGHT: "waiting_clock"})
    for side in ("left", "right"):
        name = f"Waiting clock, {side}"
        expect(page.locator("#op-strip").get_by_text(name, exact=True)).to_be_visible()
    tab.ask(c.Reset())
    assert simulation.laws == {LEFT: "waiting_clock", RIGHT: "waiting_clock"}


def test_the_menu_follows_the_lab_and_lists_what_suits_the_robot(tab: Tab) -> None:
    menu = tab.page.get_by_role("combobox", name="Right robot", exact=True)
    chosen = menu.locator("option:checked")
    expect(chosen).to_have_text("Path following")
    tab.ask(c.ChooseLaw(RIGHT, "set_point"))
    expect(chosen).to_have_text("Set point")
    tab.ask(c.ChooseRobot("flexible"))
    wait_for(lambda: tab.simulation.entry.name == "flexible")
    tab.wait_until_built()
    expect(chosen).to_have_text("Set point")
    offered = menu.locator("option").all_inner_texts()
    unsuitable = [law.label for law in LAWS.values() if law.square]
    assert "Path following" in offered and unsuitable and not {*unsuitable} & {*offered}


def test_an_own_law_is_typed_and_a_typo_changes_nothing(tab: Tab) -> None:
    page, simulation = tab.page, tab.simulation
    box = page.get_by_role("textbox", name="Own law of the right robot", exact=True)
    expect(box).to_have_count(0)
    tab.choose("Right robot", "Own law…")
    expect(box).to_have_value(PATH_FOLLOWING.replace("; ", "\n"))
    assert simulation.laws == DEFAULT_LAWS  # nothing has been typed yet
    box.press("Control+A")
    box.press_sequentially("across = -K1*xii - K2*dxi")
    box.press("Shift+Enter")
    box.press_sequentially("along = -K5*(dtheta + speed)")
    box.press("Enter")
    said = "line 1, column 14: there is no 'xii': did you mean xi?"
    expect(page.get_by_role("alert").get_by_text(said)).to_be_visible()
    assert simulation.laws == DEFAULT_LAWS and simulation.running
    box.press("Control+Home")
    for _ in "across = -K1*xi":
        box.press("ArrowRight")
    box.press("Delete")
    time, run, speed = simulation.time, simulation.run_number, simulation.parameters.speed
    box.press("Enter")
    law = "across = -K1*xi - K2*dxi; along = -K5*(dtheta + speed)"
    wait_for(lambda: simulation.laws[RIGHT] == law)
    assert simulation.run_number == run and simulation.time > time
    wait_for(lambda: simulation.runs[RIGHT].shown()["theta_rate"][0] < -0.9 * speed)
    assert simulation.runs[RIGHT].max_distance < 1e-3
    expect(page.get_by_text(said)).to_have_count(0)
    expect(page.locator("#op-strip").get_by_text("Own law", exact=True)).to_be_visible()
    tab.more("Compare laws")
    tab.button("About the laws").click()
    names = page.get_by_role("dialog").locator("td code")
    names.first.wait_for()
    assert ", ".join(names.all_inner_texts()).split(", ") == [*VIEW]
    page.keyboard.press("Escape")
    tab.choose("Right robot", "Path following")
    expect(box).to_have_count(0)
    wait_for(lambda: simulation.laws == DEFAULT_LAWS)
