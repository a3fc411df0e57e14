"""The static site shows what happens in the lab, and judges as the lab does."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from onpath.app.exports.site.task_data import check_data, check_words
from onpath.app.lab.dry_runs.step_truth import computed_truth
from onpath.assets import asset_path
from onpath.lessons.checks import verdict, way_of
from onpath.lessons.course import BUILT_IN, read_course
from onpath.lessons.record import Record
from onpath.lessons.sides import robot_names
from onpath.lessons.task_schema import Better, Once, Only, Task, TaskWay
from onpath.lessons.words import ENGLISH, Words
from onpath.models.control.laws.own import OWN, short_name
from onpath.models.control.sides import DEFAULT_LAWS
from onpath.models.paths.path_design import presets
from tests.support.random_records import some_check, some_record
from tests.support.site_export import LESSON, exported_site
from tests.support.site_reader import WAIT, SiteReader
from tests.support.waiting import wait_for

pytestmark = pytest.mark.thorough

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

MILLIMETRE = 1.0
RECORDS = 2000


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return exported_site(tmp_path_factory.mktemp("site"), ("en",))


@pytest.mark.parametrize("step", [2, 8])
def test_what_happens_is_what_happens_in_the_lab(browser: Browser, site: Path, step: int) -> None:
    lesson = read_course([BUILT_IN])[0].lesson(LESSON, "en")
    truth = computed_truth(lesson, step - 1)
    assert truth
    reader = SiteReader(browser, f"{(site / LESSON).as_uri()}.html#{step}")
    reader.ready()
    reader.page.locator("#next").click()  # skips the prediction
    wait_for(lambda: reader.page.evaluate("site.index") == step, WAIT)
    reader.ready()
    reader.press("Let it happen")
    reader.played(10)
    found = reader.page.evaluate(f"site.stage.simulation.curve('{truth.quantity}')")
    for robot in ("tracker", "follower"):
        here = np.interp(truth.times, found["times"], found[robot])
        difference = np.abs(here - np.array(getattr(truth, robot)))
        assert difference.max() < MILLIMETRE and np.median(difference) < 0.01, robot
    reader.context.close()


def test_slow_motion_is_as_slow_as_the_script_says(browser: Browser, site: Path) -> None:
    reader = SiteReader(browser, f"{(site / LESSON).as_uri()}.html#3")
    reader.ready()
    reader.page.locator("#next").click()  # skips the prediction
    reader.press("Let it happen")
    reader.advance(3.0)
    gained, passed = reader.page.evaluate(FRAMES)
    assert 0 < gained < 0.25 * passed + 0.005
    reader.played(6)
    assert reader.page.evaluate("site.stage.figure.engine.rate") == 1
    reader.context.close()


FRAMES = """async () => {
    const now = () => [site.stage.simulation.time, performance.now() / 1e3]
    const frame = () => new Promise(done => requestAnimationFrame(done))
    const before = (await frame(), now())
    for (let i = 0; i < 20; i++) await frame()
    return now().map((each, i) => each - before[i])
}"""
"""Simulated time in 20 frames, and the time of the clock, [s]."""


def test_a_slider_shows_the_number_that_acts(browser: Browser, site: Path) -> None:
    """Also where it is no multiple of the slider's step."""
    reader = SiteReader(browser, f"{(site / LESSON).as_uri()}.html#7", reduced_motion="reduce")
    reader.ready()
    speed = 2 * np.pi
    for _ in range(2):
        shown = reader.page.locator(".step.open .slider", has_text="Speed").inner_text()
        assert f"{speed:.4g}" in shown
        assert reader.page.evaluate("site.stage.simulation.values.speed") == pytest.approx(speed)
        reader.page.evaluate("site.stage.act([{set: {K1: 300}}])")
    reader.context.close()


@pytest.fixture(scope="module")
def judging(browser: Browser) -> Iterator[Page]:
    """A page with no step, so that its script only judges."""
    data = {"words": check_words(ENGLISH), "lesson": "", "figures": [], "lessons": {}}
    parts = '<input id="read"><i id="save"></i><i id="forget"></i><p id="told"></p>'
    page = browser.new_page()
    page.set_content(
        f'{parts}<script type="application/json" id="data">{json.dumps(data)}</script>'
    )
    page.add_script_tag(path=asset_path("web/onpath.js"))
    yield page
    page.close()


JUDGE_ALL = """text => {
    const {cases, words} = JSON.parse(text)
    const nothing = {passed: true, words: ""}  // is left out
    return cases.map(({check, record}) => judge([check], record, words)[0] ?? nothing)
}"""


@pytest.mark.parametrize(("language", "records"), [("en", RECORDS), ("de", RECORDS // 10)])
def test_checks_say_and_decide_what_the_lab_s_do(
    judging: Page, language: str, records: int
) -> None:
    """On thousands of random records, among them ties and bounds that are met exactly."""
    rng, words = np.random.default_rng(20), Words(language)
    cases, expected = list[Any](), list[Any]()
    for _ in range(records):
        record, check = some_record(rng), some_check(rng)
        names = robot_names(record.laws, words)
        data = check_data(check, record.parameters, names, words)
        cases.append({"check": data, "record": as_data(record)})
        found = verdict(check, record, words)
        expected.append({"passed": found.passed, "words": found.words})
    passed = sum(each["passed"] for each in expected)
    assert records / 10 < passed < records * 9 / 10
    for i in range(0, records, 500):
        text = json.dumps({"cases": cases[i : i + 500], "words": check_words(words)})
        assert judging.evaluate(JUDGE_ALL, text) == expected[i : i + 500]


WAYS_OF_ALL = """text => {
    const {cases, words} = JSON.parse(text)
    return cases.map(({ways, record}) => wayOf(ways, record, words))
}"""


def test_a_task_is_passed_in_the_way_that_the_lab_says(judging: Page) -> None:
    rng, cases, expected = np.random.default_rng(21), list[Any](), list[int]()
    for _ in range(RECORDS // 10):
        record = some_record(rng)
        drawn = (some_check(rng) for _ in range(3))
        checks = [each for each in drawn if not isinstance(each, Only | Better | Once)]
        names = robot_names(record.laws, ENGLISH)
        ways = [check_data(check, record.parameters, names, ENGLISH) for check in checks]
        cases.append({"ways": ways, "record": as_data(record)})
        task = Task(id="a", text="", check=(), way=tuple(TaskWay(check, "") for check in checks))
        expected.append(way_of(task, record))
    assert {0, 1, 2} <= set(expected)
    text = json.dumps({"cases": cases, "words": check_words(ENGLISH)})
    assert judging.evaluate(WAYS_OF_ALL, text) == expected


def as_data(record: Record) -> dict[str, Any]:
    """A record as the page keeps one."""
    laws = {side: short_name(law) for side, law in {**DEFAULT_LAWS, **record.laws}.items()}
    gains = {
        name: getattr(record.parameters, name) for name in ("K1", "K2", "task", "encoder_counts")
    }
    path = record.path if record.path in presets() else OWN
    own = {"path": path, "robot": record.robot, "length": record.length()}
    return {
        "times": record.times.tolist(),
        "end": record.end,
        "values": {r: {q: c.tolist() for q, c in own.items()} for r, own in record.values.items()},
        "happenings": [asdict(event) for event in record.happenings],
        "run": record.run,
        "settings": gains | laws | own,
        "changed": list(record.changed()),
    }
