"""The form shows the poles of laws whose poles vary along the path, and where they are so."""

from __future__ import annotations

import numpy as np
import pytest

from onpath.app.lab import commands as c
from onpath.app.lab.snapshots.page_snapshot import PageSnapshot, parameters_of
from onpath.app.lab.snapshots.take_snapshot import take_page_snapshot
from onpath.app.view.poles import poles_of
from onpath.lessons.words import Words
from onpath.models.control.sides import LEFT, RIGHT
from tests.support.lab import FRAME, do, new_lab, run

BOTH = c.ChooseLaw(LEFT, "contouring"), c.ChooseLaw(RIGHT, "virtual_constraint")


def taken_after(seconds: float, *commands: c.Command) -> tuple[PageSnapshot, PageSnapshot]:
    """A snapshot, and another one some time later."""
    lab = new_lab(0.5)
    do(lab, *BOTH, c.ChoosePath("ellipse"), *commands)
    run(lab, 1.0)
    first = take_page_snapshot(lab, 1.0)
    run(lab, seconds)
    return first, take_page_snapshot(lab, 1.0, first)


def lines(snapshot: PageSnapshot, words: Words) -> list[str]:
    """What the form says of the poles."""
    laws, places = snapshot.run.laws.items(), snapshot.places.of.items()
    return poles_of(parameters_of(snapshot), tuple(laws), tuple(places), words)[0].split("\n")


@pytest.mark.parametrize("language", ["en", "de"])
def test_each_law_has_its_own_poles_and_the_place_where_they_vary(language: str) -> None:
    words = Words(language)
    snapshot, _ = taken_after(0.0, c.Set("tracker_integral", "on"))
    contour_across, contour_along, wire_across, wire_along = lines(snapshot, words)
    for side, line in ((LEFT, contour_across), (RIGHT, wire_along)):
        degrees = np.degrees(snapshot.places.of[side].theta) % 360
        assert f"θ = {degrees:.0f}°" in line
    for line in (contour_along, wire_across):
        assert "θ" not in line
    assert words("behaviour.free") in wire_along and "⚠" not in wire_along


def test_the_usual_laws_need_no_place() -> None:
    assert take_page_snapshot(new_lab(0.3), 1.0).places.of == {}


def test_the_place_is_read_once_a_second_and_at_once_where_time_stands_still() -> None:
    first, soon = taken_after(20 * FRAME)
    assert soon.places is first.places and soon.time > first.time
    first, late = taken_after(70 * FRAME)
    assert late.places.of[RIGHT].theta != first.places.of[RIGHT].theta
    lab = new_lab(0.5)
    do(lab, *BOTH)
    run(lab, 0.5)
    before = take_page_snapshot(lab, 1.0)
    run(lab, 10 * FRAME)
    do(lab, c.SetRunning(False))
    still = take_page_snapshot(lab, 1.0, before)
    theta = lab.simulation.runs[RIGHT].shown()["theta"][0]
    assert still.places.of[RIGHT].theta == pytest.approx(theta)
    assert take_page_snapshot(lab, 1.0, still).places is still.places


def test_a_change_of_gains_a_law_or_the_path_is_seen_at_once() -> None:
    lab = new_lab(0.3)
    do(lab, *BOTH)
    run(lab, 0.3)
    before = take_page_snapshot(lab, 1.0)
    do(lab, c.ChooseLaw(RIGHT, "path_following"))
    run(lab, FRAME)
    after = take_page_snapshot(lab, 1.0, before)
    assert set(before.places.of) == {LEFT, RIGHT} and set(after.places.of) == {LEFT}
