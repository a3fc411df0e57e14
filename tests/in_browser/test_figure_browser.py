"""A figure's page in Chromium, opened from its file: it moves, and it moves as in Python."""

from __future__ import annotations

import json
import threading
from collections.abc import Iterator
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import onpath
from onpath.app.common import palette
from onpath.app.common.newcomer import NEWCOMER
from onpath.app.exports.standalone.figure_choice import FigureChoice, chosen
from onpath.app.exports.standalone.figure_page import figure_page
from onpath.lessons.words import ENGLISH, Words
from onpath.models.arrays import Array
from onpath.models.control.sides import SIDES
from onpath.models.paths.path_design import presets
from onpath.models.paths.spline_fit import spline_through
from tests.support.axe import RUN, SCRIPT, unnamed
from tests.support.browser import THREE_FRAMES
from tests.support.drawings import letters, star
from tests.support.figure_runs import Act, PythonFigure
from tests.support.fingers import fingers
from tests.support.waiting import wait_for

pytestmark = pytest.mark.thorough

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

WAIT = 60.0  # [s]

LAWS = ("trajectory_tracking", "path_following")
PATHS = ("circle", "clover", "segment")
HAND_TARGET = """(() => {
    onpath.drag()
    const [{figure, kernels, settings}] = onpath.simulation.sides
    return figure.settings.hand_target.map(place => kernels.numbers[settings + place])
})()"""
"""Where a hand pulls the first robot's end-point to."""
IS_PULLED = "onpath.simulation.sides[0].pulled"
REFUSED = """async () => {
    const tried = []
    await new Promise(done => setTimeout(() => {  // what is evaluated by a tool may use eval
        try { eval("1"); tried.push("eval") } catch {}
        done()
    }))
    try { await fetch("https://example.org/"); tried.push("fetch") } catch {}
    const script = document.createElement("script")
    script.textContent = "window.injected = true"
    document.body.append(script)
    const picture = new Image()
    await new Promise(done => {
        picture.onload = () => done(tried.push("picture"))
        picture.onerror = done
        picture.src = "data:image/gif;base64,R0lGODlhAQABAAAAACw="
    })
    return [...tried, ...(window.injected ? ["script"] : [])]
}"""
ACT = """([what, value]) => {
    const {simulation} = onpath
    if (what === "advance") onpath.advance(value)
    else if (what === "move") simulation.followed.move(...value)
    else if (what === "drop") simulation.followed.finish()
    else if (what === "change") simulation.sides[value[0]].change(value[1])
    else simulation[what](value)
}"""
LOGGED = "onpath.simulation.sides.map(side => [...side.logged()])"
DISTANCES = "onpath.simulation.sides.map(side => side.distance)"


TABLE = """(() => {
    const {table, data} = onpath.simulation.followed
    return [...onpath.simulation.kernels.numbers.subarray(table, table + data.table.length)]
})()"""
OTHERS = ("waiting_clock", "set_point")
STROKES = """async () => {
    const {prototype} = CanvasRenderingContext2D
    const {beginPath, lineTo, stroke} = prototype
    const found = []
    let way = []
    prototype.beginPath = function () { way = []; beginPath.call(this) }
    prototype.lineTo = function (...at) { way.push(at); lineTo.apply(this, at) }
    prototype.stroke = function () {
        found.push([this.canvas.parentElement.className, this.globalAlpha, this.strokeStyle, way])
        stroke.call(this)
    }
    onpath.simulation.changed("state")
    await new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))
    Object.assign(prototype, {beginPath, lineTo, stroke})
    return found
}"""
"""What is drawn next: class around the canvas, opacity, colour, and points of each line, [px]."""


def choice(robot: str = "five_bar") -> FigureChoice:
    paths = {name: presets()[name].curve for name in PATHS}
    return chosen(robot, LAWS, paths, NEWCOMER, choices=OTHERS)


class Opened:
    """A figure's page that was opened from a file."""

    def __init__(self, browser: Browser, file: Path, width: int = 900) -> None:
        self.page: Page = browser.new_page(viewport={"width": width, "height": 800})
        self.requests, self.complaints = list[str](), list[str]()
        self.page.on("request", lambda request: self.requests.append(request.url))
        self.page.on("pageerror", lambda error: self.complaints.append(str(error)))
        self.page.on("console", lambda message: self.complaints.append(message.text))
        self.page.goto(file.as_uri())
        # not wait_for_function, which uses eval
        wait_for(lambda: self.page.evaluate("'onpath' in window"), WAIT)

    def number(self, what: str) -> Any:
        return self.page.evaluate(what)

    def press(self, name: str) -> None:
        self.page.get_by_role("button", name=name, exact=True).click()

    def do(self, *acts: Act) -> None:
        for act in acts:
            self.page.evaluate(ACT, list(act))


def written(folder: Path, words: Words = ENGLISH, robot: str = "five_bar") -> Path:
    file = folder / f"{robot}.{words.language}.html"
    file.write_text(figure_page(choice(robot), words), encoding="utf-8")
    return file


@pytest.fixture(scope="module")
def opened(browser: Browser, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Opened]:
    opened = Opened(browser, written(tmp_path_factory.mktemp("figures")))
    opened.press("Pause")
    yield opened
    opened.page.close()


def test_it_moves_by_itself_and_asks_nobody_for_anything(browser: Browser, tmp_path: Path) -> None:
    file = written(tmp_path)
    opened = Opened(browser, file)
    wait_for(lambda: opened.number("onpath.simulation.time") > 0.3, WAIT)
    assert opened.requests == [file.as_uri()]
    assert opened.complaints == []
    assert opened.number(REFUSED) == []  # from now on it complains
    opened.page.close()


def drawn(opened: Opened) -> tuple[list[Array], list[Array]]:
    """The traces of both robots, and their lines in the plot, [px]."""
    strokes = opened.page.evaluate(STROKES)
    colours = [palette.OF_SIDE[side].hex for side in SIDES]
    traces = [np.array(way) for where, alpha, _, way in strokes if where == "seen" and alpha < 1]
    curves = [np.array(way) for where, _, ink, way in strokes if where == "plot" and ink in colours]
    return traces, curves


def test_lines_are_as_fine_at_every_frame_rate_and_begin_anew_with_the_run(opened: Opened) -> None:
    scale = opened.number("onpath.views[0].scale")
    width = opened.number("document.querySelector('.plot').clientWidth")
    for frames in (1, 3, 40):
        opened.do(("choose", 0), ("set", {"speed": 2.0, "K1": 400.0}))
        for _ in range(frames):
            opened.do(("advance", 6000 // frames))
        opened.page.evaluate(THREE_FRAMES)
        traces, curves = drawn(opened)
        assert len(traces) == len(curves) == 2
        for trace in traces:
            chords = np.linalg.norm(np.diff(trace, axis=0), axis=1) / scale
            assert len(trace) > 200 and chords.max() < 0.01  # at 2 rad/s and a radius below 0.1 m
        for curve in curves:
            assert np.diff(curve[:, 0]).max() < 1.5 * width / 10 / 60
    opened.do(("hold", True))
    opened.page.evaluate(THREE_FRAMES)
    opened.do(("reset", None))  # by the page around
    opened.page.evaluate(THREE_FRAMES)
    assert opened.page.get_by_role("button", name="Hold both back").is_visible()
    opened.do(("advance", 500))
    traces, curves = drawn(opened)
    assert len(curves) == 2 and max(map(len, (*traces, *curves))) < 40
    assert all((np.diff(curve[:, 0]) >= 0).all() for curve in curves)


def tip_on(page: Page) -> tuple[float, float]:
    """Where the first robot's end-point is in the window."""
    box = page.locator("canvas").first.bounding_box()
    assert box
    x, y = page.evaluate("onpath.views[0].pixel(onpath.simulation.sides[0].tip())")
    return box["x"] + x, box["y"] + y


def test_a_tip_is_dragged_with_the_mouse_and_with_a_pen(opened: Opened) -> None:
    """A pen hovers before it touches, and fires no touch events; elsewhere, it scrolls."""
    opened.do(("choose", 0), ("set", {"speed": 0.0}), ("advance", 500))
    page = opened.page
    page.evaluate(THREE_FRAMES)
    box = page.locator(".seen > canvas").nth(1).bounding_box()
    assert box
    x, y = opened.number("onpath.views[1].pixel(onpath.simulation.sides[1].tip())")
    page.mouse.move(box["x"] + x, box["y"] + y)
    page.mouse.down()
    page.mouse.move(box["x"] + x, box["y"] + y - 30, steps=3)
    opened.do(("advance", 1000))
    pulled = opened.number("onpath.simulation.sides.map(side => side.tip())")
    page.mouse.up()
    opened.do(("advance", 3000))
    free = opened.number("onpath.simulation.sides.map(side => side.tip())")
    assert all(up[1] > down[1] + 0.001 for up, down in zip(pulled, free, strict=True))

    page.evaluate("scrollTo(0, 0)")
    page.evaluate(THREE_FRAMES)
    session = page.context.new_cdp_session(page)

    def tell(kind: str, x: float, y: float, pressed: int = 0) -> str:
        button = {"button": "left", "buttons": pressed, "clickCount": 1}
        event = {"type": kind, "x": x, "y": y, "pointerType": "pen", **button}
        session.send("Input.dispatchMouseEvent", event)
        return page.evaluate("getComputedStyle(document.querySelector('canvas')).touchAction")

    x, y = tip_on(page)
    box = page.locator("canvas").first.bounding_box()
    assert box
    aside = box["x"] + 5, box["y"] + 5
    assert [tell("mouseMoved", *aside), tell("mouseMoved", x + 9, y)] == ["auto", "none"]
    tell("mousePressed", x + 9, y, pressed=1)
    tell("mouseMoved", x + 9, y - 30, pressed=1)
    page.evaluate(THREE_FRAMES)
    assert opened.number(IS_PULLED)
    tell("mouseReleased", x + 9, y - 30)
    assert not opened.number(IS_PULLED)
    assert tell("mouseMoved", 1, box["y"] + box["height"] + 60) == "auto"
    session.detach()


def test_keys_and_names_are_the_lab_s(browser: Browser, tmp_path: Path) -> None:
    opened = Opened(browser, written(tmp_path, Words("de")), width=390)
    page = opened.page
    page.keyboard.press(" ")
    assert not opened.number("onpath.running")
    page.keyboard.press("h")
    assert opened.number("onpath.simulation.held") and opened.number("onpath.running")
    assert page.get_by_role("button", name="Beide loslassen").is_visible()
    typist = page.context.new_cdp_session(page)
    for kind in ("keyDown", "keyUp"):  # where another alphabet is written
        typist.send("Input.dispatchKeyEvent", {"type": kind, "key": "р", "code": "KeyH"})
    assert not opened.number("onpath.simulation.held")
    for kind, pulled in (("keyDown", True), ("keyUp", False)):
        typist.send("Input.dispatchKeyEvent", {"type": kind, "key": "в", "code": "KeyD"})
        assert opened.number("onpath.simulation.sides.every(side => side.pulled)") is pulled
    page.get_by_role("combobox").first.focus()  # a letter chooses there
    page.keyboard.down("w")
    assert not opened.number(IS_PULLED)
    page.keyboard.up("w")
    speed = page.get_by_role("slider", name="Tempo")
    speed.focus()  # it has no use for letters
    page.keyboard.down("w")
    assert opened.number(IS_PULLED)
    page.get_by_role("combobox").first.focus()
    page.keyboard.up("w")
    assert not opened.number(IS_PULLED)
    speed.focus()
    speed.press("ArrowRight")
    assert opened.number("onpath.simulation.values.speed") == pytest.approx(2.1)
    assert page.locator("html").get_attribute("lang") == "de"
    assert page.evaluate("document.documentElement.scrollWidth") <= 390
    page.close()


def test_what_is_not_chosen_is_not_there(browser: Browser, tmp_path: Path) -> None:
    figure = onpath.figure(law="set_point", controls="hold", sliders=[]).save(tmp_path / "a.html")
    opened = Opened(browser, figure)
    assert opened.page.get_by_role("button").count() == 1
    assert opened.page.get_by_role("button", name="Hold back").is_visible()
    assert opened.page.get_by_role("slider").count() == 0
    assert opened.page.get_by_role("combobox").count() == 0
    assert opened.page.locator("canvas").count() == 2  # the robot, and the lens on it
    opened.page.keyboard.press(" ")
    assert opened.number("onpath.running")
    opened.page.keyboard.press("h")
    assert opened.number("onpath.simulation.held")
    opened.page.close()


def test_inside_an_iframe_of_a_web_server_s_page(browser: Browser, tmp_path: Path) -> None:
    written(tmp_path)
    (tmp_path / "blog.html").write_text("<iframe src=five_bar.en.html width=800 height=700>")
    handler = partial(SimpleHTTPRequestHandler, directory=str(tmp_path))
    with ThreadingHTTPServer(("127.0.0.1", 0), handler) as server:
        threading.Thread(target=server.serve_forever).start()
        page = browser.new_page()
        page.goto(f"http://127.0.0.1:{server.server_port}/blog.html")
        frame = page.frames[1]
        wait_for(lambda: frame.evaluate("window.onpath?.simulation.time ?? 0") > 0.3, WAIT)
        page.close()
        server.shutdown()


def test_a_tip_is_dragged_with_one_finger_and_the_page_still_scrolls(
    browser: Browser, tmp_path: Path
) -> None:
    context = browser.new_context(viewport={"width": 390, "height": 600}, has_touch=True)
    page = context.new_page()
    page.goto(written(tmp_path).as_uri())
    wait_for(lambda: page.evaluate("'onpath' in window"), WAIT)
    page.get_by_role("button", name="Pause").click()
    page.get_by_role("button", name="Reset").click()
    page.evaluate("scrollTo(0, 0)")
    page.evaluate(THREE_FRAMES)

    def swiped(x: float, y: float) -> list[Any]:
        """Whether the tip is pulled on the way, and whether the page is scrolled after it."""
        with fingers(page) as tell:
            tell("touchStart", (x, y))
            for way in range(10, 90, 10):
                tell("touchMove", (x, y - way))
            pulled = page.evaluate(IS_PULLED)
            tell("touchEnd")
        page.evaluate(THREE_FRAMES)
        return [pulled, page.evaluate("scrollY > 0")]

    x, y = tip_on(page)
    first, second = (x, y - 40), (x + 15, y + 15)  # the second finger is near the tip, too
    with fingers(page) as tell:
        tell("touchStart", (x, y))
        tell("touchMove", first)
        pulled = page.evaluate(HAND_TARGET)
        tell("touchStart", first, second)
        tell("touchMove", first, (second[0] + 60, second[1]))
        assert page.evaluate(HAND_TARGET) == pulled
        tell("touchMove", first)  # the second one is lifted
        assert page.evaluate(IS_PULLED) and page.evaluate(HAND_TARGET) == pulled
        tell("touchCancel")
        wait_for(lambda: not page.evaluate(IS_PULLED), WAIT)
    x, y = tip_on(page)
    beside = -20  # a place for a finger is at least 44 px wide; the picture ends on the right
    assert swiped(x + beside, y) == [True, False]
    assert not page.evaluate(IS_PULLED)
    box = page.locator("canvas").first.bounding_box()
    assert box and swiped(box["x"] + 30, box["y"] + box["height"] - 20) == [False, True]
    context.close()


def test_axe_finds_nothing_serious(browser: Browser, tmp_path: Path) -> None:
    context = browser.new_context(bypass_csp=True)  # it would refuse axe, too
    page = context.new_page()
    page.goto(written(tmp_path).as_uri())
    page.wait_for_function("window.onpath")
    page.add_script_tag(path=SCRIPT)
    for scheme in ("light", "dark"):
        page.emulate_media(color_scheme=scheme)
        paper = page.evaluate("getComputedStyle(document.documentElement).backgroundColor")
        assert (sum(json.loads(f"[{paper[4:-1]}]")) < 150) == (scheme == "dark")
        assert page.evaluate(RUN) == [] and unnamed(page) == [], scheme
    context.close()


def spot(opened: Opened, index: int) -> tuple[float, float]:
    """Where a control point of the first robot's picture is in the window."""
    opened.page.evaluate("scrollTo(0, 0)")
    opened.page.evaluate(THREE_FRAMES)
    box = opened.page.locator("canvas").first.bounding_box()
    assert box
    x, y = opened.number(f"onpath.views[0].pixel(onpath.simulation.followed.spots()[{index}])")
    return box["x"] + x, box["y"] + y


def shown(opened: Opened) -> list[list[float]]:
    return opened.number("onpath.simulation.followed.spots()")


def test_a_point_of_the_path_is_dragged_as_far_as_it_goes_and_there_it_is_red(
    browser: Browser, tmp_path: Path
) -> None:
    opened = Opened(browser, written(tmp_path))
    opened.press("Pause")
    opened.press("Reset")
    before, (x, y) = shown(opened), spot(opened, 2)
    mouse, note = opened.page.mouse, opened.page.locator(".note")
    mouse.move(x, y)
    mouse.down()
    mouse.move(x + 3, y + 12, steps=3)
    opened.page.evaluate(THREE_FRAMES)
    moved = shown(opened)
    assert moved[2][1] < before[2][1] - 0.004 and moved[:2] + moved[3:] == before[:2] + before[3:]
    assert opened.number("onpath.simulation.followed.fault") is None
    mouse.move(x, y - 400, steps=3)
    opened.page.evaluate(THREE_FRAMES)
    assert "goes no further" in note.inner_text()
    assert len(opened.number("onpath.simulation.followed.fault.marks")) > 0
    assert moved[2][1] < shown(opened)[2][1]
    mouse.up()
    wait_for(lambda: opened.number(TABLE) != opened.number("onpath.data.paths[0].table"), WAIT)
    assert "goes no further" in opened.page.get_by_role("status").inner_text()
    opened.page.keyboard.press("n")
    assert opened.number("onpath.simulation.selected") == 3
    held = shown(opened)[3]
    opened.page.keyboard.press("ArrowUp")
    opened.page.keyboard.press("ArrowRight")
    by = np.array(shown(opened)[3]) - held
    np.testing.assert_allclose(by, [0.001, 0.001], atol=1e-9)
    assert opened.number("onpath.simulation.ticks") == 0  # right steps with no point selected
    opened.page.keyboard.press("Escape")
    opened.page.keyboard.press("ArrowRight")
    assert opened.number("onpath.simulation.ticks") > 0 and opened.complaints == []
    opened.page.close()


def test_drawings_are_followed_to_the_last_bit_and_bent(browser: Browser, tmp_path: Path) -> None:
    """Chromium's sines are those of the C library."""
    turn = np.linspace(0, 2 * np.pi, 200)[:-1]
    ring = spline_through([0.04 * np.column_stack([np.cos(turn), np.sin(turn)])], closed=True)
    paths = {"letters": letters(), "star": star(), "ring": ring}
    figure = chosen("five_bar", LAWS, paths, NEWCOMER, choices=OTHERS)
    file, python = tmp_path / "drawings.html", PythonFigure(figure)
    file.write_text(figure_page(figure, ENGLISH), encoding="utf-8")
    opened = Opened(browser, file)
    opened.press("Pause")
    acts: list[Act] = [
        ("set", {"speed": 6.0}),
        ("advance", 900),
        ("set", {"speed": -9.0, "K1": 90}),
    ]
    acts += [("advance", 700), ("change", [1, 2]), ("advance", 900)]
    for act in (("choose", 0), *acts, ("choose", 1), *acts):
        opened.do(act)
        python.act(act)
        if act[0] == "advance":
            rows = np.array(opened.number(LOGGED))
            np.testing.assert_array_equal(rows, np.array(python.rows()))
    opened.do(("choose", 0))
    opened.page.evaluate(THREE_FRAMES)
    lines = [(opacity, way) for _, opacity, _, way in opened.page.evaluate(STROKES)]
    assert sum(len(way) > 9 and 0 < opacity < 1 for opacity, way in lines) >= 2 * 2  # of each robot
    opened.do(("choose", 2))
    before, (x, y) = opened.number(TABLE), spot(opened, 2)
    mouse = opened.page.mouse
    mouse.move(x, y)
    mouse.down()
    mouse.move(x + 4, y + 3)
    wait_for(lambda: opened.number(TABLE) != before, WAIT)
    assert opened.number("onpath.simulation.followed.fault") is None
    mouse.move(x, y - 400)
    wait_for(lambda: opened.number("onpath.simulation.followed.fault?.marks.length > 0"), WAIT)
    mouse.up()
    assert opened.complaints == []
    opened.page.close()


def test_it_says_that_time_runs_late_and_nothing_moves_then(
    browser: Browser, tmp_path: Path
) -> None:
    for words in (ENGLISH, Words("de")):
        opened = Opened(browser, written(tmp_path, words))
        assert_nothing_moves(opened)
        opened.page.evaluate("[onpath.engine.lost, onpath.stale] = [0, true]")
        opened.page.evaluate(THREE_FRAMES)
        assert opened.number(LATE) == ""
        opened.page.evaluate(  # every frame takes 0.3 s
            """const {advance} = onpath.simulation
            onpath.simulation.advance = ticks => {
                for (const end = performance.now() + 300; performance.now() < end; );
                advance.call(onpath.simulation, ticks)
            }
            onpath.engine.act({do: 'run', on: true})"""
        )
        wait_for(lambda opened=opened: opened.number(LATE) != "", WAIT)
        opened.page.close()


LATE = "document.querySelector('.late').textContent"


def assert_nothing_moves(opened: Opened) -> None:
    """Assert that everything is where it was when the page says that time runs late."""
    opened.page.evaluate("onpath.engine.act({do: 'run', on: false})")

    def places(lost: float) -> Any:
        opened.page.evaluate("lost => [onpath.engine.lost, onpath.stale] = [lost, true]", lost)
        opened.page.evaluate(THREE_FRAMES)
        return opened.page.evaluate(
            """() => [...document.querySelectorAll("body, body *:not(.late, .live)")].map(each => {
                const {left, top, width, height} = each.getBoundingClientRect()
                return [each.tagName, left, top, width, height]
            })"""
        )

    for width, height in ((1280, 800), (820, 1180), (390, 844), (320, 480)):
        opened.page.set_viewport_size({"width": width, "height": height})
        before = places(0.0)
        assert opened.page.locator(".late").inner_text() == ""
        assert places(1.0) == before
        assert opened.page.evaluate("document.documentElement.scrollWidth") <= width
        assert opened.page.locator(".late").bounding_box()["height"] > 10  # type: ignore[index]
