"""The chart of distances, the lenses and the buttons for time, in an exported figure."""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from playwright.sync_api import expect

import onpath
from onpath.lessons.words import ENGLISH
from tests.support.browser import THREE_FRAMES
from tests.support.checkout import ROOT
from tests.support.waiting import wait_for

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Locator, Page

WAIT = 30.0  # [s]
README = ROOT / "app" / "exports" / "standalone" / "README.md"
PARTS = """() => ({
    spans: onpath.strip.chart.spans,
    axes: onpath.strip.chart.axes,
    from: onpath.strip.chart.from,
    until: onpath.strip.chart.until,
    lines: onpath.strip.chart.lines.map(({name, times, values}) => ({name, times, values})),
})"""
HELD_AND_PULLED = """() => {
    const {simulation, advance} = onpath
    simulation.reset()
    advance(1000)
    simulation.hold(true)
    advance(1500)
    simulation.hold(false)
    advance(1500)
    simulation.pull([0.03, 0])
    advance(500)
    simulation.pull(null)
    advance(1000)
}"""


def opened(browser: Browser, folder: Path, **more: Any) -> Page:
    """A figure that stands still until it is told something."""
    page = browser.new_page(viewport={"width": 900, "height": 900}, reduced_motion="reduce")
    page.goto(onpath.figure(**more).save(folder / "a.html").as_uri())
    wait_for(lambda: page.evaluate("'onpath' in window"), WAIT)
    return page


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("strip")


@pytest.fixture(scope="module")
def page(browser: Browser, file: Path) -> Iterator[Page]:
    page = opened(browser, file)
    complaints = list[str]()
    page.on("pageerror", lambda error: complaints.append(str(error)))
    page.on("console", lambda message: complaints.append(message.text))
    yield page
    assert complaints == []
    page.close()


@pytest.fixture(autouse=True)
def anew(page: Page) -> None:
    page.evaluate("onpath.simulation.reset()")
    page.evaluate("onpath.engine.act({do: 'run', on: false})")
    page.evaluate(THREE_FRAMES)


def handle(page: Page) -> Locator:
    return page.get_by_role("slider", name=ENGLISH("chart.look"))


def parts(page: Page) -> Any:
    page.evaluate(THREE_FRAMES)
    return page.evaluate(PARTS)


def test_rows_are_added_and_removed_and_look_back_together(page: Page) -> None:
    page.evaluate(HELD_AND_PULLED)
    page.get_by_role("button", name=ENGLISH("plots.menu")).click()
    for name in ("across", "place"):
        page.get_by_role("checkbox", name=ENGLISH(f"plot.{name}"), exact=True).click()
    page.keyboard.press("Escape")
    page.evaluate(THREE_FRAMES)
    assert page.get_by_role("img", name="ξ₁ [mm]").count() == 1
    rows = page.evaluate("""onpath.strip.rows.map(({chart}) => [chart.from, chart.until, chart.at,
        chart.lines.map(({times, values}) => [times, values])])""")
    assert len(rows) == 3 and rows[0][:3] == rows[1][:3] == rows[2][:3]
    for (times, far), (same, across) in zip(rows[0][3], rows[1][3], strict=True):
        assert times == same  # ξ₁ is the distance from a circle, with a sign
        np.testing.assert_allclose(np.abs(across), far, atol=0.02)
    handle(page).press("PageDown")
    page.evaluate(THREE_FRAMES)
    at = page.evaluate("onpath.strip.rows.map(({chart}) => chart.at)")
    assert at[0] < rows[0][2] - 0.9 and at == [at[0]] * 3
    assert "ξ₁" in (handle(page).get_attribute("aria-valuetext") or "")
    page.get_by_role("button", name=ENGLISH("plots.menu")).click()
    for name in ("across", "place"):
        page.get_by_role("checkbox", name=ENGLISH(f"plot.{name}"), exact=True).click()
    page.keyboard.press("Escape")
    assert page.get_by_role("img", name="ξ₁ [mm]").count() == 0


def test_keys_on_the_handle_look_back_and_everything_goes_along(page: Page) -> None:
    page.evaluate(HELD_AND_PULLED)
    now = page.evaluate("onpath.simulation.sides.map(side => side.tip())")
    grip = handle(page)
    grip.focus()
    for _ in range(3):
        grip.press("PageDown")
    grip.press("ArrowLeft")
    expect(grip).to_have_attribute("aria-valuetext", re.compile("^2.4 s: Trajectory tracking "))
    told = grip.get_attribute("aria-valuetext") or ""
    past = "onpath.simulation.recent.find(each => each.time === onpath.engine.state.past)"
    sample = page.evaluate(past)
    page.evaluate(THREE_FRAMES)
    for side, element in zip(sample["sides"], page.locator(".lens .distance").all(), strict=True):
        assert f"{1e3 * side['distance']:.1f} mm" in told
        decimals = 2 if "×20" in element.locator("..").inner_text() else 1  # as close as it goes
        assert element.inner_text() == f"{1e3 * side['distance']:.{decimals}f} mm"
    assert page.locator(".lens").filter(has_text=ENGLISH("chart.held")).count() == 2
    then = page.evaluate("onpath.simulation.sides.map(side => side.tip())")
    np.testing.assert_allclose(then, sample["tips"], atol=1e-12)
    assert np.abs(np.array(then) - now).max() > 0.005
    assert page.evaluate("onpath.simulation.time") == pytest.approx(5.5)
    grip.press("Home")
    expect(grip).to_have_attribute("aria-valuenow", "0.0")
    grip.press("End")
    assert page.evaluate("onpath.engine.state.past") is None
    np.testing.assert_array_equal(
        page.evaluate("onpath.simulation.sides.map(side => side.tip())"), now
    )


def test_the_handle_is_dragged(page: Page) -> None:
    page.evaluate(HELD_AND_PULLED)
    page.evaluate(THREE_FRAMES)
    box = handle(page).bounding_box()
    assert box
    x, y = box["x"] + box["width"] / 2, box["y"] + 10
    second = page.evaluate("onpath.strip.chart.x(1) - onpath.strip.chart.x(0)")
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x - 2 * second, y, steps=4)
    assert page.evaluate("onpath.engine.state.past") == pytest.approx(3.5, abs=0.05)
    page.mouse.move(x + 5 * second, y, steps=4)
    page.mouse.up()
    assert page.evaluate("onpath.engine.state.past") is None


def test_buttons_keep_their_places_whatever_they_say(page: Page) -> None:
    places = """() => [...document.querySelectorAll(".transport :is(button, select)")]
        .map(each => each.getBoundingClientRect().toJSON()).filter(each => each.width)"""
    before = page.evaluate(places)
    page.evaluate("onpath.advance(2000)")
    for act in ("{do: 'run', on: true}", "{do: 'hold', on: true}", "{do: 'seek', at: 1}"):
        page.evaluate(f"onpath.engine.act({act})")
        page.evaluate(THREE_FRAMES)
        assert page.evaluate(places) == before
    page.evaluate("onpath.engine.act({do: 'hold', on: false})")


def test_the_table_has_what_the_chart_shows(page: Page) -> None:
    page.evaluate(HELD_AND_PULLED)
    page.evaluate(THREE_FRAMES)
    page.locator("summary", has_text=ENGLISH("chart.table")).click()
    table = page.get_by_role("table", name=ENGLISH("chart.title"))
    expect(table.get_by_role("columnheader")).to_contain_text(
        ["Trajectory tracking [mm]", "Path following [mm]"]
    )
    rows = [row.get_by_role("cell").all_inner_texts() for row in table.get_by_role("row").all()][1:]
    lines = parts(page)["lines"]
    held = [float(row[0]) for row in rows if row[3] == ENGLISH("chart.held")]
    assert len(rows) == 12 and held == [1.5, 2.0, 2.5]
    for row in rows:
        for line, cell in zip(lines, row[1:3], strict=True):
            expected = np.interp(float(row[0]), line["times"], line["values"])
            assert float(cell) == pytest.approx(expected, abs=0.06)
    page.locator("summary", has_text=ENGLISH("chart.table")).click()


LETTERS_IN_A_LENS = """() => {
    const [lens] = onpath.lenses, {engine} = onpath
    const {canvas, width} = lens.sheet, ink = canvas.getContext("2d")
    const size = Math.min(width, lens.sheet.height), sample = structuredClone(engine.present)
    Object.defineProperty(engine, "present", {value: sample, configurable: true})
    const {fillText} = ink, found = []
    for (const newtons of [0.3, 6.1, 12, 140])
        for (let degrees = 0; degrees < 360; degrees += 15) {
            const boxes = []
            ink.fillText = function (text, x, y) {
                const half = ink.measureText(text).width / 2
                boxes.push({text, left: x - half, right: x + half, top: y - 5, bottom: y + 5})
                fillText.call(ink, text, x, y)
            }
            const way = [Math.cos(degrees * Math.PI / 180), Math.sin(degrees * Math.PI / 180)]
            for (const side of sample.sides) side.force = way.map(each => newtons * each)
            Object.assign(lens, {stale: true, drawn: 0, could: 0})
            lens.draw()
            found.push({newtons, degrees, boxes})
        }
    delete ink.fillText
    delete engine.present
    return [size / 2, found]
}"""


def test_letters_in_a_lens_are_whole_and_apart(page: Page) -> None:
    """Whatever the lens and the force: inside the rim, and off each other and the bar."""
    for size in (75, 99, 144, 184, 256):
        letters_are_whole_and_apart(page, size)


def letters_are_whole_and_apart(page: Page, size: int) -> None:
    page.evaluate("onpath.simulation.reset()")
    page.evaluate("size => (onpath.lenses[0].element.style.width = `${size}px`)", size)
    page.evaluate("onpath.advance(1000)")
    page.evaluate("onpath.simulation.hold(true)")
    for ticks in (0, 130, 170, 210, 390):
        page.evaluate(f"onpath.advance({ticks})")
        page.evaluate(THREE_FRAMES)
        radius, pictures = page.evaluate(LETTERS_IN_A_LENS)
        assert radius == pytest.approx(size / 2, abs=1)
        for picture in pictures:
            boxes = picture["boxes"]
            assert radius < 40 or sum(box["text"].endswith(" mm") for box in boxes) == 1
            assert radius < 55 or sum(box["text"].endswith(" N") for box in boxes) == 1
            for box in boxes:
                across = max(radius - box["left"], box["right"] - radius)
                down = max(radius - box["top"], box["bottom"] - radius)
                assert np.hypot(across, down) < radius - 3, picture
            for one, two in itertools.combinations(boxes, 2):
                across = min(one["right"], two["right"]) - max(one["left"], two["left"])
                down = min(one["bottom"], two["bottom"]) - max(one["top"], two["top"])
                assert min(across, down) <= 0, picture


def test_a_page_around_is_told_the_height(browser: Browser, tmp_path: Path) -> None:
    onpath.figure().save(tmp_path / "held.html")
    (snippet,) = re.findall(r"```html\n(.*?)```", README.read_text("utf-8"), re.DOTALL)
    sandboxed = snippet.replace("<iframe", '<iframe sandbox="allow-scripts"')
    (tmp_path / "blog.html").write_text(f"<!doctype html>{sandboxed}", encoding="utf-8")
    page = browser.new_page(viewport={"width": 1000, "height": 600})
    page.goto((tmp_path / "blog.html").as_uri())
    content = "document.documentElement.scrollHeight <= innerHeight && innerHeight > 300"
    for width in (1000, 390):
        page.set_viewport_size({"width": width, "height": 600})
        wait_for(lambda: page.frames[1].evaluate(content), WAIT)
    page.close()
