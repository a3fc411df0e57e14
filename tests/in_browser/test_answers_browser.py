"""Answers in a real browser: to choose from, beside a prediction, a number and a text."""

from __future__ import annotations

import re

import pytest

pytest.importorskip("playwright")

from playwright.sync_api import Browser, expect

from onpath.app.lab import commands as c
from onpath.app.server.lab_server import LabServer
from onpath.lessons.given import Answer
from tests.support.browser import Tab, wait_for

pytestmark = pytest.mark.thorough

TIMETABLE = "01-path-or-timetable"
CANVASES = """
window.canvases = []
const make = Document.prototype.createElement
Document.prototype.createElement = function (name, ...more) {
    const made = make.call(this, name, ...more)
    if (name === "canvas") canvases.push(new WeakRef(made))
    return made
}
"""  # remembers all that a page makes, without keeping them
WAITS, POLES = "01b-let-the-clock-wait", "04b-poles-and-gains"


def test_answers_are_pressed_by_mouse_finger_and_keys(browser: Browser, server: LabServer) -> None:
    context = browser.new_context(viewport={"width": 1280, "height": 1000}, has_touch=True)
    tab = Tab(server, context, draws=False)
    tab.ask(c.TakeStep(TIMETABLE, 4))
    options = {
        letter: tab.page.get_by_role("radio", name=re.compile(f"^{letter} .{{5}}"))
        for letter in "ABC"
    }
    acts = {
        "A": options["A"].click,
        "B": options["B"].tap,
        "C": lambda: (tab.focus(options["C"]), tab.page.keyboard.press("Space")),
    }
    commit = tab.button("Commit to this prediction")
    tab.wait_until_built()
    expect(commit).to_be_disabled()
    for letter, act in acts.items():
        act()
        expect(commit).to_be_enabled()
        for each, option in options.items():
            expect(option).to_be_checked(checked=each == letter)
        box = options[letter].locator("xpath=ancestor::label").bounding_box()
        assert box is not None and box["height"] >= 34.0
    assert tab.simulation.time == 0  # Space on an answer is not the lab's
    commit.click()
    tab.button("Next").wait_for()
    answer = tab.lab.lessons.answer()
    assert answer is not None and answer.option is not None
    assert tab.errors == []
    context.close()


def test_a_committed_choice_is_locked_and_judged_when_its_run_is_over(
    browser: Browser, server: LabServer
) -> None:
    context = browser.new_context(viewport={"width": 1280, "height": 800})
    tab = Tab(server, context, draws=False)
    page = tab.page
    tab.ask(c.TakeStep(TIMETABLE, 4))
    wrong = page.get_by_role("radio", name=re.compile("A few millimetres"))
    wrong.click()
    text, card = page.get_by_text("We make the spring"), page.locator(".step.open .asked")
    expect(page.get_by_label("Why?")).to_be_in_viewport(ratio=0.95)
    above, below = text.bounding_box(), card.bounding_box()
    assert above is not None and below is not None
    assert above["y"] + above["height"] <= below["y"]  # it does not hide what it asks about
    tab.button("Commit to this prediction").click()
    page.get_by_text("You have committed to your prediction").wait_for()
    expect(wrong).to_be_checked()
    for option in card.get_by_role("radio").all():
        expect(option).to_be_disabled()
    assert page.get_by_label("Why?").is_hidden()
    tab.press("Next")
    tab.press("Let it happen")
    wait_for(lambda: tab.lab.lessons.playing)
    tab.ask(c.Set("rate", 4.0))
    wait_for(lambda: tab.lab.lessons.has_played())
    for told in (page.locator(".compared"), page.locator("#op-column > .step + [role=status]")):
        expect(told).to_contain_text("Not quite.")
        expect(told).to_contain_text("A few millimetres")
        expect(told).not_to_contain_text("As far as before")
    second = page.locator("[data-second]")
    second.get_by_role("textbox").fill("30")
    second.get_by_role("button", name="Check").click()
    for told in ("Right.", "It runs through the centre", "As far as before"):
        expect(second).to_contain_text(told)
    event = tab.lab.lessons.notes.given[-1]
    assert (event.item[-7:], event.attempt, event.right) == (".second", 2, True)
    assert tab.errors == []
    context.close()


def test_how_sure_why_a_number_and_a_text_are_typed_and_kept(
    browser: Browser, server: LabServer
) -> None:
    context = browser.new_context(viewport={"width": 1280, "height": 1000})
    tab = Tab(server, context, draws=False)
    run, page = tab.lab.lessons, tab.page
    tab.ask(c.TakeStep(WAITS, 5))
    page.get_by_role("heading", name="Nobody touches them").wait_for()
    page.get_by_role("radio", name=re.compile("^A ")).click()
    page.get_by_label("How sure").select_option(label="certain")
    page.get_by_label("Why?").select_option(index=1)
    tab.button("Commit to this prediction").click()
    wait_for(lambda: "5" in run.notes.answers)
    answer = run.notes.answers["5"]
    assert (answer.sure, answer.reason) == ("certain", 0) and answer != Answer()
    page.get_by_text("You were: certain").wait_for()
    tab.ask(c.TakeStep(POLES, 3))
    tab.wait_until_built()
    number = page.get_by_label("Your number [1/s]")
    number.fill("no number")
    tab.press("Check")
    page.get_by_text("this is not a number").wait_for()
    number.fill("60.25")
    number.press("Enter")
    wait_for(lambda: list(run.notes.numbers.values()) == [60.25])
    page.get_by_text("Both poles are then at −30 per second").wait_for()
    tab.ask(c.TakeStep(WAITS, 8))
    field = page.get_by_label("Your answer, in your own words")
    field.fill("It waits. <b>So</b> what?")
    field.press("Enter")  # a new line, like anywhere
    field.press("Backspace")
    tab.ask(c.ShowHint("throw-it-off"))  # renews what has changed, and nothing else
    page.get_by_text("Which jump would be larger?", exact=False).first.wait_for()
    expect(field).to_have_value("It waits. <b>So</b> what?")
    tab.press("Keep my answer")
    wait_for(lambda: list(run.notes.written.values()) == ["It waits. <b>So</b> what?"])
    expect(field).to_have_value("It waits. <b>So</b> what?")
    assert tab.errors == []
    context.close()


def test_the_board_stays_through_a_commit_and_can_be_drawn_on_when_asked_again(
    browser: Browser, server: LabServer
) -> None:
    context = browser.new_context(viewport={"width": 1280, "height": 800})
    tab = Tab(server, context, draws=False)
    page, board = tab.page, tab.page.locator(".board")
    tab.ask(c.TakeStep(TIMETABLE, 1))
    tab.wait_until_built()
    _draw(tab)
    page.get_by_label("How sure").select_option(label="certain")
    tab.button("Commit to this prediction").click()
    page.get_by_text("You were: certain").wait_for()
    expect(board).to_be_visible()
    tab.ask(c.TakeStep(TIMETABLE, 1, again=True))
    page.get_by_text("Find somebody who drew another one").wait_for()
    _draw(tab)
    tab.button("Commit to this prediction").click()
    answer = wait_for(tab.lab.lessons.answer)
    assert len(answer.times) > 4
    assert tab.errors == []
    context.close()


def test_boards_that_are_replaced_are_forgotten(browser: Browser, server: LabServer) -> None:
    context = browser.new_context(viewport={"width": 1280, "height": 800})
    context.add_init_script(CANVASES)
    tab = Tab(server, context, draws=False)
    tab.ask(c.TakeStep(TIMETABLE, 1))
    tab.wait_until_built()
    before = _canvases(tab)
    for _ in range(4):
        tab.ask(c.Predict(times=(0.0, 8.0), values=(0.0, 40.0), sure="certain"))
        tab.page.get_by_text("You were: certain").wait_for()
        tab.ask(c.TakeStep(TIMETABLE, 1, again=True))
        tab.page.get_by_text("Find somebody who drew another one").wait_for()
    wait_for(lambda: _canvases(tab) <= before + 1)
    context.close()


def _canvases(tab: Tab) -> int:
    """Number of canvases that the page keeps in memory; collects its garbage."""
    devtools = tab.page.context.new_cdp_session(tab.page)
    devtools.send("HeapProfiler.collectGarbage")
    devtools.detach()
    return tab.page.evaluate("canvases.filter(each => each.deref()).length")


def _draw(tab: Tab) -> None:
    """Draw a curve on the board."""
    box = tab.page.locator(".board").bounding_box()
    assert box is not None
    way = [
        (box["x"] + x * box["width"], box["y"] + y * box["height"])
        for x, y in ((0.1, 0.8), (0.4, 0.3), (0.7, 0.8))
    ]
    with tab.dragging(*way, in_scene=False):
        pass
