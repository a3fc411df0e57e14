"""A name that is written by hand in the last step of lesson 1, and twice by robots."""

from __future__ import annotations

import io
from collections.abc import Callable
from contextlib import AbstractContextManager

import numpy as np
import pytest

pytest.importorskip("playwright")

from PIL import Image
from playwright.sync_api import Browser

from onpath.app.lab import commands as c
from onpath.app.server.lab_server import LabServer
from onpath.models.paths.spline_curves import SplineCurve
from tests.support.browser import Tab, wait_for

pytestmark = pytest.mark.thorough
TIMETABLE = "01-path-or-timetable"
T = np.linspace(0, 1, 20)
NAME = np.stack([0.1 * T - 0.05 + 0.012 * np.sin(4 * np.pi * T), -0.02 * np.cos(4 * np.pi * T)]).T
"""A joined-up word of two loops, [m]; the page draws a picture for each of its points."""


@pytest.mark.parametrize(("hand", "width", "height"), [("mouse", 1280, 800), ("finger", 390, 844)])
def test_a_name_is_written_by_hand_and_twice_by_robots(
    server: LabServer, browser: Browser, hand: str, width: int, height: int
) -> None:
    context = browser.new_context(
        viewport={"width": width, "height": height}, has_touch=hand == "finger"
    )
    tab = Tab(server, context)
    course = tab.lab.lessons.course
    tab.ask(c.TakeStep(TIMETABLE, len(course.lesson(TIMETABLE, "en").steps) - 1))
    tab.settle()
    tab.press("Draw")
    tab.settle()
    places = tab.line("left", NAME)
    write: Callable[..., AbstractContextManager[object]]
    write = tab.dragging if hand == "mouse" else tab.touching
    with write(*places, in_scene=False):
        pass
    wait_for(lambda: isinstance(tab.simulation.editor.curve, SplineCurve))
    curve = tab.simulation.editor.curve
    assert curve.closed and curve.nearest(NAME)[1].max() < 5e-3

    tab.elapse(1.0)
    tab.press("Hold both back")
    tab.elapse(0.5)
    tab.press("Let both go")
    tab.elapse(1.0)
    with tab.page.expect_download(timeout=60_000) as waiting:
        tab.press("Picture of both lines")
    picture = waiting.value.path().read_bytes()
    assert Image.open(io.BytesIO(picture)).format == "PNG"
    assert tab.errors == []
    tab.close()
    context.close()
