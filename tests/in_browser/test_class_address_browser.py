"""A class at its own address, and the way to it from another page, in a real browser."""

from __future__ import annotations

import re
from collections.abc import Iterator

import pytest

pytest.importorskip("playwright")

from playwright.sync_api import Browser

from onpath.app.classroom.class_opening import open_classes
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.server.lab_server import LabServer
from onpath.app.server.server_options import ServerOptions
from tests.support.browser import Tab

pytestmark = pytest.mark.thorough

ROOMS = open_classes(["k7mf2xqa9tzr", "bn4ws8cd3vyp"])


@pytest.fixture(scope="module")
def server() -> Iterator[LabServer]:
    server = LabServer("127.0.0.1", 0, LoopCache(), ServerOptions(classrooms=ROOMS))
    yield server
    server.stop()


def test_who_opens_the_address_types_a_nickname_only(browser: Browser, server: LabServer) -> None:
    first, second = ROOMS
    context = browser.new_context(viewport={"width": 1280, "height": 800})
    tab = Tab(server, context, draws=False, path=f"/c/{first.code.upper()}")
    assert tab.page.url.partition("?")[0] == f"{server.address}/c/{first.code}/"
    card = tab.page.get_by_role("dialog")
    card.wait_for()  # by itself
    assert card.get_by_label("Class code").count() == 0
    card.get_by_label("Nickname").fill("Ada")
    card.get_by_role("button", name="Join the class").click()
    tab.page.get_by_role("button", name=re.compile("^Ada · class ")).wait_for()
    assert [member.name for member in first.members().values()] == ["Ada"]
    lab = tab.lab
    tab.reload()
    assert tab.lab is lab  # a reload comes back to it
    tab.page.get_by_role("button", name=re.compile("^Ada · class ")).wait_for()
    other = Tab(server, context, draws=False)  # the same browser, in no class
    assert other.lab is not lab
    other.button("Join the class").click()
    card = other.page.get_by_role("dialog")
    assert card.get_by_label("Nickname").count() == 0
    card.get_by_label("Class code").fill(second.code)
    card.get_by_role("button", name="Join the class").click()
    other.page.get_by_role("link", name="Open the page of this class").click()
    other.page.wait_for_url(re.compile(f"/c/{second.code}/$"))
    other.page.get_by_role("dialog").get_by_label("Nickname").wait_for()
    assert not second.members() and tab.errors == other.errors == []
    context.close()
