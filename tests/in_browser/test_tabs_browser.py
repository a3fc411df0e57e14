"""Tests of files that the free lab writes, of several tabs, and of narrow ones."""

from __future__ import annotations

import gc
import io
import weakref
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("playwright")

from playwright.sync_api import Browser, Download, Page, expect

from onpath.models.control.sides import LEFT, RIGHT
from tests.bench.mouse_latency import NO_TRIANGLES
from tests.support.browser import SELDOM, THREE_FRAMES, Tab, wait_for
from tests.support.csv_columns import read_csv
from tests.support.free_lab import fresh

TRACKER, FOLLOWER = LEFT, RIGHT
PLAYED = """seconds => [...document.querySelectorAll("[role=slider]")].some(
    each => each.getAttribute("aria-valuenow") > seconds)"""


def download(tab: Tab, button: str) -> Download:
    tab.more("Keep and share")
    with tab.page.expect_download(timeout=30_000) as waiting:
        tab.button(button).click()
    return waiting.value


def test_exports(tab: Tab) -> None:
    wait_for(lambda: tab.simulation.time > 1.0)
    table = download(tab, "CSV, last 60 s")
    assert table.suggested_filename == "onpath.csv"
    records = read_csv(io.StringIO(Path(table.path()).read_text(encoding="utf-8")))
    assert set(records) == {TRACKER, FOLLOWER}
    for columns in records.values():
        assert len(columns["t_s"]) > 900
        np.testing.assert_allclose(np.diff(columns["t_s"]), 1e-3, atol=1e-9)
        assert np.isfinite(columns["distance_m"]).all()
    picture = download(tab, "Picture of the plots")
    assert Path(picture.path()).read_bytes().startswith(b"\x89PNG\r\n\x1a\n")


@pytest.mark.thorough
def test_a_recording_plays_from_a_file(tab: Tab, browser: Browser, tmp_path: Path) -> None:
    wait_for(lambda: tab.simulation.time > 3.0)  # more than is played below
    film = tmp_path / "film.html"
    download(tab, "Recording (HTML), last 10 s").save_as(film)
    context = fresh(browser)
    context.add_init_script(NO_TRIANGLES + SELDOM)
    plays_without_complaint(context.new_page(), film)
    context.close()


def plays_without_complaint(page: Page, film: Path) -> None:
    complaints: list[str] = []
    page.on("pageerror", lambda error: complaints.append(str(error)))
    page.on("console", lambda said: complaints.append(said.text) if said.type == "error" else None)
    page.goto(film.as_uri())
    page.locator("canvas").first.wait_for()
    page.wait_for_function(PLAYED, arg=1.5)
    assert complaints == []


# Tabs.


def test_a_reload_comes_back_to_the_same_lab(other: Tab) -> None:
    lab = other.lab
    old = weakref.ref(other.display)
    other.enter("K1", "150")
    other.choose("Path", "clover")
    wait_for(
        lambda: (
            lab.simulation.parameters.K1 == 150.0 and lab.simulation.editor.design.name == "clover"
        )
    )
    wait_for(lambda: lab.simulation.time > 0.5)
    before = lab.simulation.time
    other.reload()
    assert other.lab is lab
    assert (lab.simulation.parameters.K1, lab.simulation.editor.design.name) == (150.0, "clover")
    wait_for(lambda: lab.simulation.time > before)
    wait_for(lambda: other.value("K1") == 150.0)
    expect(other.page.get_by_role("radio", name="clover", exact=True)).to_be_checked()
    assert len(other.server.server.get_clients()) == len(other._looked_at())
    wait_for(lambda: gc.collect() >= 0 and old() is None)


def test_another_tab_is_another_lab_that_ends_with_it(tab: Tab) -> None:
    tab.press("Pause")
    wait_for(lambda: not tab.simulation.running)
    clients = len(tab.server.server.get_clients())
    second = Tab(tab.server, tab.page.context, draws=False)
    assert second.lab is not tab.lab
    assert second.simulation.running and not tab.simulation.running
    second.more("Help and keys")
    second.page.get_by_role("dialog").wait_for()
    second.page.keyboard.press("Escape")
    second.page.get_by_role("dialog").wait_for(state="hidden")
    download(second, "CSV, last 60 s")
    left: list[weakref.ref[object]] = [weakref.ref(second.display), weakref.ref(second.client)]
    second.close()
    tab.ask()  # the frame in which it closed has ended
    stopped = second.simulation.time
    for _ in range(20):  # frames
        tab.ask()
    assert second.simulation.time == stopped
    del second.display, second.client
    wait_for(lambda: gc.collect() >= 0 and not [ref for ref in left if ref() is not None])
    assert len(tab.server.server.get_clients()) == clients


def test_hostile_text_is_not_rendered(tab: Tab) -> None:
    """No browser can make the lab show this text, but no code may rely on that."""
    tab.page.evaluate("window.harmed = false")
    tab.lab.show_message("<img src=x onerror='window.harmed = true'><b>bold</b>", "warning")
    tab.page.get_by_role("status").filter(has_text="<b>bold</b>").wait_for()
    tab.page.evaluate("fetch('x').then(reply => reply.text())")  # longer than a picture takes
    tab.page.evaluate(THREE_FRAMES)
    assert tab.page.get_by_role("status").locator("b, img").count() == 0
    assert tab.page.evaluate("window.harmed") is False
    tab.lab.show_message("")
