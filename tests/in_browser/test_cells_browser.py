"""A notebook whose cells end with what they show: executed, exported, and opened in Chromium."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING

import nbformat
import pytest

from tests.support.waiting import wait_for

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Frame

pytestmark = pytest.mark.thorough

WAIT = 60.0  # [s]
CELLS = (
    "import onpath\nrun = onpath.simulate(hold=(1, 2), duration=3)\nrun",
    "onpath.figure(path='circle', title='Hold them')",
    "run.figure(title='As recorded')",
    "run.to_csv('run.csv')\nonpath.identify(file='run.csv')",
    "from onpath.models.systems.catalogue import ROBOTS\nROBOTS['planar_arm']",
    "onpath.sweep(K1=[400, 900], hold=(0.1, 0.2), duration=0.3)",
    "onpath.laws()['path_following']",
    "onpath.laws()",
    "onpath.robots()",
    "onpath.parameters()",
)
FIGURES = ("Hold them", "As recorded")


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The notebook as a page, executed by a kernel."""
    file = tmp_path_factory.mktemp("notebook") / "cells.ipynb"
    cells = [nbformat.v4.new_code_cell(text) for text in CELLS]
    nbformat.write(nbformat.v4.new_notebook(cells=cells), file)
    convert = [sys.executable, "-m", "nbconvert", "--log-level=ERROR", "--execute", "--to=html"]
    subprocess.run([*convert, file], check=True)  # fails if a cell does
    return file.with_suffix(".html")


def test_each_cell_shows_more_than_text(browser: Browser, page: Path) -> None:
    opened = browser.new_context(java_script_enabled=False).new_page()
    opened.route("https://**", lambda route: route.abort())  # the exporter's own scripts
    opened.goto(page.as_uri())
    assert opened.locator(".jp-OutputArea-executeResult .jp-RenderedHTML").count() == len(CELLS)
    assert opened.get_by_text("Warning").count() == 0  # such as of a progress bar without widgets
    opened.close()


def test_a_figure_is_live_in_its_cell_and_as_high_as_its_page(browser: Browser, page: Path) -> None:
    opened = browser.new_page()
    opened.route("https://**", lambda route: route.abort())
    opened.goto(page.as_uri())
    for title in FIGURES:
        cell = opened.locator(f"iframe[title='{title}']")
        cell.scroll_into_view_if_needed()
        frame: Frame = cell.element_handle().content_frame()  # type: ignore[assignment]
        wait_for(lambda frame=frame: frame.evaluate("'onpath' in window"), WAIT)
        frame.get_by_role("button", name="Reset", exact=True).click()
        wait_for(lambda frame=frame: frame.evaluate("onpath.simulation.time") > 0.1, WAIT)
        inner = "document.documentElement.getBoundingClientRect().height"
        wait_for(
            lambda frame=frame, cell=cell, inner=inner: (
                abs(frame.evaluate(inner) - cell.evaluate("frame => frame.clientHeight")) <= 1
            ),
            WAIT,
        )
    opened.close()


def test_where_no_script_runs_a_figure_is_its_picture(browser: Browser, page: Path) -> None:
    opened = browser.new_context(java_script_enabled=False).new_page()
    opened.route("https://**", lambda route: route.abort())
    opened.goto(page.as_uri())
    pictures = opened.get_by_alt_text("The robots at their largest distance from the path")
    assert pictures.count() == len(FIGURES)
    for picture in pictures.all():
        assert picture.is_visible()
        box = picture.bounding_box()
        assert box and box["width"] > 300 and box["height"] > 200
    opened.close()
