"""Keys in the lab and in a lesson, in a real browser: what handles them, and the camera."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np
import pytest

pytest.importorskip("playwright")

from playwright.sync_api import Browser, expect
from viser import _messages

from onpath.app.lab import commands as c
from onpath.app.server.lab_server import LabServer
from onpath.app.view.keys import KEYS
from tests.support.browser import Tab, wait_for

pytestmark = pytest.mark.thorough

NAMES = {"space": "Space", "escape": "Escape", "insert": "Insert", "delete": "Delete"}
NAMES |= {f"arrow{way.lower()}": f"Arrow{way}" for way in ("Left", "Right", "Up", "Down")}
NAMES |= {"home": "Home"}
OPENS = "O"  # opens a lesson, which places the camera
SILENT = ("Home", "q", "e", "PageDown", "PageUp")  # they ask nothing of the lab that counts
OPPOSITE = ("ArrowRight", "ArrowDown", "d", "s", "e", "f", "PageUp")  # to keys on the other side
LESSON = "01-path-or-timetable"


@contextmanager
def opened(browser: Browser, server: LabServer, place: str, **options: object) -> Iterator[Tab]:
    """A tab in the free lab, or in a lesson."""
    context = browser.new_context(**{"viewport": {"width": 1280, "height": 800}, **options})  # type: ignore[arg-type]
    tab = Tab(server, context, draws=False)
    if place == "lesson":
        tab.ask(c.OpenLesson(LESSON))
        tab.page.get_by_role("heading", name="Two robots, one circle").wait_for()
    yield tab
    assert tab.errors == []
    context.close()


@pytest.fixture(scope="module")
def shared(browser: Browser, server: LabServer) -> Iterator[Tab]:
    with opened(browser, server, "lab") as tab:
        yield tab


@pytest.fixture(scope="module")
def read(browser: Browser, server: LabServer) -> Iterator[Tab]:
    with opened(browser, server, "lesson") as tab:
        yield tab


@pytest.fixture
def tab(shared: Tab) -> Iterator[Tab]:
    """A tab with a running lab, with nothing selected and nothing focused."""
    shared.blur()
    shared.ask(c.ResetParameters(), c.SelectPoint(None), c.Reset(), c.SetRunning(True))
    yield shared
    shared.ask(c.SetRunning(False))


def asked_since(tab: Tab, before: int) -> int:
    """Number of commands from the keys, not counting the one that ends the measurement."""
    tab.blur()
    tab.ask(c.SelectPoint(None))
    tab.page.keyboard.press("n")
    wait_for(lambda: tab.simulation.editor.selected == 0)
    return tab.lab.asked - before - 2


def camera(tab: Tab) -> np.ndarray:
    """Position and target of the camera, as the page reports them, shape (6,), [m]."""
    camera = tab.client.camera
    for _ in range(2):  # the first answer may have been sent earlier
        before = camera.update_timestamp
        up = tuple(camera.up_direction.tolist())
        message = _messages.SetCameraUpDirectionMessage(up)
        tab.client._websock_connection.queue_message(message)
        wait_for(lambda: camera.update_timestamp > before)
    return np.concatenate([camera.position, camera.look_at])


def settled_camera(tab: Tab) -> np.ndarray:
    """Position and target of the camera once neither the lab nor the page places it anew."""
    wait_for(lambda: not tab.display.scene._settling)  # type: ignore[attr-defined]
    placed = camera(tab)
    for _ in range(20):
        tab.settle()
        before, placed = placed, camera(tab)
        if np.allclose(placed, before):
            return placed
    raise AssertionError("the camera does not come to rest")


# The camera.


def test_no_key_of_lab_or_lesson_moves_the_camera(read: Tab) -> None:
    """Keys that could move it in opposite directions are not held down together."""
    for opposite in (False, True):
        keys_do_not_move_the_camera(read, opposite)


def keys_do_not_move_the_camera(tab: Tab, opposite: bool) -> None:
    tab.blur()
    tab.ask(c.SetRunning(False))
    pressed = [
        ("Control+" if key.control else "") + NAMES.get(key.hotkey, key.hotkey.lower())
        for key in KEYS
        if key.hotkey != OPENS
    ]
    placed = settled_camera(tab)
    names = [n for n in [*pressed, *SILENT] if (n in OPPOSITE) is opposite]
    for name in names:
        asked = tab.lab.asked
        tab.page.keyboard.down(name) if "+" not in name else tab.page.keyboard.press(name)
        if name not in SILENT:
            wait_for(lambda asked=asked: tab.lab.asked > asked)
    tab.settle()
    for name in names:
        if "+" not in name:
            tab.page.keyboard.up(name)
    np.testing.assert_allclose(camera(tab), placed, atol=1e-6)


def turn_the_view(tab: Tab) -> None:
    box = tab.page.locator("canvas").first.bounding_box()
    assert box is not None
    x, y = box["x"] + 0.5 * box["width"], box["y"] + 0.08 * box["height"]
    before = camera(tab)
    tab.settle()
    tab.page.mouse.move(x, y)
    tab.page.mouse.down(button="right")
    tab.page.mouse.move(x + 60, y + 25, steps=2)
    tab.page.mouse.up(button="right")
    tab.settle()
    assert np.abs(camera(tab) - before).max() > 1e-3


def test_the_view_is_reset_by_a_key_and_by_a_button(tab: Tab) -> None:
    placed = settled_camera(tab)
    turn_the_view(tab)
    asked = tab.lab.asked
    tab.page.keyboard.press("Home")
    wait_for(lambda: np.allclose(camera(tab), placed, atol=1e-4))
    turn_the_view(tab)
    tab.open("View")
    tab.button("Reset view").click()
    wait_for(lambda: np.allclose(camera(tab), placed, atol=1e-4))
    assert tab.lab.asked == asked  # nobody else who looks at this lab notices


# The focused control.


def test_a_focused_button_is_pressed_and_nothing_else(tab: Tab) -> None:
    for key in ("Space", "Enter"):
        before, held = tab.lab.asked, bool(tab.simulation.forces.held)
        tab.focus(tab.page.locator("#op-strip .brake > button"))
        tab.page.keyboard.press(key)
        wait_for(lambda held=held: bool(tab.simulation.forces.held) is not held)
        assert asked_since(tab, before) == 1 and tab.simulation.running


def test_what_is_typed_into_a_field_does_nothing_else(tab: Tab) -> None:
    lab = tab.lab
    before, box = lab.asked, tab.number("K1")
    tab.focus(box)
    box.press("Control+A")
    for key in ("d", "x", "h", "w", "r", "g", "u", "Home"):
        tab.page.keyboard.press(key)
    expect(box).to_have_value("dxhwrgu")
    tab.page.keyboard.press("Escape")
    tab.page.keyboard.press("Control+k")
    expect(tab.page.get_by_role("dialog")).to_be_visible()  # the search
    tab.page.keyboard.type("rhx")
    tab.page.keyboard.press("Escape")
    tab.page.get_by_role("dialog").wait_for(state="detached")
    assert asked_since(tab, before) == 0 and lab.simulation.running
