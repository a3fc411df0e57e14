"""Answers in a real browser: to choose from, beside a prediction, a number and a text."""

from __future__ import annotations

import re

import pytest

pytest.importorskip("playwright")

from playwright.sync_api import Browser, expect

from onpath.app.lab import commands as c
from onpath.app.server.lab_server import LabServer
from onpath.lessons.progress import Answer
from tests.support.browser import Tab, wait_for

pytestmark = pytest.mark.thorough

TIMETABLE = "01-path-or-timetable"
WAITS, POLES = "01b-let-the-clock-wait", "04b-poles-and-gains"
LEAST = 44.0  # [px], height of what a finger presses


def test_answers_are_pressed_by_mouse_finger_and_keys(browser: Browser, server: LabServer) -> None:
    context = browser.new_context(viewport={"width": 1280, "height": 1000}, has_touch=True)
    tab = Tab(server, context, draws=False)
    tab.ask(c.TakeStep(TIMETABLE, 4))
    options = {
        letter: tab.page.get_by_role("button", name=re.compile(f"^{letter} .{{5}}"))
        for letter in "ABC"
    }
    acts = {
        "A": options["A"].click,
        "B": options["B"].tap,
        "C": lambda: (tab.focus(options["C"]), tab.page.keyboard.press("Space")),
    }
    for letter, act in acts.items():
        options[letter].wait_for()
        tab.wait_until_built()
        act()
        tab.button(f"Commit to this prediction: {letter}").wait_for()
        for each, option in options.items():
            expect(option).to_have_attribute("aria-pressed", str(each == letter).lower())
        box = options[letter].bounding_box()
        assert box is not None and box["height"] >= LEAST
        expect(tab.button(letter)).to_be_hidden()  # the letter alone
    assert tab.session.time == 0  # Space on an answer is not the lab's
    assert tab.errors == []
    context.close()


def test_how_sure_why_a_number_and_a_text_are_typed_and_kept(
    browser: Browser, server: LabServer
) -> None:
    context = browser.new_context(viewport={"width": 1280, "height": 1000})
    tab = Tab(server, context, draws=False)
    run = tab.lab.lessons
    tab.ask(c.TakeStep(WAITS, 5))
    tab.page.get_by_role("heading", name="Nobody touches them").wait_for()
    tab.page.get_by_role("button", name=re.compile("^A ")).click()
    for label, option in (("How sure", "certain"), ("Why?", "Only a point that jumps")):
        tab.page.get_by_label(label).first.click()
        tab.page.get_by_role("option", name=option).click()
    tab.press("Commit to this prediction: A")
    wait_for(lambda: "5" in run.notes.answers)
    answer = run.notes.answers["5"]
    assert (answer.sure, answer.reason) == ("certain", 0) and answer != Answer()
    tab.page.get_by_text("You were: certain").wait_for()
    tab.ask(c.TakeStep(POLES, 3))
    tab.wait_until_built()
    tab.number("Your number [1/s]").click()
    tab.page.keyboard.press("Control+A")
    tab.page.keyboard.type("60.25")
    tab.press("Check")
    wait_for(lambda: list(run.notes.numbers.values()) == [60.25])
    tab.page.get_by_text("Both poles are then at −30 per second").wait_for()
    tab.ask(c.TakeStep(WAITS, 8))
    tab.page.get_by_label("Your answer, in your own words").fill("It waits. <b>So</b> what?")
    tab.answer()  # the lab has heard it
    tab.ask(c.ShowHint("throw-it-off"))  # builds the page anew
    tab.page.get_by_text("Which jump would be larger?", exact=False).first.wait_for()
    tab.press("Keep my answer")
    wait_for(lambda: list(run.notes.written.values()) == ["It waits. <b>So</b> what?"])
    tab.page.get_by_text("A model answer").wait_for()
    assert tab.errors == []
    context.close()
