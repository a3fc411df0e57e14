"""Whoever asks for dark pages gets them: the page, the scene, and what can be read on both."""

from __future__ import annotations

import re
from collections.abc import Iterator
from io import BytesIO
from typing import Any

import numpy as np
import pytest

pytest.importorskip("playwright")

from PIL import Image
from playwright.sync_api import Browser, expect

from onpath.app.classroom.classroom import Classroom
from onpath.app.common.access_codes import shown
from onpath.app.lab import commands as c
from onpath.app.lab.commands import TakeStep
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.server.lab_server import LabServer
from onpath.app.server.server_options import ServerOptions
from onpath.app.viser_adapter.addresses import class_address
from tests.support.axe import violations
from tests.support.browser import THREE_FRAMES, WAIT, Tab, wait_for

pytestmark = pytest.mark.thorough
expect.set_options(timeout=WAIT * 1e3)

LETTERS = """() => {
    const drawing = WebGL2RenderingContext.prototype, {getUniformLocation, uniform1f} = drawing
    const places = new Set()
    drawing.getUniformLocation = function (program, name) {
        const place = getUniformLocation.call(this, program, name)
        if (name === "onpathDark") places.add(place)
        return place
    }
    drawing.uniform1f = function (place, value) {
        if (places.has(place)) window.letters = value
        uniform1f.call(this, place, value)
    }
}"""
LESSON = "01-path-or-timetable"
SIZES = {"desk": (1280, 800), "telephone": (390, 844)}


def visit(browser: Browser, server: LabServer, size: str = "desk", **options: Any) -> Tab:
    width, height = SIZES[size]
    draws = options.pop("draws", False)
    scheme, path = options.pop("scheme", "dark"), options.pop("path", "/")
    context = browser.new_context(
        viewport={"width": width, "height": height}, color_scheme=scheme, **options
    )
    return Tab(server, context, draws=draws, path=path)


@pytest.fixture(scope="module")
def tab(browser: Browser, server: LabServer) -> Iterator[Tab]:
    tab = visit(browser, server)
    yield tab
    assert tab.errors == []
    tab.page.context.close()


@pytest.fixture(scope="module")
def drawn(browser: Browser, server: LabServer) -> Iterator[dict[str, Tab]]:
    """A light and a dark page on which triangles are drawn, too."""
    tabs = {s: visit(browser, server, draws=True, scheme=s) for s in ("light", "dark")}
    for tab in tabs.values():
        tab.ask(c.SetRunning(False))
        tab.settle()
    yield tabs
    for tab in tabs.values():
        tab.page.context.close()


def brightness(tab: Tab, low: tuple[float, float], high: tuple[float, float]) -> np.ndarray:
    """Brightness of a part of the scene, given by shares of its size, from 0 to 1."""
    box = tab._canvas()
    clip = {
        "x": box["x"] + low[0] * box["width"],
        "y": box["y"] + low[1] * box["height"],
        "width": (high[0] - low[0]) * box["width"],
        "height": (high[1] - low[1]) * box["height"],
    }
    picture = Image.open(BytesIO(tab.page.screenshot(clip=clip))).convert("L")  # type: ignore[arg-type]
    return np.asarray(picture) / 255.0


def test_scene_titles_and_boards_are_dark(drawn: dict[str, Tab]) -> None:
    wall, ground, title = ((0.02, 0.02), (0.98, 0.1)), ((0.02, 0.95), (0.98, 0.99)), (0.05, 0.0)
    for scheme, tab in drawn.items():
        is_dark = scheme == "dark"
        for place in (wall, ground):
            assert (np.median(brightness(tab, *place)) < 0.5) == is_dark
        seen = brightness(tab, title, (0.95, 0.1))
        assert (np.median(seen) < 0.2) == is_dark
        assert seen.max() > 0.75 and seen.min() < 0.3
        tab.ask(TakeStep(LESSON, 1))
        tab.page.get_by_role("heading", name="Draw what the tracker does").wait_for()
        tab.settle()
        board = tab.page.locator(".board")
        picture = Image.open(BytesIO(board.screenshot())).convert("L")
        assert (np.median(np.asarray(picture)) < 80) == is_dark


def test_the_page_is_dark_and_nothing_on_it_is_hard_to_read(tab: Tab) -> None:
    expect(tab.page.locator("html")).to_have_class(re.compile("op-dark"))
    for group in tab.page.locator("#op-panel summary").all():
        group.click()
        assert violations(tab) == []


def test_an_open_page_follows_the_browser_s_scheme_without_being_loaded_again(
    browser: Browser, server: LabServer
) -> None:
    tab = visit(browser, server, scheme="light")
    lab = tab.lab
    box = tab.number("K1")
    box.press("Control+A")
    tab.page.keyboard.type("12")
    tab.page.evaluate("window.isFirst = true")
    tab.page.emulate_media(color_scheme="dark")
    expect(tab.page.locator("html")).to_have_class(re.compile("op-dark"))
    expect(tab.page.locator("html")).to_have_attribute("data-mantine-color-scheme", "dark")
    expect(box).to_be_focused()
    expect(box).to_have_value("12")  # half typed
    assert tab.page.evaluate("window.isFirst") and tab.scheduled.lab is lab
    tab.page.context.close()


def test_letters_in_the_scene_follow_the_users_own_look(
    browser: Browser, server: LabServer
) -> None:
    tab = visit(browser, server, draws=True, scheme="light")
    tab.page.evaluate(LETTERS)
    tab.switch("Labels, axes").check()
    tab.more("Language, display")
    look = tab.page.get_by_role("combobox", name="Look")
    for choice in ("dark", "light"):
        look.select_option(choice)
        wait_for(lambda dark=choice == "dark": tab.page.evaluate("window.letters") == float(dark))
    assert tab.errors == []
    tab.page.context.close()


def test_every_step_of_a_dark_lesson_can_be_read(tab: Tab) -> None:
    tab.ask(c.OpenLesson(LESSON), c.SetRunning(False))
    lesson = tab.lab.lessons.lesson
    assert lesson is not None
    found = dict[str, list[list[str]]]()
    for index, step in enumerate(lesson.steps):
        tab.ask(TakeStep(LESSON, index))
        tab.page.get_by_role("heading", name=step.title).wait_for()
        tab.wait_until_built()
        for name, (width, height) in SIZES.items():
            tab.page.set_viewport_size({"width": width, "height": height})
            tab.page.evaluate(THREE_FRAMES)
            if broken := violations(tab):
                found[f"{step.title}, {name}"] = broken
    assert found == {}


def test_a_dark_teachers_page_can_be_read(browser: Browser) -> None:
    room = Classroom()
    server = LabServer("127.0.0.1", 0, LoopCache(), ServerOptions(classrooms=[room]))
    tab = visit(browser, server, path=class_address(room.code))
    tab.page.get_by_role("dialog").wait_for()  # the card of the class
    tab.page.keyboard.press("Escape")
    tab.teach(shown(room.key))
    tab.page.get_by_text(room.code.upper()).or_(tab.page.get_by_text(room.code)).first.wait_for()
    wait_for(tab.is_built)
    assert violations(tab) == []
    tab.page.context.close()
    server.stop()


def test_plots_can_be_read_with_the_users_own_colours(browser: Browser, server: LabServer) -> None:
    tab = visit(browser, server, scheme="light", forced_colors="active")
    behind = "plot => getComputedStyle(plot).backgroundColor"
    assert tab.page.locator("#op-strip .plot").evaluate(behind) == "rgb(255, 255, 255)"
    tab.page.context.close()
