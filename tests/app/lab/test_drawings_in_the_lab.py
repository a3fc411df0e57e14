"""A drawing in the lab: run from its beginning, measured at its own stroke, compiled once."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from onpath.app.channel.form_messages import FieldValue
from onpath.app.lab import commands as c
from onpath.app.lab.commands.path import FollowCurve
from onpath.app.lab.lab import Lab
from onpath.app.lab.snapshots.take_snapshot import take_page_snapshot
from onpath.app.view.lab_form import values_in
from onpath.lessons.words import ENGLISH
from onpath.models.control.sides import SIDES
from onpath.models.paths.distance import path_distance
from onpath.models.paths.spline_curves import SplineCurve
from onpath.models.paths.spline_fit import spline_through
from tests.support.lab import FOLLOWER, do, new_lab, run


def values(lab: Lab) -> dict[str, FieldValue]:
    return values_in(take_page_snapshot(lab, 1.0), {}, (), ENGLISH)


def word(seed: int) -> FollowCurve:
    rng = np.random.default_rng(seed)
    strokes = [rng.uniform(-0.04, 0.04, (4, 2)) for _ in range(3)]
    return FollowCurve(spline_through(strokes))


@pytest.mark.thorough
@pytest.mark.parametrize("seed", range(4))
def test_after_an_upload_both_robots_draw_it_from_its_beginning_and_are_on_it_after_a_hold(
    seed: int,
) -> None:
    command, lab = word(seed), new_lab(0.5)
    do(lab, command)
    simulation = lab.simulation
    assert simulation.time == 0.0 and not simulation.editor.faults
    for each in simulation.runs.values():
        assert each.fields()["theta"][0] == pytest.approx(-np.pi, abs=1e-6)
    run(lab, 0.7)
    assert all(each.max_distance < 1e-4 for each in simulation.runs.values())
    do(lab, c.Hold(True))
    run(lab, 0.8)
    for each in simulation.runs.values():
        y = each.shown()["y"][None]
        nearest = path_distance(simulation.robot.frame, simulation.editor.curve, y)[0]
        assert each.distance >= nearest - 1e-7
    do(lab, c.Hold(False))
    run(lab, 8.0)
    assert all(simulation.runs[side].diverged is None for side in SIDES)
    assert all(each.distance < 1e-4 for each in simulation.runs.values())


def test_nothing_is_compiled_for_another_drawing_a_drag_or_a_stroke(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    lab = new_lab(0.2)
    do(lab, word(0))
    run(lab, 0.2)
    made = list[object]()
    cache = lab.simulation._loop_cache
    before = cache._make

    def make(key: Any) -> object:
        made.append(key)
        return before(key)

    monkeypatch.setattr(cache, "_make", make)
    line = np.column_stack([np.linspace(-0.05, 0.05, 50), 0.01 * np.sin(np.arange(50) / 5)])
    for command in (word(1), c.DrawPath(line), word(2)):
        do(lab, command)
        run(lab, 0.1)
        points = lab.simulation.editor.design.points
        do(lab, c.MovePoint(1, points[1] + 1e-3), c.AddPoint(), c.Undo())
        run(lab, 0.5)
    assert made == []


@pytest.mark.thorough
def test_the_speed_along_a_drawing_is_told_as_it_is_run() -> None:
    lab, command = new_lab(0.2), word(3)
    assert values(lab)["pace"] == ""
    do(lab, command)
    curve = command.curve
    assert isinstance(curve, SplineCurve)
    for speed in (3.0, 6.0):
        do(lab, c.Set("speed", speed), c.Reset())
        told, fastest = str(values(lab)["pace"]), 0.0
        for _ in range(round(60 * curve.duration / speed)):
            run(lab, 0.1)
            row = lab.simulation.runs[FOLLOWER].shown()
            if curve.draws(row["theta"])[0]:
                fastest = max(fastest, 1e3 * abs(float(row["speed"][0])))
        said = float(told.removeprefix("Up to ").split(" ")[0])
        assert 0.9 * said < fastest < 1.02 * said
