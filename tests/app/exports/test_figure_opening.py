"""What a figure does by itself, and how its address and its reader change that."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from urllib.parse import urlencode

import pytest

import onpath
from tests.support.node_page import NodePage, needs_node
from tests.support.waiting import wait_for

pytestmark = needs_node
PLAYED = """seconds => {
    const {simulation, own, advance} = onpath, holds = []
    let most = 0, from = 0
    for (const end = simulation.time + seconds; simulation.time < end; ) {
        const before = simulation.held
        advance(16)
        own.follow()
        const distance = Math.max(...simulation.sides.map(side => side.distance))
        most = Math.max(most, distance)
        if (simulation.held === before) continue
        if (before) holds.push({from, until: simulation.time, most})
        from = simulation.time
        most = 0
    }
    return holds
}"""
"""Lets time pass, and notes each hold: from when until when, and the largest distance, [m]."""


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    figure = onpath.figure(choices="set_point")
    return figure.save(tmp_path_factory.mktemp("figure") / "a.html")


@pytest.fixture
def page() -> Iterator[NodePage]:
    page = NodePage()
    yield page
    assert page.evaluate("complaints") == []
    page.close()


def opened(page: NodePage, file: Path, **settings: object) -> NodePage:
    """A figure whose time stands still, at an address with settings."""
    page.goto(f"{file.as_uri()}#{urlencode(settings)}")
    wait_for(lambda: page.evaluate("'onpath' in globalThis"), 30.0)
    return page


def test_it_holds_the_robots_until_somebody_else_does_something(page: NodePage, file: Path) -> None:
    holds = opened(page, file).evaluate(PLAYED, 30.0)
    assert len(holds) >= 3
    for hold in holds:
        assert hold["until"] - hold["from"] <= 1.6  # near the peak, before it comes back
        assert hold["most"] > 0.03
    for before, after in pairwise(holds):
        assert after["from"] - before["until"] > 5
    page.evaluate("onpath.settings.set('K1', 900)")
    assert page.evaluate(PLAYED, 20.0) == []


@pytest.mark.parametrize(
    "act",
    [
        "settings.set('K1', 900)",
        "engine.act({do: 'rate', rate: 0.5})",
        "engine.act({do: 'run', on: false})",
        "engine.act({do: 'hold', on: false})",
        "engine.act({do: 'reset'})",
        "simulation.pull([0, 0])",
    ],
)
def test_whoever_does_something_finds_the_robots_free(page: NodePage, file: Path, act: str) -> None:
    opened(page, file)
    while not page.evaluate("onpath.simulation.held"):
        page.evaluate("onpath.advance(16), onpath.own.follow()")
    page.evaluate(f"onpath.{act}, null")
    sides = "onpath.simulation.sides.some(side => side.held)"
    assert not page.evaluate(f"onpath.own.plays || onpath.simulation.held || {sides}")
    assert page.evaluate(PLAYED, 10.0) == []


def test_a_hold_by_the_reader_stays(page: NodePage, file: Path) -> None:
    opened(page, file).evaluate("onpath.engine.act({do: 'hold', on: true})")
    assert page.evaluate(PLAYED, 10.0) == []
    page.evaluate("onpath.settings.set('K1', 900)")
    assert page.evaluate("onpath.simulation.held")


def test_it_begins_with_the_settings_of_its_address(page: NodePage, file: Path) -> None:
    opened(page, file, K1=900, path=1, left=2, speed=1e9, nothing=4)
    values = {n: page.evaluate("n => onpath.settings.value(n)", n) for n in ("K1", "path", "left")}
    assert values == {"K1": 900, "path": 1, "left": 2}
    assert page.evaluate("Math.abs(onpath.settings.value('speed')) < 30")  # not as it asks
    assert page.evaluate(PLAYED, 10.0)  # whoever opens it has not done anything yet
    page.evaluate("onpath.settings.set('K1', 500)")
    kept = "location.hash.includes('K1=500') && !location.hash.includes('nothing')"
    wait_for(lambda: page.evaluate(kept), 10.0)
    # Here alone, a kept hash is an event, too.
    page.evaluate("new Promise(done => setTimeout(done))")
    page.evaluate("onpath.settings.set('K1', 400)")  # as its author has it
    wait_for(lambda: page.evaluate("!location.hash.includes('K1')"), 10.0)
    page.evaluate("(location.hash = '#K1=700&path=1', null)")  # typed into the open tab
    value = "n => onpath.settings.value(n)"
    wait_for(lambda: page.evaluate(value, "K1") == 700, 10.0)
    assert [page.evaluate(value, n) for n in ("path", "left")] == [1, 0]
