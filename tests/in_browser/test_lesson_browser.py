"""A student's work on lesson 1, with a real mouse and a reload in the middle."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace

import pytest

pytest.importorskip("playwright")

from playwright.sync_api import Browser, expect

from onpath.app.common.newcomer import NEWCOMER
from onpath.app.lab import commands as c
from onpath.app.server.lab_server import LabServer
from tests.support.browser import Tab, wait_for

pytestmark = pytest.mark.thorough

LESSON = "01-path-or-timetable"


@pytest.fixture(scope="module")
def tab(browser: Browser, server: LabServer) -> Iterator[Tab]:
    """A tab in which lesson 1 has been opened from the overview."""
    context = browser.new_context(viewport={"width": 1280, "height": 800})
    tab = Tab(server, context, draws=False)
    tab.press("Lessons")
    tab.card("1. Path or timetable?").click()
    wait_for_heading(tab, "Two robots, one circle")
    yield tab
    assert tab.errors == []
    context.close()


def wait_for_heading(tab: Tab, title: str) -> None:
    """Wait until a step is open."""
    tab.page.get_by_role("heading", name=title).wait_for()


def board(tab: Tab, *places: tuple[float, float]) -> list[tuple[float, float]]:
    """Convert fractions of the board's width and height to positions in the window."""
    box = tab.page.locator(".board").bounding_box()
    assert box is not None
    return [(box["x"] + x * box["width"], box["y"] + y * box["height"]) for x, y in places]


def curves(tab: Tab) -> list[str]:
    """What the table of the chart with the prediction lists, besides the times."""
    chart = tab.page.locator(".compared .strip").first
    chart.wait_for()
    if chart.locator("details.table[open]").count() == 0:
        chart.locator("summary").click()
    chart.locator("th").last.wait_for()
    return [name.split(" [")[0] for name in chart.locator("th").all_inner_texts()[1:-1]]


def test_only_the_controls_of_the_step_are_shown(tab: Tab) -> None:
    run = tab.lab.lessons
    assert run.lesson is not None and run.lesson.name == LESSON
    assert tab.page.get_by_text("K1 across").filter(visible=True).count() == 0
    assert tab.button("Hold both back").is_visible() and tab.button("Next").is_visible()


def test_a_prediction_is_sketched_before_anything_happens(tab: Tab) -> None:
    tab.press("Next")
    wait_for_heading(tab, "Draw what the tracker does")
    commit = tab.button("Commit to this prediction")
    for seen in (commit, tab.page.locator(".board"), tab.page.get_by_text("over these 8 seconds")):
        expect(seen).to_be_in_viewport(ratio=1)
    expect(commit).to_be_disabled()
    tab.wait_until_built()
    tab.page.keyboard.press("Space")
    wait_for(lambda: "commit" in tab.lab.message)
    assert not tab.simulation.running and tab.simulation.time == 0.0
    way = board(tab, (0.1, 0.8), (0.35, 0.8), (0.45, 0.3), (0.6, 0.3), (0.7, 0.8))
    with tab.dragging(*way, in_scene=False):
        pass
    commit.click()
    expect(tab.button("Next")).to_be_in_viewport()
    tab.page.get_by_text("You have committed to your prediction").wait_for()
    assert tab.page.locator(".plot.drawn").count() == 0  # it cannot be drawn again
    answer = wait_for(tab.lab.lessons.answer)
    assert len(answer.times) > 4 and 0 < min(answer.times) < 3 < 5 < max(answer.times)
    assert max(answer.values) > 1.3 * answer.values[0] and max(answer.values) > answer.values[-1]


def test_the_result_is_plotted_on_the_same_axes(tab: Tab) -> None:
    tab.press("Next")
    wait_for_heading(tab, "Held from 3 s to 5 s")
    expect(tab.page.locator(".compared canvas").first).to_be_visible()
    expect(tab.page.get_by_text("are not kept")).to_be_hidden()  # there has been no run yet
    tab.press("Let it happen")
    wait_for(lambda: tab.lab.lessons.playing)
    assert tab.page.get_by_text("Four arches").is_hidden()  # not told before it has happened
    tab.ask(c.Set("rate", 4.0))
    wait_for(lambda: tab.lab.lessons.has_played())
    tab.page.get_by_text("Four arches, not one bump").wait_for()
    truth = tab.lab.lessons.notes.truths["1"]
    assert max(truth.tracker) > 40 > 3 > max(truth.follower)
    assert curves(tab) == ["Tracker", "Follower", "Your prediction"]


def test_a_reload_in_the_middle_comes_back_to_the_step(tab: Tab) -> None:
    before = tab.lab.lessons.progress
    tab.reload()
    wait_for_heading(tab, "Held from 3 s to 5 s")
    tab.page.get_by_text("Four arches, not one bump").wait_for()
    assert tab.lab.lessons.progress == before


def test_a_task_is_failed_then_passed(tab: Tab) -> None:
    for step in range(tab.lab.lessons.index + 1, tab.lab.lessons.index + 5):
        tab.page.keyboard.press("PageDown")
        wait_for(lambda step=step: tab.lab.lessons.index == step)
    wait_for_heading(tab, "Hold it yourself")
    expect(tab.page.locator(".step.open .words")).to_be_focused()
    tab.ask(c.Set("rate", 2.0), c.Set("K1", 40), c.Set("K2", 12))
    tab.ask(c.SetRunning(False), c.Reset())  # how far it gives way depends on where it is held
    hold_for(tab, 2.6)
    tab.page.get_by_text("wanted: below 3 mm (2.0 of 2 s)").first.wait_for()
    assert "hold-two-seconds" not in tab.lab.lessons.notes.tasks
    tab.page.get_by_role("button", name="Hint (3 left)").first.click()
    tab.page.get_by_text("Which of the gains is the spring").wait_for()
    tab.enter("K1", "600")
    tab.enter("K2", "50")
    wait_for(lambda: (tab.simulation.parameters.K1, tab.simulation.parameters.K2) == (600, 50))
    again = tab.simulation.time + 3.0
    wait_for(lambda: tab.simulation.time > again)
    hold_for(tab, 2.6)
    wait_for(lambda: "hold-two-seconds" in tab.lab.lessons.notes.tasks)
    tab.page.get_by_text("✓ Passed").first.wait_for()
    reason = tab.page.locator(".step.open").get_by_text("the distance is the nudge divided by K1")
    expect(reason).to_be_hidden()  # before one has been asked
    tab.page.locator(".step.open").get_by_text("Why did this work?").click()
    expect(reason).to_be_visible()


def hold_for(tab: Tab, seconds: float) -> None:
    """Hold both robots back by the button, for some simulated seconds."""
    tab.button("Hold both back").first.click()
    wait_for(lambda: tab.simulation.forces.held)
    tab.ask(c.SetRunning(True))
    begin = tab.simulation.time
    wait_for(lambda: tab.simulation.time > begin + seconds)
    tab.button("Let both go").first.click()
    wait_for(lambda: not tab.simulation.forces.held)


def test_finish_shows_own_curves_what_to_take_away_and_the_next_lesson(tab: Tab) -> None:
    while not tab.lab.lessons.ended:
        before = tab.lab.lessons.version
        tab.page.keyboard.press("PageDown")
        wait_for(lambda before=before: tab.lab.lessons.version != before)
    wait_for_heading(tab, "What you predicted, and what happened")
    expect(tab.page.get_by_text("What to take away")).to_be_in_viewport()
    expect(tab.page.locator("[data-chart] canvas")).to_have_count(1)
    tab.page.get_by_text("1 of 1 curve drawn").wait_for()
    tab.reload()
    wait_for_heading(tab, "What you predicted, and what happened")
    assert tab.button("Open lesson 1b: Let the clock wait").is_visible()
    tab.press("Back")
    wait_for_heading(tab, "Your name, written twice")


def test_the_free_lab_is_unchanged(tab: Tab) -> None:
    tab.page.get_by_role("button", name="Leave the lesson").click()
    tab.page.get_by_role("heading", name="Your name, written twice").wait_for(state="detached")
    wait_for(lambda: tab.lab.lessons.lesson is None)
    usual = tab.simulation.entry.parameters()
    wait_for(lambda: tab.simulation.parameters == replace(usual, **NEWCOMER))
    tab.press("Lessons")
    card = tab.card("1. Path or timetable?")
    expect(card).to_contain_text("begun")
    expect(card).to_contain_text(re.compile(r"\d+ %"))
    tab.page.keyboard.press("Escape")
