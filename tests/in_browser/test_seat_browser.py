"""A student's place in a class, by the card of the page."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import pytest

pytest.importorskip("playwright")

from playwright.sync_api import Browser, Locator

from onpath.app.classroom.classroom import Classroom
from onpath.app.common.access_codes import shown
from onpath.app.lab import commands as c
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.server.lab_server import LabServer
from onpath.app.server.server_options import ServerOptions
from onpath.app.viser_adapter.addresses import class_address
from tests.support.browser import Tab, wait_for

pytestmark = pytest.mark.thorough

LESSON = "01-path-or-timetable"
HOSTILE = "<img src=x>"
NOTICE = "https://school.example/privacy"


@dataclass
class Seat:
    """A student's tab at the address of a class."""

    tab: Tab
    room: Classroom

    @property
    def card(self) -> Locator:
        return self.tab.page.get_by_role("dialog", name=f"Class {self.room.code.upper()}")

    @property
    def nickname(self) -> Locator:
        return self.card.get_by_role("textbox", name="Nickname")

    def join(self, name: str) -> None:
        self.nickname.fill(name)
        self.card.get_by_role("button", name="Join the class").click()
        self.card.wait_for(state="detached")

    def in_head(self, name: str) -> Locator:
        """The button that says who one is."""
        label = f"{name} · class {self.room.code.upper()}"
        return self.tab.page.get_by_role("button", name=label, exact=True)


@pytest.fixture(scope="module")
def seat(browser: Browser) -> Iterator[Seat]:
    room = Classroom()
    options = ServerOptions(classrooms=[room], privacy_url=NOTICE)
    server = LabServer("127.0.0.1", 0, LoopCache(), options)
    context = browser.new_context(viewport={"width": 1280, "height": 800})
    tab = Tab(server, context, draws=False, path=class_address(room.code))
    tab.ask(c.SetRunning(False))
    yield Seat(tab, room)
    assert tab.errors == []
    context.close()
    server.stop()


def test_a_class_is_joined_with_a_nickname(seat: Seat) -> None:
    page = seat.tab.page
    wait_for(lambda: seat.nickname.evaluate("each => each === document.activeElement"))
    page.keyboard.press("Enter")
    seat.card.get_by_role("alert").filter(has_text="at least one character").wait_for()
    seat.card.get_by_text("What is stored of you?").click()
    assert seat.card.get_by_role("link", name="Privacy notice").get_attribute("href") == NOTICE
    assert seat.card.get_by_text("Your teacher sees all of it").is_visible()
    seat.nickname.fill("Mi")
    seat.tab.reload()
    wait_for(lambda: seat.nickname.input_value() == "Mi")
    seat.join(HOSTILE)
    head = seat.in_head(HOSTILE)
    wait_for(lambda: head.evaluate("each => each === document.activeElement"))
    assert page.locator("img[src=x]").count() == 0
    assert [member.name for member in seat.room.members().values()] == [HOSTILE]
    seat.tab.reload()
    head.wait_for()
    assert seat.card.count() == 0


def test_what_the_teacher_does_arrives(seat: Seat) -> None:
    page, panel = seat.tab.page, seat.tab.page.locator("#op-panel .body")
    seat.room.freeze(True)
    page.locator("#op-panel").get_by_text("look to the front").wait_for()
    assert panel.evaluate("each => each.inert")
    seat.room.freeze(False)
    wait_for(lambda: not panel.evaluate("each => each.inert"))
    seat.room.push(c.TakeStep(LESSON, 1))
    page.get_by_role("heading", name="Draw what the tracker does").wait_for()
    seat.tab.ask(c.CloseLesson())
    seat.room.push(None)


def test_who_is_no_member_any_more_is_told_and_goes_on(seat: Seat) -> None:
    lab = seat.tab.lab
    seat.room.freeze(True)
    wait_for(lambda: lab.frozen)
    seat.room.end()
    seat.card.get_by_text("This lab is in no class now").wait_for()
    wait_for(lambda: not lab.frozen)
    seat.join("Ada")
    seat.in_head("Ada").click()
    seat.card.get_by_role("button", name="Leave the class").click()
    seat.card.wait_for(state="detached")
    seat.tab.page.get_by_role("button", name="Join the class").wait_for()
    assert not seat.room.members() and seat.tab.lab is lab


def test_a_teacher_opens_the_teachers_page_with_the_key(seat: Seat) -> None:
    page = seat.tab.page
    seat.tab.more("Language, display")
    page.get_by_role("button", name="Teacher…").click()
    sheet = page.get_by_role("dialog", name="Open the teacher's page")
    key = sheet.get_by_label("Teacher's key")
    key.fill("2222-2222-2222")
    key.press("Enter")
    sheet.get_by_role("alert").filter(has_text="not the teacher's key").wait_for()
    key.fill(shown(seat.room.key))
    key.press("Enter")
    sheet.wait_for(state="detached")
    (visit,) = seat.tab.server.visits
    wait_for(lambda: seat.room.is_pass(visit.kept.get("teacher")))
    assert seat.card.count() == page.get_by_role("button", name="Join the class").count() == 0
