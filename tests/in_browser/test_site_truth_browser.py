"""The static site shows what happens in the lab."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest

from onpath.app.lab.dry_runs.step_truth import computed_truth
from onpath.lessons.words import ENGLISH
from tests.support.built_in import built_in_course
from tests.support.site_export import LESSON, exported_site
from tests.support.site_reader import WAIT, SiteReader
from tests.support.waiting import wait_for

pytestmark = pytest.mark.thorough

if TYPE_CHECKING:
    from playwright.sync_api import Browser

MILLIMETRE = 1.0


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return exported_site(tmp_path_factory.mktemp("site"), ("en",))


@pytest.mark.parametrize("step", [2, 8])
def test_what_happens_is_what_happens_in_the_lab(browser: Browser, site: Path, step: int) -> None:
    lesson = built_in_course()[0].lesson(LESSON, "en")
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
    assert 0 < gained < 0.25 * passed + 0.002
    reader.played(6)
    assert reader.page.evaluate("site.stage.figure.engine.rate") == 1
    reader.context.close()


FRAMES = """async () => {
    const {simulation, figure} = site.stage
    const now = () => [simulation.time, figure.engine.last / 1e3]
    const frame = () => new Promise(done => requestAnimationFrame(done))
    const before = (await frame(), now())
    for (let i = 0; i < 20; i++) await frame()
    return now().map((each, i) => each - before[i])
}"""
"""Simulated time in 20 frames, and the time of the clock as the figure has read it, [s]."""


def test_a_slider_shows_the_number_that_acts(browser: Browser, site: Path) -> None:
    """Also where it is no multiple of the slider's step; it stands in the step's card."""
    reader = SiteReader(browser, f"{(site / LESSON).as_uri()}.html#7", reduced_motion="reduce")
    reader.ready()
    speed = 2 * np.pi
    for _ in range(2):
        card = reader.page.get_by_role("group", name=ENGLISH("lesson.controls"))
        shown = card.get_by_role("slider", name="Speed").get_attribute("aria-valuetext")
        assert shown == f"{speed:.2f} rad/s"
        assert reader.page.evaluate("site.stage.simulation.values.speed") == pytest.approx(speed)
        reader.page.evaluate("site.stage.act([{set: {K1: 300}}])")
    reader.context.close()
