"""Lesson 1 from the first page to its end by a keyboard alone, and where the focus is meanwhile."""

from __future__ import annotations

import pytest

pytest.importorskip("playwright")

from playwright.sync_api import Browser, expect

from onpath.app.server.lab_server import LabServer
from tests.support.browser import WAIT, Tab, wait_for
from tests.support.keyboard import Keyboard

pytestmark = pytest.mark.thorough

expect.set_options(timeout=WAIT * 1e3)


class Pupil(Keyboard):
    """Does lesson 1 by keys."""

    def __init__(self, tab: Tab) -> None:
        super().__init__(tab)
        self.tab = tab

    def arrive(self, index: int) -> None:
        """Return when a step is open."""
        run = self.tab.lab.lessons
        wait_for(lambda: run.lesson is not None and run.index == index)
        assert run.lesson is not None
        title = run.lesson.steps[index].title
        self.tab.page.get_by_role("heading", name=title, exact=True).wait_for()
        self.tab.wait_until_built()
        self.tab.page.emulate_media(color_scheme="dark" if index % 2 else "light")

    def sketch(self, *keys: str) -> None:
        """Draw the beginning of a curve with the sliders on the chart, one key for each."""
        self.reach(self.tab.page.get_by_role("slider", name="at ").first)
        for key in keys:
            self.press(key)
            self.press("ArrowRight")

    def choose(self, place: int, question: int = 0) -> None:
        """Choose an option of a question."""
        options = self.tab.page.locator("[data-block] [role=radiogroup]").nth(question)
        self.reach(options.get_by_role("radio").first)
        self.press("Space")
        self.press("ArrowDown", times=place)
        expect(options.get_by_role("radio").nth(place)).to_be_checked()

    def enter(self, label: str, value: str) -> None:
        """Type a number, and leave its box."""
        box = self.tab.number(label)
        self.reach(box)
        self.press("Control+A")
        self.tab.page.keyboard.type(value)
        self.press("Tab")
        expect(box).to_have_value(value)

    def see_it_happen(self) -> None:
        """Run the experiment of a step, and wait for its end."""
        run = self.tab.lab.lessons
        wait_for(run.has_played)

    def wait(self, seconds: float) -> None:
        """Wait while simulated time passes."""
        until = self.tab.simulation.time + seconds
        wait_for(lambda: self.tab.simulation.time > until)

    def passes(self, task: str) -> None:
        """Return when a task is passed."""
        wait_for(lambda: task in self.tab.lab.lessons.notes.tasks)


def test_lesson_1_is_done_by_keys_alone(browser: Browser, server: LabServer) -> None:
    """Every other step is dark."""
    context = browser.new_context(viewport={"width": 1280, "height": 800})
    tab = Tab(server, context, draws=False)
    pupil = Pupil(tab)
    lessons = tab.lab.lessons

    pupil.act("Lessons")
    pupil.reach(tab.card("1. Path or timetable?"))
    pupil.press("Enter")
    pupil.arrive(0)
    pupil.press("h")
    wait_for(lambda: len(tab.simulation.forces.held) == 2)
    pupil.press("h")
    pupil.act("Next")

    pupil.arrive(1)
    pupil.sketch(
        "ArrowUp", "ArrowUp", "ArrowUp", "End", "End", "End", "PageUp", "ArrowUp", "ArrowUp"
    )
    pupil.reach(tab.page.get_by_label("How sure are you? (optional)"))
    pupil.press("ArrowDown")
    pupil.press("ArrowDown")
    pupil.act("Commit to this prediction")
    pupil.act("Next")
    pupil.arrive(2)
    pupil.act("Let it happen")
    pupil.see_it_happen()
    pupil.act("Next")
    pupil.arrive(3)
    pupil.reach(tab.page.locator("summary").filter(has_text="In the literature"))
    pupil.press("Space")
    tab.page.get_by_text("computed torque").wait_for()
    pupil.act("Next")

    pupil.arrive(4)
    pupil.choose(2)
    pupil.act("Commit to this prediction")
    pupil.act("Next")
    pupil.arrive(5)
    pupil.act("Let it happen")
    pupil.see_it_happen()
    pupil.act("Next")

    pupil.arrive(6)
    pupil.enter("K1", "600")
    pupil.enter("K2", "50")
    pupil.press("h")
    pupil.wait(3.0)
    pupil.press("h")
    pupil.passes("hold-two-seconds")
    pupil.act("Next")

    pupil.arrive(7)
    pupil.choose(1)
    pupil.act("Commit to this prediction")
    pupil.act("Next")
    pupil.arrive(8)
    pupil.act("Let it happen")
    pupil.see_it_happen()
    pupil.act("Next")

    pupil.arrive(9)
    pupil.press("d", times=6)
    pupil.wait(1.0)
    pupil.press("x")
    pupil.passes("push-across")
    for question in (0, 1):
        pupil.choose(0, question)
        asked = tab.page.locator(".quiz[data-block]").nth(question)
        pupil.reach(asked.get_by_role("button", name="Check", exact=True))
        pupil.press("Enter")
        wait_for(lambda question=question: len(lessons.notes.quiz) == question + 1)
    pupil.act("Skip the optional steps and finish")
    wait_for(lambda: lessons.ended)
    tab.page.get_by_role("heading", name="What you predicted, and what happened").wait_for()
    assert pupil.unseen == {}
    assert tab.errors == []
    context.close()
