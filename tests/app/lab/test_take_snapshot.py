"""What is shown of a session: the past with the path that it had."""

from __future__ import annotations

import numpy as np
import pytest

from onpath.app.lab import commands as c
from onpath.app.lab.snapshot import Snapshot
from onpath.app.lab.take_snapshot import take_snapshot
from onpath.models.systems.catalogue import ROBOTS
from tests.support.drawing import drawn as drawn_skeleton
from tests.support.lab import FOLLOWER, do, new_session, run


def away(snapshot: Snapshot, name: str = "path_following") -> float:
    """From a robot's end-point to the path that is drawn, [m]."""
    tip, points = snapshot.robots[name].tip, snapshot.path.points
    return float(np.linalg.norm(points - tip, axis=1).min())


def test_looking_back_shows_the_path_of_then() -> None:
    session = new_session()
    run(session, 1.0)
    circle = take_snapshot(session, 1.0)
    do(session, c.ChoosePath("ellipse"))
    run(session, 3.0)
    ellipse = take_snapshot(session, 1.0)
    assert np.abs(circle.path.points - ellipse.path.points).max() > 5e-3
    do(session, c.LookAt(3.5))
    then = take_snapshot(session, 1.0)
    np.testing.assert_array_equal(then.path.points, circle.path.points)
    assert then.path.version != ellipse.path.version
    assert away(then) < 2e-3  # the drawn path is a polygon with sides of 2 mm
    assert not len(then.path.control_points)  # only the present path can be bent
    do(session, c.LookAt(0.0))
    now = take_snapshot(session, 1.0)
    assert now.path.version == ellipse.path.version
    assert len(now.path.control_points) and away(now) < 2e-3


def test_an_instant_is_the_same_object_until_something_changes() -> None:
    session = new_session()
    run(session, 0.5)
    before = session.instant()
    assert session.instant() is before
    do(session, c.SetParameter("K1", 500.0))
    assert session.instant() is not before
    changed = session.instant()
    run(session, 0.1)
    assert session.instant() is not changed
    do(session, c.LookAt(0.3), c.GoOn())
    again = session.instant()
    assert again.time < changed.time + 0.1
    np.testing.assert_allclose(again.sample, session.sample())
    do(session, c.Reset())
    np.testing.assert_allclose(session.instant().sample, session.sample())


@pytest.mark.parametrize("path", ["circle", "clover", "segment"])
@pytest.mark.parametrize("robot", ROBOTS)
def test_points_are_drawn_where_robot_and_curve_have_them(robot: str, path: str) -> None:
    session = new_session()
    do(session, c.ChooseRobot(robot), c.ChoosePath(path))
    run(session, 2.0)
    own, curve = session.robot, session.editor.curve
    tip = own.place(session.runs[FOLLOWER].shown()["y"])
    do(session, c.Grab(FOLLOWER, own.unplace(tip + [0.02, 0.0, 0.01])))
    run(session, 0.1)
    for name, view in take_snapshot(session, 1.0).robots.items():
        row = {field: value.copy() for field, value in session.runs[name].shown().items()}
        aim = row["theta" if name == FOLLOWER else "theta_ref"]
        place, origin = own.place, own.place(np.zeros(own.system.p))
        for drawn, meant in {
            "end": place(row["y"]),
            "marker": place(own.frame.lift(curve.at(aim)[0])),
            "force": place(row["force"]) - origin,
        }.items():
            np.testing.assert_allclose(getattr(view, drawn), meant, rtol=1e-6, atol=1e-12)
        assert np.linalg.norm(view.force) > 0.01
        bars, joints = drawn_skeleton(own.skeleton, session.runs[name].fields()["q"], 1.0)
        np.testing.assert_allclose(view.bars, bars, atol=1e-12)
        np.testing.assert_allclose(view.joints, joints, atol=1e-12)
        np.testing.assert_array_equal(view.tip, view.bars[-1, 1])  # and not where it was a tick ago
        assert np.linalg.norm(view.tip - view.end) < 2e-3
