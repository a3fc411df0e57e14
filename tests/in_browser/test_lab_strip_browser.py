"""The strip of the free lab: chart, numbers, lenses, titles and handle, told by its channel."""

from __future__ import annotations

import asyncio
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import pytest

pytest.importorskip("playwright")

from playwright.sync_api import Browser, expect

from onpath.app.lab import commands as c
from onpath.app.server.lab_server import LabServer
from onpath.models.control.sides import LEFT, RIGHT
from tests.support.browser import THREE_FRAMES, WAIT, Tab, wait_for
from tests.support.free_lab import fresh

expect.set_options(timeout=WAIT * 1e3)
WINDOWS = [(1280, 800), (1366, 768), (820, 1180), (390, 844)]
CHARTED = [(390, 844), (1280, 800), (844, 390)]
REMEMBER = """() => {
    const {prototype} = CanvasRenderingContext2D
    const {fillText, clearRect} = prototype
    prototype.clearRect = function (...box) {
        this.canvas.letters = []
        clearRect.apply(this, box)
    }
    prototype.fillText = function (text, x, y) {
        const {width} = this.measureText(text), ratio = this.getTransform().a
        const left = {center: x - width / 2, left: x, right: x - width}[this.textAlign]
        const box = [left, y - 5, left + width, y + 5].map(each => each * ratio)
        this.canvas.letters?.push([text, ...box])
        fillText.call(this, text, x, y)
    }
}"""
COLLISIONS = """() => {
    const found = []
    for (const canvas of document.querySelectorAll(".plot canvas")) {
        if (!canvas.checkVisibility()) continue
        const {left, top, width} = canvas.getBoundingClientRect(), ratio = canvas.width / width
        for (const [text, ...box] of canvas.letters ?? [])
            found.push([text, ...box.map((each, i) => each / ratio + (i % 2 ? top : left))])
    }
    const parts = ".handle span, summary, button, .value, .whose, .clock"
    for (const each of document.querySelectorAll(`#op-strip :is(${parts})`)) {
        const {left, top, right, bottom, width} = each.getBoundingClientRect()
        if (!each.checkVisibility({visibilityProperty: true})) continue
        if (each.closest("details")?.clientWidth === 1) continue
        found.push([each.textContent || each.className, left, top, right, bottom])
    }
    const shared = (a, b, k) => Math.min(a[k + 2], b[k + 2]) - Math.max(a[k], b[k])
    const covers = (a, b) => shared(a, b, 1) > 1 && shared(a, b, 2) > 1
    return found.flatMap((a, i) => found.slice(i + 1).filter(b => covers(a, b)).map(b => [a, b]))
}"""
"""What is written in and beside the charts, where it lies on something else."""
BOXES = """() => {
    const box = (each) => each.getBoundingClientRect().toJSON()
    const seen = [...document.querySelectorAll("#op-strip button, #op-strip select")].filter(
        (each) => each.checkVisibility({visibilityProperty: true}))
    return {
        scene: box(document.querySelector("canvas[data-engine]")),
        strip: box(document.querySelector("#op-strip")),
        chart: box(document.querySelector("#op-strip .plot canvas")),
        lenses: [...document.querySelectorAll(".lens canvas")].map(box),
        buttons: seen.map(box),
        width: document.documentElement.scrollWidth,
    }
}"""

EDGES = """() => {
    const { path, lab } = onpathLab
    const box = document.querySelector("canvas[data-engine]").getBoundingClientRect()
    const applied = (row, point) => [...point, 1].reduce((sum, each, k) => sum + row[k] * each, 0)
    const down = ([, row, away], point) => applied(row, point) / applied(away, point)
    const all = lab.cameras.flatMap(camera => path.lines[0].map(point => down(camera, point)))
    return [Math.min(...all), Math.max(...all)].map(each => box.top + box.height * (0.5 + each))
}"""
"""The highest and the lowest point of the path in the picture."""

COVERED = """() => [
    ...document.querySelectorAll(":is(#op-strip, #op-head, #op-panel) button"),
].filter(each => {
    const box = each.getBoundingClientRect()
    const [x, y] = [(box.left + box.right) / 2, (box.top + box.bottom) / 2]
    if (!each.checkVisibility({visibilityProperty: true})) return false
    if (x < 0 || y < 0 || x > innerWidth || y > innerHeight) return false
    const found = document.elementFromPoint(x, y)
    const shown = each.closest("#op-panel .body")?.getBoundingClientRect()
    if (shown && (y < shown.top || y > shown.bottom)) return false
    return !each.contains(found)
}).map(each => each.textContent)"""
"""Buttons in the window that something covers."""


BLURRED = """() => [...document.querySelectorAll(".lens canvas, #op-strip canvas")].filter(each => {
    const {width} = each.getBoundingClientRect()
    return Math.abs(each.width - width * devicePixelRatio) > 1
}).length"""


def number(tab: Tab, title: str) -> float:
    """The large number of a robot, [mm]."""
    return float(tab.page.get_by_role("group", name=title).inner_text().split()[0])


def test_numbers_titles_and_captions_are_the_labs(tab: Tab) -> None:
    lab, page = tab.lab, tab.page
    wait_for(lambda: lab.simulation.time > 1.0)
    tab.press("Hold both back")
    wait_for(lambda: lab.simulation.runs[LEFT].distance > 0.02)
    tab.press("Pause")
    wait_for(lambda: not lab.simulation.running)
    for title, side in {"Tracker": LEFT, "Follower": RIGHT}.items():
        expect(page.get_by_role("heading", name=title)).to_be_visible()
        distance = 1e3 * lab.simulation.runs[side].distance
        wait_for(lambda title=title, mm=distance: abs(number(tab, title) - mm) < 0.06)
    expect(page.locator("#op-stage").get_by_text("torn off")).to_be_visible()
    expect(tab.button("Let both go")).to_have_attribute("aria-pressed", "true")
    tab.ask(c.Hold(False), c.ChooseLaw(RIGHT, "set_point"))
    expect(page.get_by_role("heading", name="Set point")).to_be_visible()


def test_the_mouse_looks_back_and_the_lab_goes_along(tab: Tab) -> None:
    lab, page = tab.lab, tab.page
    wait_for(lambda: lab.simulation.time > 3.0)
    tab.press("Pause")
    wait_for(lambda: not lab.simulation.running)
    plot = page.locator("#op-strip .plot").bounding_box()
    assert plot is not None
    page.mouse.click(plot["x"] + 0.15 * plot["width"], plot["y"] + plot["height"] / 2)
    wait_for(lambda: lab.simulation.viewing is not None)
    assert (
        lab.simulation.viewing is not None and 0 <= lab.simulation.viewing < lab.simulation.time - 1
    )
    expect(tab.button("Go on from here")).to_be_visible()
    tab.press("Back to now")
    wait_for(lambda: lab.simulation.viewing is None)
    tab.button("Go on from here").wait_for(state="hidden")


def test_a_lesson_is_read_beside_the_robots_and_above_the_strip(tab: Tab) -> None:
    strip, column = tab.page.locator("#op-strip"), tab.page.locator("#op-column")
    expect(strip).to_be_visible()
    expect(column).to_be_hidden()
    tab.ask(c.OpenLesson(next(iter(tab.lab.lessons.course.lessons))))
    expect(column).to_be_visible()
    read, scene = column.bounding_box(), tab.page.locator("canvas[data-engine]").bounding_box()
    assert read and scene and read["width"] > 300 and scene["width"] > 300
    assert (
        read["x"] + read["width"] <= scene["x"] + 1 or scene["x"] + scene["width"] <= read["x"] + 1
    )
    wait_for(lambda: tab.page.evaluate(BLURRED) == 0)
    tab.ask(c.CloseLesson())
    expect(column).to_be_hidden()
    wait_for(lambda: tab.page.evaluate(BLURRED) == 0)
    expect(strip).to_be_visible()


def test_a_lost_connection_is_said_and_comes_back(tab: Tab) -> None:
    stream: Any = tab.display._data._stream  # type: ignore[union-attr]
    opened, loop = stream.opened, tab.server.server.get_event_loop()
    asyncio.run_coroutine_threadsafe(stream._connection.close(1012), loop).result(10.0)
    wait_for(lambda: stream.opened == opened + 1)
    expect(tab.page.get_by_text("No connection to the lab")).to_have_count(0)
    tab.press("Hold both back")
    wait_for(lambda: tab.simulation.forces.held)


@contextmanager
def opened(browser: Browser, server: LabServer, **options: Any) -> Iterator[Tab]:
    """A tab that remembers what is written on its charts."""
    context = fresh(browser)
    context.add_init_script(f"({REMEMBER})()")
    tab = Tab(server, context, draws=False, **options)
    yield tab
    assert tab.errors == []
    context.close()


def give(tab: Tab, size: tuple[int, int]) -> None:
    """Give the window a size."""
    tab.page.set_viewport_size({"width": size[0], "height": size[1]})
    wait_for(tab.is_framed)
    tab.page.evaluate(THREE_FRAMES)


def test_everything_fits_into_windows_of_all_shapes(browser: Browser, server: LabServer) -> None:
    """The stage above, the strip below, all buttons inside and apart from the chart."""
    with opened(browser, server) as tab:
        for width, height in WINDOWS:
            give(tab, (width, height))
            expect(tab.page.locator("#op-strip")).to_be_visible()
            wait_for(lambda h=height: tab.page.evaluate(BOXES)["scene"]["bottom"] <= h - 100)
            boxes = tab.page.evaluate(BOXES)
            assert boxes["strip"]["top"] >= boxes["scene"]["bottom"] - 1
            assert boxes["strip"]["bottom"] <= height + 1 and boxes["width"] <= width
            assert boxes["scene"]["height"] > (0.5 if width > height else 0.34) * height
            assert tab.page.evaluate(COVERED) == []
            assert boxes["chart"]["height"] > 70 and boxes["chart"]["bottom"] <= height
            assert len(boxes["buttons"]) >= 4
            for button in boxes["buttons"]:
                assert button["left"] >= 0 and button["right"] <= width
                assert button["height"] >= 30 and button["bottom"] <= boxes["chart"]["top"] + 1
            for lens in boxes["lenses"]:
                assert lens["width"] > 60 and lens["left"] >= 0 and lens["right"] <= width


def height_of(tab: Tab) -> float:
    box = tab.page.locator("#op-strip .plot").first.bounding_box()
    assert box is not None
    return box["height"]


def test_nothing_in_the_strip_lies_on_something_else(browser: Browser, server: LabServer) -> None:
    """While robots are free, held, pulled, and in the past, where the chart stays as high."""
    with opened(browser, server) as tab:
        for size in CHARTED:
            give(tab, size)
            _is_tidy_throughout(tab)


def _is_tidy_throughout(tab: Tab) -> None:
    page = tab.page

    def is_tidy() -> None:
        for _ in range(3):
            tab.elapse(0.4)
            page.evaluate(THREE_FRAMES)
            assert page.evaluate(COLLISIONS) == []

    tab.ask(c.SetRunning(True))
    is_tidy()
    tab.ask(c.Hold(True))
    is_tidy()
    tab.ask(c.Hold(False))
    page.keyboard.press("d")
    is_tidy()
    page.keyboard.press("x")
    high = height_of(tab)
    assert high > 80
    tab.ask(c.LookBack(1.0))
    expect(tab.button("Go on from here")).to_be_visible()
    page.evaluate(THREE_FRAMES)
    assert page.evaluate(COLLISIONS) == []
    assert height_of(tab) == pytest.approx(high, abs=1)


@pytest.mark.thorough
def test_nothing_lies_on_a_board_and_it_stays_high_enough_to_be_read(
    browser: Browser, server: LabServer
) -> None:
    for size in CHARTED:
        with opened(browser, server) as tab:  # a prediction is made once
            give(tab, size)
            lesson = next(iter(tab.lab.lessons.course.lessons))
            tab.ask(c.OpenLesson(lesson), c.TakeStep(lesson, 0), c.TakeStep(lesson, 1))
            tab.wait_until_built()
            _board_is_tidy(tab)


def _board_is_tidy(tab: Tab) -> None:
    page = tab.page
    board = page.locator(".plot.drawn")
    board.scroll_into_view_if_needed()
    box = board.bounding_box()
    assert box is not None
    page.mouse.move(box["x"] + 60, box["y"] + 100)
    page.mouse.down()
    page.mouse.move(box["x"] + 200, box["y"] + 40, steps=5)
    page.mouse.move(box["x"] + box["width"] - 20, box["y"] + 90, steps=5)
    page.mouse.up()
    page.evaluate(THREE_FRAMES)
    assert page.evaluate(COLLISIONS) == []
    tab.press("Commit to this prediction")
    expect(tab.button("Next")).to_be_visible()
    page.evaluate(THREE_FRAMES)
    assert page.evaluate(COLLISIONS) == []
    after = page.locator(".plot:visible").last.bounding_box()
    assert after is not None and after["height"] > 110


def test_an_invitation_covers_neither_paths_nor_the_strip(
    browser: Browser, server: LabServer
) -> None:
    with opened(browser, server, newcomer=True) as tab:
        invitation = tab.page.locator("#op-invitation")
        expect(invitation).to_be_visible()
        tab.ask(c.Hold(True))
        expect(invitation).to_contain_text("tears it off")

        def is_free(width: int) -> bool:
            box, boxes = invitation.bounding_box(), tab.page.evaluate(BOXES)
            assert box is not None and boxes["chart"]["height"] > 70
            bottom, (top, lowest) = box["y"] + box["height"], tab.page.evaluate(EDGES)
            if bottom <= top:
                return True
            end = lowest if width < 500 else boxes["scene"]["bottom"] - 1
            is_below = box["y"] >= end  # no room above the robots
            shown = [boxes["chart"], *boxes["lenses"], *boxes["buttons"]]
            return is_below and all(
                bottom <= each["top"] or each["bottom"] <= box["y"] for each in shown
            )

        for size in CHARTED:
            give(tab, size)
            wait_for(lambda width=size[0]: is_free(width))
            assert tab.page.evaluate(COLLISIONS) == []
