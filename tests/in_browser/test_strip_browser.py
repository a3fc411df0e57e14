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
SOME = "five_bar", "seven_axes"  # robots of every run of the tests
README = ROOT / "app" / "exports" / "standalone" / "README.md"
PARTS = """() => ({
    spans: onpath.strip.chart.spans,
    axes: onpath.strip.chart.axes,
    from: onpath.strip.chart.from,
    until: onpath.strip.chart.until,
    lines: onpath.strip.chart.lines.map(({name, times, values}) => ({name, times, values})),
})"""
LETTERS = """async () => {
    const {prototype} = CanvasRenderingContext2D
    const {fillText} = prototype
    const found = []
    prototype.fillText = function (text, ...at) {
        found.push([this.canvas.parentElement.className, text])
        fillText.call(this, text, ...at)
    }
    onpath.simulation.changed("state")
    await new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))
    Object.assign(prototype, {fillText})
    return found
}"""
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


def test_what_acts_is_shaded_and_named_and_each_event_tells_its_own_peak(page: Page) -> None:
    page.evaluate(HELD_AND_PULLED)
    shown = parts(page)
    spans = [(each["kind"], each["from"], each["until"]) for each in shown["spans"]]
    assert [each[0] for each in spans] == ["held", "pulled"]
    np.testing.assert_allclose([each[1:] for each in spans], [[1, 2.5], [4, 4.5]], atol=0.02)
    letters = [text for where, text in page.evaluate(LETTERS) if where == "plot"]
    assert {ENGLISH("chart.held"), ENGLISH("chart.pulled")} <= set(letters)
    assert {ENGLISH("chart.centre"), "Trajectory tracking", "Path following"} <= set(letters)
    for line in shown["lines"]:
        times, values = np.array(line["times"]), np.array(line["values"])
        for begin, end in ((1.0, 4.0), (4.0, 5.5)):
            peak = values[(times >= begin - 0.01) & (times < end)].max()
            assert f"{peak:.1f}" in letters, (line["name"], begin)


def test_a_peak_keeps_its_number_until_it_leaves_the_chart(page: Page) -> None:
    page.evaluate(HELD_AND_PULLED)
    lines = parts(page)["lines"]
    end = next(i for i, time in enumerate(lines[0]["times"]) if time > 3.9)
    peak = max(lines[0]["values"][:end])
    when = lines[0]["times"][lines[0]["values"].index(peak)]
    for _ in range(12):
        page.evaluate("onpath.advance(500)")
        shown = parts(page)
        letters = [text for where, text in page.evaluate(LETTERS) if where == "plot"]
        assert (f"{peak:.1f}" in letters) == (shown["from"] <= when), shown["from"]
    page.evaluate("onpath.advance(62000)")  # longer than what is kept
    shown = parts(page)
    first = page.evaluate("onpath.engine.since(-Infinity)[0].time")
    times = shown["lines"][0]["times"]
    assert times[-1] - times[0] > 59 and all(b > a for a, b in itertools.pairwise(times))
    assert first == pytest.approx(times[-1] - 60, abs=0.1) and shown["spans"] == []


def test_the_scale_follows_the_last_ten_seconds(page: Page) -> None:
    """All that is shown is within the axis, and takes up a good part of it."""

    def scale() -> tuple[float, float]:
        shown = parts(page)
        seen = [
            value
            for line in shown["lines"]
            for time, value in zip(line["times"], line["values"], strict=True)
            if shown["from"] <= time <= shown["until"]
        ]
        return shown["axes"]["top"], max(seen)

    page.evaluate("onpath.advance(2000)")
    assert scale()[0] == 5  # at least
    page.evaluate("onpath.simulation.pull([0.2, -0.1])")
    page.evaluate("onpath.advance(1500)")
    grown, most = scale()
    assert 60 < most < grown < 2 * most
    assert parts(page)["axes"]["mark"]["value"] == pytest.approx(50)
    page.evaluate("onpath.simulation.pull(null)")
    page.evaluate("onpath.advance(5000)")
    assert scale()[0] == grown  # the pull is still seen
    page.evaluate("onpath.advance(10000)")
    top, most = scale()
    assert most <= top < 0.5 * grown


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
        assert element.inner_text() == f"{1e3 * side['distance']:.1f} mm"
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


def test_going_on_from_the_past_is_the_run_that_would_have_been(page: Page) -> None:
    """Without the hold that came later."""
    page.evaluate("onpath.advance(1000)")
    state = "onpath.simulation.sides.map(side => [...side.logged()])"
    page.evaluate("onpath.advance(1000)")
    expected = page.evaluate(state)
    page.evaluate("onpath.simulation.reset()")
    page.evaluate("onpath.advance(1000)")
    page.evaluate("onpath.simulation.hold(true)")
    page.evaluate("onpath.advance(2000)")
    page.evaluate("onpath.engine.act({do: 'look', at: 1})")
    assert page.get_by_role("button", name=ENGLISH("transport.back")).is_visible()
    page.get_by_role("button", name=ENGLISH("past.go_on")).click()
    page.get_by_role("button", name="Pause").click()
    ticks = page.evaluate("onpath.simulation.ticks")
    assert 1000 <= ticks < 2000
    page.evaluate("ticks => onpath.advance(2000 - ticks)", ticks)
    found = page.evaluate(state)
    np.testing.assert_allclose(found, expected, atol=1e-9)
    assert [each["kind"] for each in parts(page)["spans"]] == []
    assert page.locator(".past:visible").count() == 0


def test_back_to_now_goes_on_as_before(page: Page) -> None:
    page.evaluate("onpath.advance(3000)")
    page.get_by_role("button", name=ENGLISH("run.run"), exact=True).click()
    handle(page).press("PageDown")
    assert page.get_by_role("button", name=ENGLISH("run.run"), exact=True).is_visible()
    page.get_by_role("button", name=ENGLISH("transport.back")).click()
    before = page.evaluate("onpath.simulation.time")
    wait_for(lambda: page.evaluate("onpath.simulation.time") > before, WAIT)


def test_hold_is_one_button_for_short_and_long_presses(page: Page) -> None:
    """Pressed it holds, and pressed again it lets go; kept pressed, it lets go in the end."""
    button = page.get_by_role("button", name=ENGLISH("run.hold_both"))
    button.click()
    assert page.evaluate("onpath.simulation.held")
    page.get_by_role("button", name=ENGLISH("run.let_both_go")).click()
    assert not page.evaluate("onpath.simulation.held")
    box = button.bounding_box()
    assert box
    page.mouse.move(box["x"] + 9, box["y"] + 9)
    page.mouse.down()
    page.wait_for_timeout(1000)  # a long press is one by the clock
    assert page.evaluate("onpath.simulation.held")
    page.mouse.move(5, 5)
    page.mouse.up()
    assert not page.evaluate("onpath.simulation.held")
    button.focus()
    page.keyboard.press("Enter")
    assert page.evaluate("onpath.simulation.held")
    page.keyboard.press(" ")
    assert not page.evaluate("onpath.simulation.held")
    page.keyboard.down(" ")
    page.wait_for_timeout(1000)
    assert page.evaluate("onpath.simulation.held")
    page.keyboard.up(" ")
    assert not page.evaluate("onpath.simulation.held")


def test_buttons_keep_their_places_whatever_they_say(page: Page) -> None:
    places = """() => [...document.querySelectorAll(".transport :is(button, select)")]
        .map(each => each.getBoundingClientRect().toJSON()).filter(each => each.width)"""
    before = page.evaluate(places)
    page.evaluate("onpath.advance(2000)")
    for act in ("{do: 'run', on: true}", "{do: 'hold', on: true}", "{do: 'look', at: 1}"):
        page.evaluate(f"onpath.engine.act({act})")
        page.evaluate(THREE_FRAMES)
        assert page.evaluate(places) == before
    page.evaluate("onpath.engine.act({do: 'hold', on: false})")


def test_time_runs_more_slowly(page: Page) -> None:
    page.get_by_role("combobox", name=ENGLISH("run.rate")).select_option("×0.25")
    assert page.evaluate("onpath.engine.state.rate") == 0.25
    page.get_by_role("combobox", name=ENGLISH("run.rate")).select_option("×1")


def test_the_table_has_what_the_chart_shows(page: Page) -> None:
    page.evaluate(HELD_AND_PULLED)
    page.evaluate(THREE_FRAMES)
    page.get_by_text(ENGLISH("chart.table")).click()
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
    page.get_by_text(ENGLISH("chart.table")).click()


def test_a_lens_shows_what_there_is_to_see_at_each_size_of_error(page: Page) -> None:
    """Everything is within the glass, and small errors are seen from near."""
    steps, used = {1.5, 3, 6, 12, 20}, (set[float](), set[float]())
    view = """i => { const {side, factor, drawn, sheet, scale} = onpath.lenses[i]
        const sample = onpath.engine.present.sides[side]
        return {factor, drawn, scale, width: sheet.width, sample} }"""
    for ticks in (2000, 250, 250, 250, 250, 500):
        page.evaluate(f"onpath.advance({ticks})")
        page.evaluate("onpath.simulation.hold(true)")
        for i in (0, 1):
            wait_for(lambda i=i: _glides_no_more(page, i), WAIT)
            seen = page.evaluate(view, i)
            sample, factor = seen["sample"], seen["factor"]
            assert factor in steps
            used[i].add(factor)
            points = [sample["tip"], sample["closest"], *[p for p in [sample["reference"]] if p]]
            reach = np.linalg.norm(np.ptp(np.array(points), axis=0)) / 2 * factor * seen["scale"]
            assert reach < seen["width"] / 2 or factor == 1.5
    assert used[1] == {20}
    assert min(used[0]) < 20  # while it is torn off; it swings through the path


def _glides_no_more(page: Page, i: int) -> bool:
    return page.evaluate(f"!onpath.lenses[{i}].stale")


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


@pytest.mark.parametrize("size", [75, 99, 144, 184, 256])
def test_letters_in_a_lens_are_whole_and_apart(page: Page, size: int) -> None:
    """Whatever the lens and the force: inside the rim, and off each other and the bar."""
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


@pytest.mark.parametrize(
    "robot",
    [
        robot if robot in SOME else pytest.param(robot, marks=pytest.mark.thorough)
        for robot in onpath.robots()
    ],
)
def test_a_lens_on_every_robot(browser: Browser, tmp_path: Path, robot: str) -> None:
    """Lengths in it are those in space; a link that bends has a straight tip beside its own."""
    page = opened(browser, tmp_path, robot=robot, path="circle")
    page.evaluate("onpath.advance(500)")
    page.evaluate("onpath.simulation.pull([0.02, 0.01])")
    page.evaluate("onpath.advance(400)")
    for side in page.evaluate("onpath.engine.present.sides"):
        tip, closest = np.array(side["tip"]), np.array(side["closest"])
        assert np.linalg.norm(tip - closest) == pytest.approx(side["distance"], abs=1e-9)
        assert side["distance"] > 1e-5 and side["pulled"]
        assert (side["straight"] is not None) == (robot == "flexible")
    if robot == "flexible":
        bent = page.evaluate("onpath.simulation.sides.map(side => side.measured()[0])")
        for side, deflection in zip(
            page.evaluate("onpath.engine.present.sides"), bent, strict=True
        ):
            gap = np.linalg.norm(np.subtract(side["tip"], side["straight"]))
            assert gap == pytest.approx(abs(deflection), rel=0.02) and gap > 1e-5
    shape = page.evaluate("onpath.engine.path")
    front = np.array([shape["right"], shape["up"]])
    np.testing.assert_allclose(front @ front.T, np.eye(2), atol=1e-12)
    page.evaluate(THREE_FRAMES)
    assert page.get_by_role("img", name="magnified").count() == 2
    page.close()


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
