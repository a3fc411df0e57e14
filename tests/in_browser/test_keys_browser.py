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
from onpath.models.control.settable import specs
from tests.support.browser import Tab, wait_for

pytestmark = pytest.mark.thorough

NAMES = {"space": "Space", "escape": "Escape", "insert": "Insert", "delete": "Delete"}
NAMES |= {f"arrow{way.lower()}": f"Arrow{way}" for way in ("Left", "Right", "Up", "Down")}
NAMES |= {"home": "Home"}
OPENS = "O"  # opens a lesson, which places the camera
SILENT = ("Home", "q", "e", "PageDown", "PageUp")  # they ask nothing of the lab that counts
OPPOSITE = ("ArrowRight", "ArrowDown", "d", "s", "e", "f", "PageUp")  # to keys on the other side
LESSON = "01-path-or-timetable"
TOUCH = {"viewport": {"width": 390, "height": 844}, "has_touch": True}


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


@pytest.mark.parametrize("place", ["tab", "read"])
def test_no_key_of_lab_or_lesson_moves_the_camera(
    request: pytest.FixtureRequest, place: str
) -> None:
    """Keys that could move it in opposite directions are not held down together."""
    tab: Tab = request.getfixturevalue(place)
    for opposite in (False, True):
        keys_do_not_move_the_camera(tab, opposite)


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


def test_the_view_is_reset_on_a_phone(browser: Browser, server: LabServer) -> None:
    with opened(browser, server, "lesson", **TOUCH) as tab:
        placed = settled_camera(tab)
        turn_the_view(tab)
        tab.open("View")
        tab.button("Reset view").click()
        wait_for(lambda: np.allclose(camera(tab), placed, atol=1e-4))


# The focused control.


def test_arrows_on_a_slider_move_that_alone(tab: Tab) -> None:
    lab, before = tab.lab, tab.lab.asked
    value, spec = lab.simulation.parameters.K1, specs(lab.simulation.parameters)["K1"]
    steps = [("ArrowRight", value + spec.step), ("ArrowLeft", value), ("Home", spec.low)]
    tab.focus(tab.slider("K1"))
    for key, wanted in steps:
        tab.page.keyboard.press(key)
        wait_for(lambda wanted=wanted: wanted == lab.simulation.parameters.K1)
    assert asked_since(tab, before) == 3 and tab.simulation.running


def test_keys_move_the_handle_that_looks_back(tab: Tab) -> None:
    lab = tab.lab
    tab.ask(c.SetRunning(False))
    tab.elapse(3.0)
    handle, time = tab.page.get_by_role("slider", name="Look back"), lab.simulation.time
    tab.focus(handle)
    for key, ago in {"PageDown": 1.0, "ArrowLeft": 1.1, "ArrowRight": 1.0}.items():
        tab.page.keyboard.press(key)
        wait_for(
            lambda ago=ago: (
                ago - 0.01 < time - (lab.simulation.viewing or time) < ago + 0.1  # at a sample
            )
        )
    assert lab.simulation.time == time and not lab.simulation.running
    tab.page.keyboard.press("End")
    wait_for(lambda: lab.simulation.viewing is None)


def test_a_focused_button_is_pressed_and_nothing_else(tab: Tab) -> None:
    for key in ("Space", "Enter"):
        before, held = tab.lab.asked, bool(tab.simulation.forces.held)
        tab.focus(tab.page.locator("#op-strip .brake > button"))
        tab.page.keyboard.press(key)
        wait_for(lambda held=held: bool(tab.simulation.forces.held) is not held)
        assert asked_since(tab, before) == 1 and tab.simulation.running


def test_letters_still_work_on_buttons_sliders_and_switches(tab: Tab) -> None:
    """Also those of keyboards with another alphabet."""
    lab, keyboard = tab.lab, tab.page.keyboard
    typist = tab.page.context.new_cdp_session(tab.page)
    slider, switch = tab.slider("K1"), tab.switch("Copy to both")
    for control in (None, slider, switch):
        if control is not None:
            tab.row("K1" if control is slider else "Copy to both")  # opens its group
            tab.focus(control)
        held = bool(lab.simulation.forces.held)
        keyboard.press("h")
        wait_for(lambda held=held: bool(lab.simulation.forces.held) is not held)
        keyboard.press("d")
        wait_for(lambda: lab.simulation.forces.hands)
        keyboard.press("x")
        wait_for(lambda: not lab.simulation.forces.hands)
        for hold in ("р", "η", "ي", "ㅗ"):
            held = bool(lab.simulation.forces.held)
            for kind in ("keyDown", "keyUp"):
                typist.send("Input.dispatchKeyEvent", {"type": kind, "key": hold, "code": "KeyH"})
            wait_for(lambda held=held: bool(lab.simulation.forces.held) is not held)


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


def test_going_on_is_reported_and_undone_by_key_and_button(tab: Tab) -> None:
    lab = tab.lab
    wait_for(lambda: lab.simulation.time > 1.5)
    tab.page.keyboard.press("b")
    wait_for(lambda: lab.simulation.viewing is not None)
    time = lab.simulation.time
    wait_for(lambda: "This is the past" in tab.said())
    tab.page.keyboard.press("Space")
    wait_for(lambda: lab.simulation.running and lab.simulation.time > time)  # back at the present
    tab.page.keyboard.press("b")
    wait_for(lambda: lab.simulation.viewing is not None)
    end = lab.simulation.time
    tab.press("Go on from here")
    wait_for(lambda: "are discarded" in tab.said())
    tab.press("Restore what was discarded")
    wait_for(lambda: lab.simulation.time == end and not lab.simulation.running)
    tab.settle()  # the button that was pressed may be drawn anew
    tab.page.keyboard.press("u")
    wait_for(lambda: lab.simulation.time != end)
    tab.page.keyboard.press("u")
    wait_for(lambda: lab.simulation.time == end)
