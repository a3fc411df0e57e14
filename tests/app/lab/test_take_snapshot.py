"""Snapshots of a simulation show the past with the path of that time."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.app.lab import commands as c
from onpath.app.lab.snapshots.snapshot import Snapshot
from onpath.app.lab.snapshots.take_snapshot import take_page_snapshot as take_snapshot
from onpath.models.control.sides import RIGHT
from onpath.models.systems.catalogue import ROBOTS
from tests.support.drawing import drawn as drawn_skeleton
from tests.support.lab import FOLLOWER, do, new_lab, run


def away(snapshot: Snapshot, name: str = RIGHT) -> float:
    """From a robot's end-point to the path that is drawn, [m]."""
    tip, points = snapshot.robots[name].tip, snapshot.path.points
    return float(np.linalg.norm(points - tip, axis=1).min())


def test_looking_back_shows_the_path_of_that_time() -> None:
    lab = new_lab()
    run(lab, 1.0)
    circle = take_snapshot(lab, 1.0)
    do(lab, c.ChoosePath("ellipse"))
    run(lab, 3.0)
    ellipse = take_snapshot(lab, 1.0)
    assert np.abs(circle.path.points - ellipse.path.points).max() > 5e-3
    do(lab, c.LookAt(3.5))
    then = take_snapshot(lab, 1.0)
    np.testing.assert_array_equal(then.path.points, circle.path.points)
    assert then.path.version != ellipse.path.version
    assert away(then) < 2e-3  # the drawn path is a polygon with sides of 2 mm
    assert not len(then.path.control_points)  # only the present path can be bent
    do(lab, c.LookAt(0.0))
    now = take_snapshot(lab, 1.0)
    assert now.path.version == ellipse.path.version
    assert len(now.path.control_points) and away(now) < 2e-3


def test_an_instant_is_the_same_object_until_something_changes() -> None:
    lab = new_lab()
    run(lab, 0.5)
    before = lab.simulation.instant()
    assert lab.simulation.instant() is before
    do(lab, c.Set("K1", 500.0))
    assert lab.simulation.instant() is not before
    changed = lab.simulation.instant()
    run(lab, 0.1)
    assert lab.simulation.instant() is not changed
    do(lab, c.LookAt(0.3), c.GoOn())
    again = lab.simulation.instant()
    assert again.time < changed.time + 0.1
    np.testing.assert_allclose(again.sample, lab.simulation.sample())
    do(lab, c.Reset())
    np.testing.assert_allclose(lab.simulation.instant().sample, lab.simulation.sample())


@pytest.mark.thorough
@settings(max_examples=5)
@given(robot=st.sampled_from(list(ROBOTS)), path=st.sampled_from(["circle", "clover", "segment"]))
def test_points_are_drawn_where_robot_and_curve_have_them(robot: str, path: str) -> None:
    lab = new_lab()
    do(lab, c.ChooseRobot(robot), c.ChoosePath(path))
    run(lab, 2.0)
    own, curve = lab.simulation.robot, lab.simulation.editor.curve
    tip = own.position(lab.simulation.runs[FOLLOWER].shown()["y"])
    do(lab, c.Grab(FOLLOWER, own.output_at(tip + [0.02, 0.0, 0.01])))
    run(lab, 0.1)
    for name, view in take_snapshot(lab, 1.0).robots.items():
        row = {field: value.copy() for field, value in lab.simulation.runs[name].shown().items()}
        aim = row["theta" if name == FOLLOWER else "theta_ref"]
        place, origin = own.position, own.position(np.zeros(own.system.p))
        for drawn, meant in {
            "end": place(row["y"]),
            "marker": place(own.frame.lift(curve.at(aim)[0])),
            "force": place(row["force"]) - origin,
        }.items():
            np.testing.assert_allclose(getattr(view, drawn), meant, rtol=1e-6, atol=1e-12)
        assert np.linalg.norm(view.force) > 0.01
        bars, joints = drawn_skeleton(own.skeleton, lab.simulation.runs[name].fields()["q"], 1.0)
        np.testing.assert_allclose(view.bars, bars, atol=1e-12)
        np.testing.assert_allclose(view.joints, joints, atol=1e-12)
        np.testing.assert_array_equal(view.tip, view.bars[-1, 1])  # and not where it was a tick ago
        assert np.linalg.norm(view.tip - view.end) < 2e-3
