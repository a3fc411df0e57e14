"""Lesson 1 of the static site, done whole by mouse or by keys alone, as its texts say."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tests.support.site_reader import WAIT, SiteReader
from tests.support.waiting import wait_for

if TYPE_CHECKING:
    from playwright.sync_api import Locator

END = "A timetable says where the end-point must be"


def lesson_one_by_mouse(reader: SiteReader) -> None:
    """Every step."""
    page = reader.page
    reader.ready()
    reader.press("Hold both back")
    wait_for(lambda: "torn off" in page.locator(".step.open .stage").inner_text(), WAIT)
    reader.press("Next")
    assert reader.step() == "Draw what the tracker does"
    x, y = reader.place(page.locator(".step.open canvas.board"))
    page.mouse.move(x + 60, y + 200)
    page.mouse.down()
    page.mouse.move(x + 210, y + 80, steps=12)
    page.mouse.move(x + 360, y + 200, steps=12)
    page.mouse.up()
    reader.press("Commit to this prediction")
    reader.press("Next")
    reader.ready()
    assert not page.get_by_text("Four arches, not one bump").is_visible()
    reader.press("Let it happen")
    reader.played(8.5)
    assert page.get_by_text("Four arches, not one bump").is_visible()
    assert page.locator(".step.open .compared canvas").is_visible()
    reader.press("Next")
    reader.press("Next")
    page.get_by_role("radio", name="As far as before").check()
    reader.press("Commit to this prediction")
    reader.press("Next")
    reader.ready()
    reader.press("Let it happen")
    reader.played(8.5)
    assert page.locator(".step.open .compared").get_by_text("Yes: nearly 50 mm.").is_visible()
    assert "Yes: nearly 50 mm." in page.locator("#live").inner_text()
    reader.press("Next")
    reader.ready()
    reader.enter("K1", 600)
    reader.enter("K2", 50)
    reader.advance(1)
    reader.press("Hold both back")
    reader.advance(2.6)
    wait_for(reader.passed, WAIT)
    reader.press("Next")
    page.get_by_role("radio", name="Hardly at all").check()
    reader.press("Commit to this prediction")
    reader.press("Next")
    reader.ready()
    reader.press("Let it happen")
    reader.played(9.5)
    assert page.locator(".step.open .wrong").first.inner_text() == "Not quite."
    reader.press("Next")
    reader.ready()
    _pull_and_let_go(reader)
    for question, option in _questions(reader):
        question.get_by_role("radio", name=option).check()
        question.get_by_role("button", name="Check").click()
    _answered_right(reader)
    reader.press("Next")
    reader.press("Next")
    reader.press("Finish")
    assert "12" in page.locator("#counts").inner_text() and page.get_by_text(END).is_visible()


def lesson_one_by_keys(reader: SiteReader) -> None:
    """Every step; pages are turned with PageDown."""
    page = reader.page
    keys = page.keyboard
    reader.ready()
    keys.press("h")
    wait_for(lambda: "torn off" in page.locator(".step.open .stage").inner_text(), WAIT)
    keys.press("PageDown")
    start = page.get_by_role("slider", name="Your prediction at 0 s")
    reader.focus(start)
    for _ in range(13):
        keys.press("ArrowRight")
    for _ in range(4):
        keys.press("PageUp")
        keys.press("PageUp")
        keys.press("ArrowRight")
        keys.press("ArrowRight")
    told = ("0 mm", "10 mm", "0 mm", "10 mm", "0 mm", "10 mm", "0 mm", "10 mm", "0 mm")
    for time, value in zip((3, 3.25, 3.5, 3.75, 4, 4.25, 4.5, 4.75, 5), told, strict=True):
        point = page.get_by_role("slider", name=f"Your prediction at {time:g} s", exact=True)
        assert point.get_attribute("aria-valuetext") == value
    assert page.locator(".step.open .point[tabindex='0']").count() == 1  # one stop of Tab
    reader.focus(reader.button("Commit to this prediction"))
    keys.press("Enter")
    keys.press("PageDown")
    reader.ready()
    _let_it_happen(reader, 8.5)
    assert page.get_by_text("Four arches, not one bump").is_visible()
    keys.press("PageDown")
    keys.press("PageDown")
    _choose(reader, "As far as before")
    _let_it_happen(reader, 8.5)
    keys.press("PageDown")
    reader.ready()
    for name, value in (("K1", 600), ("K2", 50)):
        reader.focus(reader.box(name))
        keys.type(str(value))
        keys.press("Enter")
    reader.advance(1)
    reader.focus(reader.button("Hold both back"))
    keys.press("Enter")
    reader.advance(2.6)
    wait_for(reader.passed, WAIT)
    keys.press("PageDown")
    _choose(reader, "Hardly at all")
    _let_it_happen(reader, 9.5)
    keys.press("PageDown")
    reader.ready()
    _pull_and_let_go(reader)
    for question, option in _questions(reader):
        _mark(reader, question, option)
        assert question.locator(".verdict").inner_text() == ""  # arrows answer nothing
        reader.focus(question.get_by_role("button", name="Check"))
        keys.press("Enter")
    _answered_right(reader)
    keys.press("PageDown")
    keys.press("PageDown")
    keys.press("PageDown")
    assert page.get_by_text(END).is_visible()


def _pull_and_let_go(reader: SiteReader) -> None:
    """The last task, which is for keys anyway."""
    for _ in range(6):
        reader.page.keyboard.press("d")
    reader.advance(1)
    reader.page.keyboard.press("x")
    reader.advance(2)
    wait_for(reader.passed, WAIT)


def _questions(reader: SiteReader) -> list[tuple[Locator, str]]:
    """The questions of the quiz, and the right answers."""
    found = reader.page.locator(".step.open .quiz[data-block]").all()
    return list(zip(found, ("There is no time in", "Putting chocolates"), strict=True))


def _answered_right(reader: SiteReader) -> None:
    right = reader.page.locator(".step.open .quiz .right").filter(has_text="Right.")
    assert right.count() == 2


def _mark(reader: SiteReader, place: Locator, option: str) -> None:
    """Mark an option; radio buttons are one stop of Tab."""
    wanted = place.get_by_role("radio", name=option)
    reader.focus(place.locator("input[type=radio]").first)
    reader.page.keyboard.press(" ")
    while not wanted.is_checked():
        reader.page.keyboard.press("ArrowDown")


def _choose(reader: SiteReader, option: str) -> None:
    """Commit to an option, and turn the page."""
    keys = reader.page.keyboard
    _mark(reader, reader.page.locator(".step.open"), option)
    reader.focus(reader.button("Commit to this prediction"))
    keys.press("Enter")
    keys.press("PageDown")
    reader.ready()


def _let_it_happen(reader: SiteReader, seconds: float) -> None:
    reader.focus(reader.button("Let it happen"))
    reader.page.keyboard.press("Enter")
    reader.played(seconds)
