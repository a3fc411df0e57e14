"""Paths that are refused: said before where that is known, marked as long as a hand drags."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.app.lab import commands as c
from onpath.app.view.paths import remark_on
from onpath.models.paths.path_design import presets
from onpath.models.systems.catalogue import ROBOTS
from tests.support.lab import do, new_lab


def test_the_marks_of_a_drag_that_goes_no_further_go_with_the_hand() -> None:
    lab = new_lab(0.5)
    editor = lab.simulation.editor
    far = editor.points()[0] + [0.1, 0.1]
    do(lab, c.MovePoint(0, far, finished=False))
    assert editor.faults
    do(lab, c.EndMove())
    assert editor.faults == [] and "goes no further" in lab.message


def test_a_user_is_told_how_far_a_path_is_from_the_stroke() -> None:
    lab, corners = new_lab(0.2), 0.05 * np.array([[1, 1], [-1, 1], [-1, -1], [1, -1]])
    ends = zip(corners, np.roll(corners, -1, axis=0), strict=True)
    stroke = np.concatenate([np.linspace(a, b, 60) for a, b in ends])
    do(lab, c.DrawPath(stroke))
    curve = lab.simulation.editor.design.curve
    assert 1e-4 < curve.deviation < 1e-3
    assert f"keeps within {1e3 * curve.deviation:.2g} mm of the drawing" in lab.message


@settings(max_examples=3)
@given(name=st.sampled_from(list(ROBOTS)))
def test_exactly_the_presets_that_are_offered_without_a_warning_can_be_chosen(name: str) -> None:
    lab = new_lab()
    do(lab, c.ChooseRobot(name))
    remarks = {path: remark_on(path, lab.simulation.robot) for path in presets()}
    refused = {path for path, remark in remarks.items() if remark == "design.refused"}
    assert refused < set(presets())
    for path in presets():
        do(lab, c.ChoosePath("circle"), c.ChoosePath(path))
        assert (lab.simulation.editor.design.name == path) is (path not in refused)
        assert ("is refused" in lab.message) is (path in refused)
    assert np.isfinite(lab.simulation.editor.table).all()
