"""The chart of distances and the lenses of an exported figure: they show what happens."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import onpath
from onpath.lessons.words import ENGLISH
from onpath.models.systems.catalogue import ROBOTS
from tests.support.node_page import NodePage, needs_node
from tests.support.waiting import wait_for

pytestmark = needs_node
WAIT = 30.0  # [s]
FRAME = 17  # [ms], and as many ticks
SOME = "five_bar", "flexible"  # robots of every run of the tests
SHOW = """async () => {
    const frame = () => new Promise(done => requestAnimationFrame(done))
    const {sheet} = onpath.strip.chart
    resize(sheet.canvas, 800, 160)
    for (const lens of onpath.lenses) resize(lens.sheet.canvas, 144, 144)
    for (let i = 0; i < 3; i++) await frame()
    return {
        spans: onpath.strip.chart.spans,
        axes: onpath.strip.chart.axes,
        from: onpath.strip.chart.from,
        until: onpath.strip.chart.until,
        lines: onpath.strip.chart.lines.map(({name, times, values}) => ({name, times, values})),
        letters: inkOf(sheet.canvas).texts.map(({text}) => text),
    }
}"""
HELD_AND_PULLED = """() => {
    const {simulation, advance} = onpath
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
LENS = """i => {
    const {side, factor, drawn, sheet, scale} = onpath.lenses[i]
    const sample = onpath.engine.present.sides[side]
    return {factor, drawn, scale, width: sheet.width, sample}
}"""


def opened(folder: Path, **more: Any) -> NodePage:
    """A figure that stands still until it is told something."""
    page = NodePage()
    page.goto(onpath.figure(**more).save(folder / "a.html").as_uri())
    wait_for(lambda: page.evaluate("'onpath' in globalThis"), WAIT)
    page.evaluate("onpath.own.plays = false")
    return page


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Iterator[NodePage]:
    page = opened(tmp_path_factory.mktemp("strip"))
    yield page
    assert page.evaluate("complaints") == []
    page.close()


@pytest.fixture
def page(whole: NodePage) -> NodePage:
    whole.evaluate("onpath.simulation.reset()")
    whole.evaluate("onpath.engine.act({do: 'run', on: false})")
    return whole


def shown(page: NodePage) -> Any:
    """What the chart shows now."""
    return page.evaluate(SHOW)


@pytest.mark.thorough
def test_what_acts_is_shaded_and_named_and_each_event_tells_its_own_peak(page: NodePage) -> None:
    page.evaluate(HELD_AND_PULLED)
    chart = shown(page)
    spans = [(each["kind"], each["from"], each["until"]) for each in chart["spans"]]
    assert [each[0] for each in spans] == ["held", "pulled"]
    np.testing.assert_allclose([each[1:] for each in spans], [[1, 2.5], [4, 4.5]], atol=0.02)
    letters = chart["letters"]
    assert {ENGLISH("chart.held"), ENGLISH("chart.pulled")} <= set(letters)
    assert {ENGLISH("chart.centre"), "Trajectory tracking", "Path following"} <= set(letters)
    for line in chart["lines"]:
        times, values = np.array(line["times"]), np.array(line["values"])
        for begin, end in ((1.0, 4.0), (4.0, 5.5)):
            peak = values[(times >= begin - 0.01) & (times < end)].max()
            assert f"{peak:.1f}" in letters, (line["name"], begin)


def test_a_peak_keeps_its_number_until_it_leaves_the_chart(page: NodePage) -> None:
    page.evaluate(HELD_AND_PULLED)
    lines = shown(page)["lines"]
    end = next(i for i, time in enumerate(lines[0]["times"]) if time > 3.9)
    peak = max(lines[0]["values"][:end])
    when = lines[0]["times"][lines[0]["values"].index(peak)]
    for _ in range(12):
        page.evaluate("onpath.advance(500)")
        chart = shown(page)
        assert (f"{peak:.1f}" in chart["letters"]) == (chart["from"] <= when), chart["from"]
    page.evaluate("onpath.advance(62000)")  # longer than what is kept
    chart = shown(page)
    first = page.evaluate("onpath.engine.since(-Infinity)[0].time")
    times = chart["lines"][0]["times"]
    assert times[-1] - times[0] > 59 and all(b > a for a, b in itertools.pairwise(times))
    assert first == pytest.approx(times[-1] - 60, abs=0.1) and chart["spans"] == []


def test_the_scale_follows_the_last_ten_seconds(page: NodePage) -> None:
    """All that is shown is within the axis, and takes up a good part of it."""

    def scale() -> tuple[float, float]:
        chart = shown(page)
        seen = [
            value
            for line in chart["lines"]
            for time, value in zip(line["times"], line["values"], strict=True)
            if chart["from"] <= time <= chart["until"]
        ]
        return chart["axes"]["top"], max(seen)

    page.evaluate("onpath.advance(2000)")
    assert scale()[0] == 5  # at least
    page.evaluate("onpath.simulation.pull([0.2, -0.1])")
    page.evaluate("onpath.advance(1500)")
    grown, most = scale()
    assert 60 < most < grown < 2 * most
    assert shown(page)["axes"]["mark"]["value"] == pytest.approx(50)
    page.evaluate("onpath.simulation.pull(null)")
    page.evaluate("onpath.advance(5000)")
    assert scale()[0] == grown  # the pull is still seen
    page.evaluate("onpath.advance(10000)")
    top, most = scale()
    assert most <= top < 0.5 * grown


def test_going_on_from_the_past_is_the_run_that_would_have_been(page: NodePage) -> None:
    """Without the hold that came later."""
    state = "onpath.simulation.sides.map(side => [...side.logged()])"
    page.evaluate("onpath.advance(2000)")
    expected = page.evaluate(state)
    page.evaluate("onpath.simulation.reset()")
    page.evaluate("onpath.advance(1000)")
    page.evaluate("onpath.simulation.hold(true)")
    page.evaluate("onpath.advance(2000)")
    page.evaluate("onpath.engine.act({do: 'seek', at: 1})")
    assert not page.evaluate("document.querySelector('.transport .past').hidden")
    page.evaluate("onpath.engine.act({do: 'goOn'})")
    page.evaluate("onpath.engine.act({do: 'run', on: false})")
    ticks = page.evaluate("onpath.simulation.ticks")
    assert 1000 - FRAME <= ticks <= 1000  # the last frame that was kept before the hold
    page.evaluate("ticks => onpath.advance(2000 - ticks)", ticks)
    np.testing.assert_allclose(page.evaluate(state), expected, atol=1e-9)
    assert shown(page)["spans"] == []
    assert page.evaluate("document.querySelector('.transport .past').hidden")


@pytest.mark.thorough
def test_a_lens_shows_what_there_is_to_see_at_each_size_of_error(page: NodePage) -> None:
    """Everything is within the glass, and small errors are seen from near."""
    steps, used = {1.5, 3, 6, 12, 20}, (set[float](), set[float]())
    for ticks in (2000, 250, 250, 250, 250, 500):
        page.evaluate(f"onpath.advance({ticks})")
        page.evaluate("onpath.simulation.hold(true)")
        for i in (0, 1):
            stale = f"onpath.lenses[{i}].stale"
            wait_for(lambda stale=stale: shown(page) and not page.evaluate(stale), WAIT)
            seen = page.evaluate(LENS, i)
            sample, factor = seen["sample"], seen["factor"]
            assert factor in steps
            used[i].add(factor)
            points = [sample["tip"], sample["closest"], *[p for p in [sample["reference"]] if p]]
            reach = np.linalg.norm(np.ptp(np.array(points), axis=0)) / 2 * factor * seen["scale"]
            assert reach < seen["width"] / 2 or factor == 1.5
    assert used[1] == {20}
    assert min(used[0]) < 20  # while it is torn off; it swings through the path


@pytest.mark.parametrize(
    "robot",
    [
        robot if robot in SOME else pytest.param(robot, marks=pytest.mark.thorough)
        for robot in onpath.robots()
    ],
)
def test_a_lens_on_every_robot(tmp_path: Path, robot: str) -> None:
    """Lengths in it are those in space; a link that bends has a straight tip beside its own."""
    page = opened(tmp_path, robot=robot, path="circle")
    page.evaluate("onpath.engine.act({do: 'run', on: false})")
    page.evaluate("onpath.advance(500)")
    page.evaluate("onpath.simulation.pull([0.02, 0.01])")
    page.evaluate("onpath.advance(400)")
    sides = page.evaluate("onpath.engine.present.sides")
    bends = ROBOTS[robot].flexible_link is not None
    for side in sides:
        tip, closest = np.array(side["tip"]), np.array(side["closest"])
        assert np.linalg.norm(tip - closest) == pytest.approx(side["distance"], abs=1e-9)
        assert side["distance"] > 1e-5 and side["pulled"]
        assert (side["straight"] is not None) == bends
    if bends:
        bent = page.evaluate("onpath.simulation.sides.map(side => side.measured()[0])")
        for side, deflection in zip(sides, bent, strict=True):
            gap = np.linalg.norm(np.subtract(side["tip"], side["straight"]))
            assert gap == pytest.approx(abs(deflection), rel=0.02) and gap > 1e-5
    shape = page.evaluate("onpath.engine.path")
    front = np.array([shape["right"], shape["up"]])
    np.testing.assert_allclose(front @ front.T, np.eye(2), atol=1e-12)
    assert page.evaluate("complaints") == []
    page.close()
