"""The first minute, and what a screen reader and keys find on the page, in a real browser."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

import pytest

pytest.importorskip("playwright")

from playwright.sync_api import Browser, ViewportSize, expect

from onpath.app.lab import commands as c
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.server.lab_server import LabServer
from onpath.app.view.first_minute import INVITATIONS
from tests.support.axe import violations
from tests.support.browser import WAIT, Tab, wait_for

pytestmark = pytest.mark.thorough

WINDOW: ViewportSize = {"width": 1280, "height": 800}
LESSON = "01-path-or-timetable"
expect.set_options(timeout=WAIT * 1e3)


def visit(browser: Browser, server: LabServer, newcomer: bool = False, **options: Any) -> Tab:
    context = browser.new_context(**{"viewport": WINDOW, **options})
    return Tab(server, context, draws=False, newcomer=newcomer)


WATCH = """
window.uncovered = []
function look() {
    for (const each of document.querySelectorAll("#root :is(button, input, a)")) {
        const {left, top, width, height} = each.getBoundingClientRect()
        const at = document.elementFromPoint(left + width / 2, top + height / 2)
        if (at !== null && each.contains(at)) window.uncovered.push(each.outerHTML)
    }
    window.looks = (window.looks ?? 0) + (document.querySelector("#root > *") !== null)
    requestAnimationFrame(look)
}
requestAnimationFrame(look)
"""
"""Looks in each frame whether any control of viser's own page can be seen."""


@pytest.fixture(scope="module")
def tab(browser: Browser, server: LabServer) -> Iterator[Tab]:
    tab = visit(browser, server)
    yield tab
    assert tab.errors == []
    tab.page.context.close()


# The first minute.


def test_nothing_is_seen_of_the_viewer_s_own_page(browser: Browser, server: LabServer) -> None:
    context = browser.new_context(viewport=WINDOW)
    context.add_init_script(WATCH)
    tab = Tab(server, context, draws=False)
    tab.button("Hold both back").wait_for()
    assert tab.page.evaluate("window.looks") > 0
    assert tab.page.evaluate("window.uncovered") == []
    tab.press("Hold both back")
    wait_for(lambda: len(tab.simulation.forces.held) == 2)
    context.close()


def test_a_newcomer_is_invited_once(browser: Browser, server: LabServer) -> None:
    tab = visit(browser, server, newcomer=True)
    invitation, spoken = tab.page.locator("#op-invitation"), tab.page.locator("#op-voice")
    expect(tab.button("Hold both back")).to_have_class(re.compile("invited"))
    tab.button("Hold both back").click()
    wait_for(lambda: len(tab.simulation.forces.held) == 2)
    expect(invitation).to_be_hidden()
    expect(tab.button("Let both go")).not_to_have_class(re.compile("invited"))
    expect(spoken).to_contain_text(re.compile(r"Held back\. Tracker: torn off: up to \d+ mm"))
    expect(spoken).to_contain_text(re.compile(r"Follower: waits: up to \d(\.\d)? mm"))
    expect(tab.button("Let both go")).to_have_class(re.compile("invited"))
    tab.button("Let both go").click()
    wait_for(lambda: not tab.simulation.forces.held)
    expect(invitation).to_contain_text("keep still")
    tab.page.keyboard.press("d")
    wait_for(lambda: tab.simulation.forces.hands)
    expect(invitation).to_contain_text("the follower waits at your hand")
    tab.page.keyboard.press("x")
    expect(invitation).to_contain_text("Bend the path")
    tab.reload()
    expect(invitation).to_contain_text("Bend the path")
    tab.ask(c.MovePoint(2, 1.2 * tab.simulation.editor.points()[2]))
    tab.button("Open lesson 1").click()
    tab.page.get_by_role("heading", name="Two robots, one circle").wait_for()
    expect(invitation).to_be_hidden()
    kept = "() => localStorage.getItem('viser-user:first_minute')"
    assert tab.page.evaluate(kept) == str(len(INVITATIONS))
    assert tab.errors == []
    tab.page.context.close()


def test_the_introduction_is_followed_with_keys(browser: Browser, server: LabServer) -> None:
    tab = visit(browser, server, newcomer=True)
    page = tab.page
    tab.button("Skip the introduction").focus()
    page.keyboard.press("h")
    wait_for(lambda: len(tab.simulation.forces.held) == 2)
    expect(page.locator("#op-invited")).to_be_focused()
    expect(page.locator("#op-invited")).to_have_attribute("aria-live", "polite")
    page.context.close()


def test_the_introduction_can_be_skipped_for_good(browser: Browser, server: LabServer) -> None:
    tab = visit(browser, server, newcomer=True)
    tab.button("Skip the introduction").click()
    expect(tab.page.locator("#op-invitation")).to_be_hidden()
    tab.press("Hold both back")
    wait_for(lambda: tab.simulation.forces.held)
    tab.press("Let both go")
    wait_for(lambda: not tab.simulation.forces.held)
    tab.reload()
    time = tab.simulation.time
    wait_for(lambda: tab.simulation.time > time + 1)
    expect(tab.page.locator("#op-invitation")).to_be_hidden()
    tab.page.context.close()


# Names, headings and what is spoken.


def test_axe_finds_nothing_serious_in_the_lab(tab: Tab) -> None:
    for group in tab.page.locator("#op-panel details").all():
        if group.get_attribute("open") is None:
            group.locator("summary").press("Enter")
        assert violations(tab) == []


def test_what_acts_on_the_robots_comes_before_the_panel(tab: Tab) -> None:
    tab.page.evaluate("document.body.tabIndex = -1; document.body.focus()")  # at the top
    for _ in range(4):
        tab.page.keyboard.press("Tab")
        if tab.button("Hold both back").evaluate("each => each === document.activeElement"):
            break
    expect(tab.button("Hold both back")).to_be_focused()


def test_sliders_their_boxes_and_the_scene_have_names(tab: Tab) -> None:
    page = tab.page
    tab.open("Gains and path")
    expect(page.get_by_role("slider", name="K1 across")).to_have_count(1)
    expect(page.get_by_role("textbox", name="K1 across")).to_have_count(1)
    expect(page.get_by_role("img", name="Two robots")).to_have_count(1)
    expect(page.get_by_role("img", name="Distance from the path [mm]")).to_have_count(1)
    expect(page.get_by_role("img", name="Path following")).to_have_count(1)
    assert page.evaluate("[document.title, document.documentElement.lang]") == ["OnPath", "en"]


def test_another_language_comes_without_a_reload_and_leaves_open_what_is_open(tab: Tab) -> None:
    tab.page.evaluate("window.isFirst = true")
    for group in tab.page.locator("#op-panel details[open] > summary").all():
        group.click()
    tab.open("Hand and disturbances")
    tab.more("Language, display")
    tab.page.get_by_role("dialog").get_by_label("Language").select_option("de")
    expect(tab.page.locator("html")).to_have_attribute("lang", "de")
    expect(tab.page.get_by_role("dialog", name="Sprache, Anzeige")).to_be_visible()
    tab.page.keyboard.press("Escape")
    opened = tab.page.locator("#op-panel details[open]")
    expect(opened.locator(".heading")).to_have_text("Hand und Störungen")
    expect(tab.page.get_by_role("img", name="Zwei Roboter")).to_have_count(1)
    expect(tab.page.get_by_role("button", name="Beide festhalten")).to_be_visible()
    expect(tab.page.get_by_role("img", name="Abstand von der Bahn [mm]")).to_be_visible()
    speed = tab.page.locator("#op-panel [data-name=speed] input.typed")
    speed.fill("1")  # half of a number
    before = tab.simulation.parameters.speed
    tab.ask(c.SetLanguage("en"))
    expect(tab.page.locator("html")).to_have_attribute("lang", "en")
    expect(speed).to_be_focused()
    expect(speed).to_have_value("1")
    assert tab.simulation.parameters.speed == before != 1.0
    speed.press("Escape")
    assert tab.page.evaluate("window.isFirst")


def test_what_happens_is_spoken_unless_that_is_switched_off(tab: Tab) -> None:
    spoken = tab.page.locator("#op-voice")
    tab.ask(c.Hold(True))
    expect(spoken).to_contain_text("Held back.")
    tab.more("Language, display")
    tab.page.get_by_role("switch", name="Say what happens").uncheck()
    tab.page.keyboard.press("Escape")
    tab.page.get_by_role("dialog").wait_for(state="hidden")
    tab.ask(c.Hold(False))
    wait_for(lambda: all(run.distance < 1e-3 for run in tab.simulation.runs.values()))
    tab.settle()
    expect(spoken).to_contain_text("Held back.")
    tab.more("Language, display")
    tab.page.get_by_role("switch", name="Say what happens").check()
    expect(spoken).to_contain_text("Both on the path.")
    tab.page.keyboard.press("Escape")
    tab.page.get_by_role("dialog").wait_for(state="hidden")


def test_a_summary_is_told_on_demand(tab: Tab) -> None:
    tab.page.keyboard.press("q")
    told = re.compile(r"Path: circle\. Tracker: \d+\.\d millimetres from the path")
    expect(tab.page.locator("#op-voice")).to_contain_text(told)
    message = tab.page.locator("#op-message")
    expect(message).to_contain_text(told)
    message.get_by_role("button").click()
    expect(message).to_be_hidden()
    tab.page.keyboard.press("q")
    expect(message).to_contain_text(told)
    message.get_by_role("button").click()


def test_a_refusal_is_over_the_scene_moves_nothing_and_is_told_again_when_it_was_closed(
    tab: Tab,
) -> None:
    button, message = tab.button("Hold both back"), tab.page.locator("#op-message")
    expect(button).to_be_visible()
    before, scene = button.bounding_box(), tab._canvas()
    for _ in range(2):
        tab.ask(c.Set("rate", 1000))
        expect(message).to_be_visible()  # its text is there while it is hidden, too
        expect(message).to_contain_text("1000")
        box = message.bounding_box()
        assert box and before == button.bounding_box()
        assert box["x"] >= scene["x"] and box["x"] + box["width"] <= scene["x"] + scene["width"]
        message.get_by_role("button", name="Close").click()
        expect(message).to_be_hidden()


AUDIO = """window.AudioContext = class {
    currentTime = 0
    state = "running"
    constructor() { window.tones = []; window.sides = [] }
    createOscillator() {
        const index = tones.push(0) - 1
        const frequency = { setTargetAtTime: (pitch) => { tones[index] = pitch } }
        return { frequency, connect: (next) => next, start() {} }
    }
    createGain() { return { gain: { setTargetAtTime() {} }, connect: (next) => next } }
    createStereoPanner() {
        return { pan: { set value(side) { sides.push(side) } }, connect: (next) => next }
    }
}"""


def test_the_distances_are_heard_once_that_is_switched_on(
    browser: Browser, server: LabServer
) -> None:
    context = browser.new_context(viewport=WINDOW)
    context.add_init_script(AUDIO)
    tab = Tab(server, context, draws=False)
    tab.settle()
    assert tab.page.evaluate("window.tones === undefined")
    tab.more("Language, display")
    tab.page.get_by_role("switch", name="Distance as sound").check()
    tab.page.keyboard.press("Escape")
    tab.ask(c.Hold(True))
    wait_for(lambda: tab.page.evaluate("window.tones?.[0] > 400"))
    assert tab.page.evaluate("sides") == [-1, 1]
    assert 220 <= tab.page.evaluate("tones[1]") < 250
    tab.page.context.close()


def test_a_share_code_is_copied(tab: Tab) -> None:
    tab.page.context.grant_permissions(["clipboard-read", "clipboard-write"])
    tab.more("Keep and share")
    tab.button("Share this set-up").click()
    code = tab.page.locator("code", has_text=re.compile("^ONPATH"))
    code.locator("xpath=following-sibling::button").click()
    expect(tab.button("Copied")).to_be_visible()
    copied = tab.page.evaluate("navigator.clipboard.readText()")
    assert copied == code.inner_text() == tab.lab.shared
    tab.page.keyboard.press("Escape")


def test_with_reduced_motion_the_robots_are_at_rest_at_first(
    browser: Browser, server: LabServer
) -> None:
    tab = visit(browser, server, reduced_motion="reduce")
    wait_for(lambda: not tab.simulation.running)
    tab.press("Run")
    wait_for(lambda: tab.simulation.running)
    tab.page.context.close()


def test_axe_finds_nothing_serious_in_a_lesson(browser: Browser, server: LabServer) -> None:
    tab = visit(browser, server)
    tab.ask(c.OpenLesson(LESSON))
    tab.page.get_by_role("heading", name="Two robots, one circle").wait_for()
    wait_for(tab.is_built)
    assert violations(tab) == []
    tab.page.context.close()


# The first hold.

WATCH_PANEL = """() => {
    const buttons = [...document.querySelectorAll("button")]
    const button = buttons.find((each) => each.textContent.includes("Hold both back"))
    window.moved = 0
    window.bars = 0
    const top = button.getBoundingClientRect().top
    const look = () => {
        window.moved = Math.max(window.moved, Math.abs(button.getBoundingClientRect().top - top))
        for (const each of document.querySelectorAll("progress"))
            window.bars += each.checkVisibility()
        requestAnimationFrame(look)
    }
    look()
}"""


def test_the_first_hold_moves_nothing_in_the_panel(browser: Browser) -> None:
    """Its loop is compiled meanwhile."""
    server = LabServer("127.0.0.1", 0, LoopCache())
    tab = visit(browser, server)
    tab.page.evaluate(WATCH_PANEL)
    tab.button("Hold both back").click()
    wait_for(lambda: len(tab.simulation.forces.held) == 2)
    time = tab.simulation.time
    wait_for(lambda: tab.simulation.time > time + 1)
    tab.settle()
    assert tab.page.evaluate("[moved, bars]") == [0, 0]
    tab.page.context.close()
    server.stop()
