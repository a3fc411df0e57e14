"""In the lab, a symbol of a lesson's text is lit on the robots by pointing at it, and by keys."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("playwright")

from playwright.sync_api import Browser

from onpath.app.lab import commands as c
from onpath.app.lab.commands import TakeStep
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.lab.plot_samples import sample_layout
from onpath.app.lab.snapshots.take_snapshot import take_motion
from onpath.app.scene.stage_catalogue import stage_of
from onpath.app.server.lab_server import LabServer
from onpath.app.server.server_options import ServerOptions
from onpath.app.view.symbol_geometry import AT_JOINTS, has_meaning, symbol_lines
from onpath.lessons.course import read_course
from onpath.lessons.symbols import SYMBOLS
from onpath.models.arrays import Array
from onpath.models.control.laws.registry import law_named
from onpath.models.systems.catalogue import ROBOTS
from tests.support.browser import Tab, wait_for
from tests.support.drawing import drawn
from tests.support.lesson_texts import LESSON, write_lesson

pytestmark = pytest.mark.thorough
NAME = "01-all-symbols"
SLIDERS = ("K1", "K2", "K5")  # those that the step has
ALL = " ".join(written or f"*{letter}*" for letter, _, written in SYMBOLS.values())
CHANGES = {
    "minutes = 1": f"minutes = 1\nsymbols = {[*SYMBOLS]}",
    "Which one *waits*? Here is $x^2$, and [set K3 to 100](lab:K3=100).": ALL,
    'controls = ["K1", "hold"]': f"controls = {[*SLIDERS]}",
}
NOTES = """
const { clearRect, beginPath, moveTo, lineTo } = CanvasRenderingContext2D.prototype
Object.assign(CanvasRenderingContext2D.prototype, {
    clearRect(...box) { this.canvas.ways = []; return clearRect.apply(this, box) },
    beginPath() { this.canvas.ways?.push([]); return beginPath.apply(this) },
    moveTo(x, y) { this.canvas.ways?.at(-1)?.push([x, y]); return moveTo.call(this, x, y) },
    lineTo(x, y) { this.canvas.ways?.at(-1)?.push([x, y]); return lineTo.call(this, x, y) },
})
"""
"""Notes the lines on each canvas, in its own pixels."""
DRAWN = """() => {
    const canvas = document.querySelector("#op-stage .lit-up")
    const { x, y } = canvas.getBoundingClientRect()
    const ways = (canvas.ways ?? []).filter((_, i) => i % 2)
    return ways.map(way => way.map(each => [each[0] + x, each[1] + y]))
}"""
"""Lines over the robots, in pixels of the window; each is drawn twice, with a rim first."""
GAINS = """() => [...document.querySelectorAll(".field.lit")]
    .filter(each => each.checkVisibility()).map(each => each.dataset.name)"""
NEAR = 3.0  # [px]


@pytest.fixture(scope="module")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[LabServer]:
    home: Path = tmp_path_factory.mktemp("course")
    text = LESSON
    for old, new in CHANGES.items():
        assert old in text
        text = text.replace(old, new)
    write_lesson(home, text, name=NAME)
    course, problems = read_course([home])
    assert problems == []
    server = LabServer("127.0.0.1", 0, LoopCache(), ServerOptions(course=course))
    yield server
    server.stop()


@pytest.fixture(params=[(1366, 768), (390, 844)], ids=["desk", "telephone"])
def tab(request: pytest.FixtureRequest, server: LabServer, browser: Browser) -> Iterator[Tab]:
    width, height = request.param
    context = browser.new_context(viewport={"width": width, "height": height})
    context.add_init_script(NOTES)
    tab = Tab(server, context, draws=False)
    tab.ask(c.OpenLesson(NAME), TakeStep(NAME, 0), c.SetRunning(False))
    tab.wait_until_built()
    yield tab
    assert tab.errors == []
    context.close()


def light(tab: Tab, name: str) -> None:
    """Focus a symbol in the list below the text."""
    summary = tab.page.locator(".step.open .symbols:not([open]) summary")
    if summary.count():
        summary.press("Enter")
    tab.focus(tab.page.locator(f".step.open [data-lights={name}]"))


class Recent:
    """Where everything on one robot was lately, as lines in the window."""

    def __init__(self, tab: Tab, side: str) -> None:
        simulation = tab.simulation
        self.tab, self.side, self.robot = tab, side, simulation.robot
        self.curve = simulation.editor.curve
        layout, i = sample_layout(simulation.robot), list(simulation.runs).index(side)
        _, samples = simulation.history.samples(simulation.time - 3, simulation.time, 1000)
        self.y, force = (samples[:, i, layout.slices[name]] for name in ("y", "force"))
        self.theta, self.reference = (
            samples[:, i, layout.slices[name].start] for name in ("theta", "theta_ref")
        )
        self.q = self.robot.rest(self.y)
        self.pushed = self.y + stage_of(self.robot).force_scale * force
        self.outline = self.curve.at(np.linspace(-np.pi, np.pi, 400))

    def pixels(self, points: Array) -> Array:
        return np.array([self.tab.placed(self.side, each) for each in points])

    def joint(self, length: float | np.floating, angle: Array, at: Array | None = None) -> Array:
        """Points at the end of a link, in the path's plane."""
        rays = length * np.column_stack([np.cos(angle), np.sin(angle)])
        base = self.robot.frame.planar(self.robot.output_at(np.zeros(3)))
        return rays + (base if at is None else at)

    def direction(self, turned: bool) -> Array:
        ahead = self.curve.at(self.theta + 1e-4) - self.curve.at(self.theta - 1e-4)
        ahead /= np.linalg.norm(ahead, axis=1)[:, None]
        return ahead @ np.array([[0, 1], [-1, 0]]) if turned else ahead


def away(point: Array, line: Array) -> float:
    """Distance of a point from a line, [px]."""
    begin, end = line[:-1], line[1:]
    along = end - begin
    size = np.maximum((along**2).sum(axis=1), 1e-12)
    share = np.clip(((point - begin) * along).sum(axis=1) / size, 0, 1)
    return float(np.linalg.norm(begin + share[:, None] * along - point, axis=1).min())


def joints(recent: Recent) -> dict[str, Array]:
    """Places of joints, and ends of arcs, in the path's plane."""
    q_1, q_2 = recent.q.T
    short = np.linalg.norm(drawn(recent.robot.skeleton, recent.q[0], 1.0)[1][2])
    elbow = recent.joint(0.2, q_1)
    to_base, to_tip = np.arctan2(*(recent.joint(0, q_1) - elbow).T[::-1]), q_2 + np.pi
    return {
        "elbow": elbow,
        "short": recent.joint(short, q_2),
        "q_1": recent.joint(0.058, q_1),
        "q_2": recent.joint(0.078, q_2),
        "base": recent.joint(0.05, to_base, elbow),
        "tip": recent.joint(0.05, to_tip, elbow),
    }


def ends_of(symbol: str, recent: Recent, by_clock: bool) -> tuple[Array, Array] | None:
    """Where a symbol's line began and ended lately, in the path's plane; None: it has no line."""
    closest, tied = recent.curve.at(recent.theta), recent.curve.at(recent.theta)
    reference = recent.curve.at(recent.reference)
    if by_clock:
        tied = reference
    if symbol in ("lambda", "xi_1", "d"):
        return closest, recent.y
    if symbol in ("K_1", "K_2"):
        return tied, recent.y
    if symbol == "F":
        return recent.y, recent.pushed
    if symbol == "theta":
        return recent.curve.at(np.zeros(1)), closest
    if symbol in ("N", "T"):
        return closest, closest + 0.03 * recent.direction(symbol == "N")
    if symbol in ("e", "theta_r"):
        begin = reference if symbol == "e" else recent.curve.at(np.zeros(1))
        return (begin, recent.y if symbol == "e" else reference) if by_clock else None
    if symbol in ("K_4", "K_5"):
        return None if by_clock else (recent.y + 0.02 * recent.direction(False), recent.y)
    if symbol == "sigma":
        return recent.outline[:1], recent.outline[-1:]
    if symbol == "rho":
        return recent.joint(0, recent.q[:1, 0]), recent.y
    at = joints(recent)
    if symbol in ("q_1", "q_2"):
        return at["elbow" if symbol == "q_1" else "short"], at[symbol]
    return at["base"], at["tip"]


DESK = pytest.mark.parametrize("tab", [(1366, 768)], indirect=True, ids=["desk"])


@DESK
def test_what_a_symbol_means_is_drawn_where_it_is_while_the_robots_move(tab: Tab) -> None:
    random = np.random.default_rng(41)
    tab.ask(c.Set("rate", 0.25))  # on a busy machine, the history has few rows for a second
    for symbol in SYMBOLS:
        if symbol in ("y", "K_3"):
            continue  # a ring around the end-point; nothing but a slider
        light(tab, symbol)
        since, ahead = tab.simulation.time, random.uniform(0.1, 0.2)
        target = tab.simulation.runs["left"].shown()["y"] + random.uniform(-0.04, 0.04, 2)
        tab.ask(c.Set("copy", True), c.Grab("left", target), c.SetRunning(True))
        wait_for(lambda since=since, ahead=ahead: tab.simulation.time > since + ahead)
        ways = list(map(undotted, drawn_lines(tab)))
        tab.ask(c.SetRunning(False), c.Release("left"))
        for side, run in tab.simulation.runs.items():
            recent = Recent(tab, side)
            ends = ends_of(symbol, recent, law_named(run.law).by_clock)
            if ends is None:
                continue
            begins, lasts = (recent.pixels(np.repeat(each, 2, axis=0)) for each in ends)
            apart = [(away(way[0], begins), away(way[-1], lasts)) for way in ways if len(way) > 1]
            assert min(map(max, apart)) < NEAR, (symbol, side, apart)


@DESK
def test_symbols_of_joints_mean_the_same_on_every_robot_that_has_them(tab: Tab) -> None:
    for name, entry in ROBOTS.items():
        tab.ask(c.ChooseRobot(name), c.SetRunning(False))
        wait_for(lambda entry=entry: tab.simulation.entry is entry)
        tab.wait_until_built()
        robot = tab.simulation.robot
        for symbol in AT_JOINTS:
            sign = tab.page.locator(f":is([data-symbol={symbol}], [data-lights={symbol}])")
            if not has_meaning(symbol, robot):
                wait_for(lambda sign=sign: sign.count() == 0)
                continue
            light(tab, symbol)
            tab.ask(c.StepOnce())
            truth = symbol_lines(symbol, robot, take_motion(tab.lab))
            pixels = [
                np.array([tab.pixel(side, robot.position(each)) for each in points])
                for side, points in zip(tab.simulation.runs, truth, strict=True)
            ]
            wait_for(lambda pixels=pixels: all(map(is_drawn, drawn_lines(tab), pixels)))
            assert len(drawn_lines(tab)) == 2


def drawn_lines(tab: Tab) -> list[Array]:
    return [np.array(way) for way in wait_for(lambda: tab.page.evaluate(DRAWN))]


def undotted(way: Array) -> Array:
    """A line; of a dot, which stands for one that is too short, its middle twice."""
    middle = (way.min(axis=0) + way.max(axis=0)) / 2
    is_dot = len(way) == 25 and np.allclose(np.linalg.norm(way - middle, axis=1), 4, atol=0.1)
    return np.array([middle, middle]) if is_dot else way


def is_drawn(way: Array, pixels: Array) -> bool:
    """Whether a line is that through some points, or a ring around the only one."""
    if len(pixels) == 1:
        return bool(np.abs(np.linalg.norm(way - pixels, axis=1) - 12).max() < NEAR)
    return len(way) == len(pixels) and bool(np.linalg.norm(way - pixels, axis=1).max() < NEAR)


@DESK
def test_the_slider_of_a_gain_is_lit_if_the_step_has_it(tab: Tab) -> None:
    for number in range(1, 6):
        light(tab, f"K_{number}")
        assert tab.page.evaluate(GAINS) == [name for name in SLIDERS if name == f"K{number}"]
    tab.page.keyboard.press("Tab")
    wait_for(lambda: tab.page.evaluate(GAINS) == [])
