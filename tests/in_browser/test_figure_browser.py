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
from onpath.models.control.law_poles import channels_of
from onpath.models.control.sides import SIDES
from onpath.models.errors import Message
from onpath.models.paths.curve_faults import ambiguities
from onpath.models.paths.path_design import presets
from tests.support.axe import RUN, SCRIPT, unnamed
from tests.support.browser import THREE_FRAMES
from tests.support.figure_runs import Act
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
SPEEDS = """(() => {
    const [begin, size] = onpath.data.log.v
    return [...onpath.simulation.sides[0].logged().slice(begin, begin + size)]
})()"""
"""Speeds of the first robot's joints in the last row of its log, [rad/s]."""
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


def test_held_back_the_tracker_is_torn_off_and_the_follower_waits(opened: Opened) -> None:
    opened.press("Reset")
    opened.do(("advance", 2000))
    opened.press("Hold both back")
    opened.press("Pause")  # holding lets it run
    opened.do(("advance", 2000))
    tracker, follower = opened.number("onpath.simulation.sides.map(side => side.most)")
    assert tracker > 0.04 and follower < 0.003
    said = opened.page.get_by_role("status")
    wait_for(lambda: "torn off" in said.inner_text() and "waits" in said.inner_text(), WAIT)
    opened.press("Let both go")
    opened.press("Pause")
    opened.do(("advance", 3000))
    assert max(opened.number(DISTANCES)) < 1e-3


def drawn(opened: Opened) -> tuple[list[Array], list[Array]]:
    """The traces of both robots, and their lines in the plot, [px]."""
    strokes = opened.page.evaluate(STROKES)
    colours = [palette.OF_SIDE[side].hex for side in SIDES]
    traces = [np.array(way) for where, alpha, _, way in strokes if where == "seen" and alpha < 1]
    curves = [np.array(way) for where, _, ink, way in strokes if where == "plot" and ink in colours]
    return traces, curves


@pytest.mark.parametrize("frames", [1, 3, 40])
def test_lines_are_as_fine_at_every_frame_rate(opened: Opened, frames: int) -> None:
    opened.do(("choose", 0), ("set", {"speed": 2.0, "K1": 400.0}))
    for _ in range(frames):
        opened.do(("advance", 6000 // frames))
    opened.page.evaluate(THREE_FRAMES)
    traces, curves = drawn(opened)
    assert len(traces) == len(curves) == 2
    scale = opened.number("onpath.views[0].scale")
    for trace in traces:
        chords = np.linalg.norm(np.diff(trace, axis=0), axis=1) / scale
        assert len(trace) > 200 and chords.max() < 0.01  # at 2 rad/s and a radius below 0.1 m
    width = opened.number("document.querySelector('.plot').clientWidth")
    for curve in curves:
        assert np.diff(curve[:, 0]).max() < 1.5 * width / 10 / 60


def test_a_reset_by_the_page_around_begins_the_picture_anew(opened: Opened) -> None:
    opened.do(("choose", 0), ("advance", 3000), ("hold", True))
    opened.page.evaluate(THREE_FRAMES)
    opened.do(("reset", None))
    opened.page.evaluate(THREE_FRAMES)
    assert opened.page.get_by_role("button", name="Hold both back").is_visible()
    opened.do(("advance", 500))
    traces, curves = drawn(opened)
    assert len(curves) == 2 and max(map(len, (*traces, *curves))) < 40
    assert all((np.diff(curve[:, 0]) >= 0).all() for curve in curves)


def test_letters_for_a_choice_do_not_pull(opened: Opened) -> None:
    page = opened.page
    page.get_by_role("combobox", name="Path").focus()
    page.keyboard.down("w")
    assert not opened.number(IS_PULLED)
    page.keyboard.up("w")
    page.get_by_role("slider").first.focus()  # it has no use for letters
    page.keyboard.down("w")
    assert opened.number(IS_PULLED)
    page.get_by_role("combobox", name="Path").focus()
    page.keyboard.up("w")
    assert not opened.number(IS_PULLED)
    opened.do(("choose", 0))


def test_a_pen_drags_a_tip_and_scrolls_elsewhere(opened: Opened) -> None:
    """A pen hovers before it touches, and fires no touch events."""
    opened.do(("choose", 0), ("advance", 100))
    page = opened.page
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


def test_a_tip_is_dragged_with_the_mouse(opened: Opened) -> None:
    opened.do(("choose", 0), ("set", {"speed": 0.0}), ("advance", 500))
    opened.page.evaluate(THREE_FRAMES)
    box = opened.page.locator(".seen > canvas").nth(1).bounding_box()
    assert box
    x, y = opened.number("onpath.views[1].pixel(onpath.simulation.sides[1].tip())")
    mouse = opened.page.mouse
    mouse.move(box["x"] + x, box["y"] + y)
    mouse.down()
    mouse.move(box["x"] + x, box["y"] + y - 30, steps=3)
    opened.do(("advance", 1000))
    pulled = opened.number("onpath.simulation.sides.map(side => side.tip())")
    mouse.up()
    opened.do(("advance", 3000))
    free = opened.number("onpath.simulation.sides.map(side => side.tip())")
    assert all(up[1] > down[1] + 0.001 for up, down in zip(pulled, free, strict=True))


def test_keys_and_names_are_the_lab_s(browser: Browser, tmp_path: Path) -> None:
    opened = Opened(browser, written(tmp_path, Words("de")), width=390)
    page = opened.page
    page.keyboard.press(" ")
    assert not opened.number("onpath.running")
    page.keyboard.press("h")
    assert opened.number("onpath.simulation.held") and opened.number("onpath.running")
    assert page.get_by_role("button", name="Beide loslassen").is_visible()
    typist = page.context.new_cdp_session(page)
    for letter in ("р", "η", "י", "ا", "ㅗ"):  # on the key of H, where another alphabet is written
        held = opened.number("onpath.simulation.held")
        for kind in ("keyDown", "keyUp"):
            typist.send("Input.dispatchKeyEvent", {"type": kind, "key": letter, "code": "KeyH"})
        assert opened.number("onpath.simulation.held") is not held
    for kind, pulled in (("keyDown", True), ("keyUp", False)):
        typist.send("Input.dispatchKeyEvent", {"type": kind, "key": "в", "code": "KeyD"})
        assert opened.number("onpath.simulation.sides.every(side => side.pulled)") is pulled
    typist.send("Input.dispatchKeyEvent", {"type": "keyDown", "key": "'", "code": "KeyH"})
    assert not opened.number("onpath.simulation.held")  # a sign means nothing
    page.keyboard.press("h")
    speed = page.get_by_role("slider", name="Tempo")
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


@pytest.fixture
def phone(browser: Browser, tmp_path: Path) -> Iterator[Page]:
    """A figure on a phone, paused where it begins."""
    context = browser.new_context(viewport={"width": 390, "height": 600}, has_touch=True)
    page = context.new_page()
    page.goto(written(tmp_path).as_uri())
    wait_for(lambda: page.evaluate("'onpath' in window"), WAIT)
    page.get_by_role("button", name="Pause").click()
    page.get_by_role("button", name="Reset").click()
    page.evaluate("scrollTo(0, 0)")
    page.evaluate(THREE_FRAMES)
    yield page
    context.close()


def tip_on(page: Page) -> tuple[float, float]:
    """Where the first robot's end-point is in the window."""
    box = page.locator("canvas").first.bounding_box()
    assert box
    x, y = page.evaluate("onpath.views[0].pixel(onpath.simulation.sides[0].tip())")
    return box["x"] + x, box["y"] + y


def test_a_tip_is_dragged_with_a_finger_and_the_page_still_scrolls(phone: Page) -> None:
    def swiped(x: float, y: float) -> list[Any]:
        """Whether the tip is pulled on the way, and whether the page is scrolled after it."""
        with fingers(phone) as tell:
            tell("touchStart", (x, y))
            for way in range(10, 90, 10):
                tell("touchMove", (x, y - way))
            pulled = phone.evaluate(IS_PULLED)
            tell("touchEnd")
        phone.evaluate(THREE_FRAMES)
        return [pulled, phone.evaluate("scrollY > 0")]

    x, y = tip_on(phone)
    beside = -20  # a place for a finger is at least 44 px wide; the picture ends on the right
    assert swiped(x + beside, y) == [True, False]
    assert not phone.evaluate(IS_PULLED)
    box = phone.locator("canvas").first.bounding_box()
    assert box and swiped(box["x"] + 30, box["y"] + box["height"] - 20) == [False, True]


def test_a_second_finger_neither_pulls_nor_lets_go(phone: Page) -> None:
    x, y = tip_on(phone)
    first, second = (x, y - 40), (x + 15, y + 15)  # the second one is near the tip, too
    with fingers(phone) as tell:
        tell("touchStart", (x, y))
        tell("touchMove", first)
        pulled = phone.evaluate(HAND_TARGET)
        tell("touchStart", first, second)
        tell("touchMove", first, (second[0] + 60, second[1]))
        assert phone.evaluate(HAND_TARGET) == pulled
        tell("touchMove", first)  # the second one is lifted
        assert phone.evaluate(IS_PULLED) and phone.evaluate(HAND_TARGET) == pulled
        tell("touchCancel")
        wait_for(lambda: not phone.evaluate(IS_PULLED), WAIT)


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_axe_finds_nothing_serious(browser: Browser, tmp_path: Path, scheme: Any) -> None:
    context = browser.new_context(bypass_csp=True, color_scheme=scheme)  # it would refuse axe, too
    page = context.new_page()
    page.goto(written(tmp_path).as_uri())
    page.wait_for_function("window.onpath")
    paper = page.evaluate("getComputedStyle(document.documentElement).backgroundColor")
    assert (sum(json.loads(f"[{paper[4:-1]}]")) < 150) == (scheme == "dark")
    page.add_script_tag(path=SCRIPT)
    assert page.evaluate(RUN) == [] and unnamed(page) == []
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


def test_a_path_that_crosses_itself_is_followed_with_the_lab_s_warning(
    browser: Browser, tmp_path: Path
) -> None:
    with pytest.warns(UserWarning, match="crosses itself"):
        file = onpath.figure(path="figure of eight", controls="drag").save(tmp_path / "a.html")
    opened, rng = Opened(browser, file), np.random.default_rng(2)
    design = presets()["figure of eight"]
    assert "crosses itself" in opened.page.locator(".note").inner_text()
    seen = set[str]()
    for index in range(len(design.points)):
        target = design.points[index] + rng.normal(0, 0.006, 2)
        move = f"onpath.simulation.followed.move({index}, {target.tolist()})"
        opened.page.evaluate(f"{move}; onpath.simulation.followed.finish()")
        if opened.number("onpath.simulation.followed.fault") is None:
            design = design.moved(index, target)
            doubts = [each.reason.code for each in ambiguities(design.curve)]
            assert opened.number("onpath.simulation.followed.doubts") == doubts
            seen |= set(doubts)
        else:
            opened.page.reload()
            opened.page.wait_for_function("window.onpath")
            design = presets()["figure of eight"]
    assert seen and opened.complaints == []
    opened.page.close()


def test_a_law_is_chosen_for_each_robot_and_its_poles_are_the_lab_s(
    browser: Browser, tmp_path: Path
) -> None:
    opened = Opened(browser, written(tmp_path))
    page, figure = opened.page, choice()
    channels = channels_of("path_following", figure.parameters)
    assert not isinstance(channels, Message)
    for channel in channels:
        said = ENGLISH.sentence(channel.behaviour()).replace("-", "−")
        poles = channel.pole_words().replace("-", "−")
        assert page.get_by_text(f"{said}; poles {poles} 1/s").is_visible()
    slow = page.get_by_role("slider", name="K5")
    slow.focus()
    slow.press("Home")
    page.get_by_text("not stable").wait_for()
    page.get_by_role("combobox", name="Law, left").select_option(label="Trajectory tracking")
    page.get_by_role("combobox", name="Law, right").select_option(label="Trajectory tracking")
    names = page.locator(".title").all_inner_texts()
    assert [name.strip() for name in names] == [
        "Trajectory tracking, left",
        "Trajectory tracking, right",
    ]
    page.close()


def test_why_a_robot_has_stopped_is_said_as_in_the_lab(browser: Browser, tmp_path: Path) -> None:
    opened = Opened(browser, written(tmp_path))
    opened.press("Pause")
    opened.press("Reset")
    opened.page.evaluate(  # a joint is thrown
        """const {state, kernels} = onpath.simulation.sides[0], {q} = onpath.data.state
        kernels.numbers[state + q[0] + q[1]] = 1e4"""
    )
    opened.do(("advance", 50))
    opened.page.evaluate(THREE_FRAMES)
    said = opened.page.locator(".note").inner_text()
    assert said.startswith("Trajectory tracking stopped at 0.0 s: a joint turns faster than 100")
    assert opened.number("onpath.simulation.sides[1].stopped") == 0
    assert max(map(abs, opened.number(SPEEDS))) < 100  # it is seen as it was before that
    opened.press("Reset")
    opened.page.evaluate(THREE_FRAMES)
    assert opened.page.locator(".note").inner_text() == ""
    opened.page.close()


def test_it_says_that_time_runs_late(browser: Browser, tmp_path: Path) -> None:
    opened = Opened(browser, written(tmp_path))
    note = opened.page.locator(".late")
    opened.page.evaluate(  # every frame takes 0.3 s
        """const {advance} = onpath.simulation
        onpath.simulation.advance = ticks => {
            for (const end = performance.now() + 300; performance.now() < end; );
            advance.call(onpath.simulation, ticks)
        }"""
    )
    wait_for(lambda: "runs late" in note.inner_text(), WAIT)
    opened.page.close()


@pytest.mark.parametrize("words", [ENGLISH, Words("de")], ids=["en", "de"])
def test_nothing_moves_when_time_runs_late(browser: Browser, tmp_path: Path, words: Words) -> None:
    opened = Opened(browser, written(tmp_path, words))
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
    opened.page.close()
