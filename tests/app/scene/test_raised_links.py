"""Links between the strokes of a drawing are dashed, and no part of what is drawn."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.app.lab.commands.path import FollowCurve
from onpath.app.lab.snapshots.robot_geometry import geometry_function, path_place, pieces_at
from onpath.app.lab.snapshots.take_snapshot import take_page_snapshot
from onpath.models.paths.space_curves import saddle
from onpath.models.paths.spline_curves import SplineCurve
from onpath.models.paths.spline_fit import spline_through
from onpath.models.systems.catalogue import ROBOTS
from tests.support.drawings import random_drawing
from tests.support.lab import do, new_lab


@pytest.mark.thorough
def test_what_is_drawn_and_the_dashes_are_the_whole_path_and_keep_to_their_places() -> None:
    rng = np.random.default_rng(4)
    strokes = [rng.uniform(-0.04, 0.04, (4, 2)) for _ in range(3)]
    curve, lab = spline_through(strokes), new_lab(0.2)
    do(lab, FollowCurve(curve))
    lab.simulation.editor.advance(1.0)
    path, robot = take_page_snapshot(lab, 1.0).path, lab.simulation.robot
    drawn, dashes = (
        robot.frame.planar(robot.output_at(each)) for each in (path.drawn, path.dashes)
    )
    theta = curve.sample(20_000)
    down = curve.draws(theta)
    on_strokes, on_links = curve.at(theta[down]), curve.at(theta[~down])
    for lines, places in ((drawn, on_strokes), (dashes, on_links)):
        middles = lines.mean(axis=1)
        gaps = np.linalg.norm(middles[:, None] - places, axis=-1).min(axis=1)
        assert gaps.max() < 1e-4
    told = np.linalg.norm(drawn[:, 1] - drawn[:, 0], axis=1).sum()
    steps = np.linalg.norm(np.diff(curve.at(theta), axis=0), axis=1)
    wanted = steps[down[1:]].sum()
    assert abs(told / wanted - 1) < 0.02
    half = np.linalg.norm(dashes[:, 1] - dashes[:, 0], axis=1).sum()
    assert 0.4 < half / steps[~down[1:]].sum() < 0.6


@settings(max_examples=20, deadline=None)
@given(st.integers(0, 99), st.floats(-9, 9), st.booleans(), st.booleans())
def test_the_marker_is_on_the_drawing_at_its_place(
    seed: int, aim: float, closed: bool, rises: bool
) -> None:
    curve = random_drawing(seed, 40, closed=closed)
    curve = saddle(curve, 0.03) if rises else curve
    assert isinstance(curve, SplineCurve)
    d, robot = curve.dimension, ROBOTS["spatial_arm"].make(ROBOTS["spatial_arm"].parameters())
    function, counts = geometry_function(robot, closed, d, spline=True)
    seen = np.tile(np.append(np.zeros(2 * robot.system.p), aim)[:, None], 2)
    inputs = np.zeros((robot.system.n, 2)), seen, pieces_at(curve, [aim, aim]).reshape(2, -1).T
    points = np.array(function(*inputs, 1.0, path_place(robot, d).reshape(d + 1, 3).T))
    middle = 3 * (2 * counts.bars + counts.joints + counts.marks)
    marker = points[middle : middle + 3, 0]
    wanted = robot.position(robot.frame.lift(curve.at(np.array(aim))))
    np.testing.assert_allclose(marker, wanted, atol=1e-12)
