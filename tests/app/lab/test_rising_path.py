"""Paths that rise above their plane, in the lab and in share codes."""

from __future__ import annotations

import numpy as np
import pytest

from onpath.app.lab import commands as c
from onpath.app.lab.lab import Lab
from onpath.app.lab.setups.capture import capture
from onpath.app.lab.setups.restore import restore
from onpath.app.lab.setups.share_code import decode, encode
from onpath.app.lab.simulation import Simulation
from onpath.app.lab.snapshots.take_snapshot import take_page_snapshot
from onpath.models.paths.space_curves import saddle
from onpath.models.systems.catalogue import FIVE_BAR, ROBOTS
from tests.support.lab import FOLLOWER, assert_drawable, assert_sound, do, loop_cache, run

ARM = ROBOTS["spatial_arm"]


def risen(rise: float, seconds: float = 0.0) -> Lab:
    """A lab with the spatial arm on a circle that rises."""
    lab = Lab(loop_cache(), ARM)
    do(lab, c.Set("rise", rise))
    run(lab, seconds)
    return lab


def test_the_path_rises_and_the_follower_comes_to_it_and_stays() -> None:
    lab = risen(0.03, 3.0)
    assert_sound(lab)
    curve = lab.simulation.editor.curve
    assert np.allclose(
        curve.coefficients, saddle(lab.simulation.editor.design.curve, 0.03).coefficients
    )
    heights = list[float]()
    for _ in range(30):
        run(lab, 1 / 30)
        view = take_page_snapshot(lab, 1.0).robots[FOLLOWER]
        assert view.distance < 1e-4
        heights.append(float(lab.simulation.runs[FOLLOWER].shown()["y"][2]))
    assert min(heights) < -0.028 and max(heights) > 0.028


def test_its_points_are_drawn_on_it_and_edited_in_its_plan_view() -> None:
    lab = risen(0.03, 1.0)
    snapshot = take_page_snapshot(lab, 1.0)
    assert_drawable(snapshot)
    points = ARM.make(ARM.parameters()).output_at(snapshot.path.control_points)
    assert points[:, :2] == pytest.approx(snapshot.edit.points)
    gaps = np.linalg.norm(snapshot.path.points - snapshot.path.control_points[:, None], axis=-1)
    assert gaps.min(axis=1).max() < 2e-3
    place = snapshot.edit.points[0] + [0.01, 0.0]
    do(lab, c.MovePoint(0, place, finished=True))
    run(lab, 1.5)
    assert lab.simulation.editor.curve.dimension == 3
    assert lab.simulation.editor.points()[0] == pytest.approx(place)


def test_it_stays_over_every_path_and_undo_does_not_flatten_it() -> None:
    lab = risen(0.02, 0.5)
    for command in (c.ChoosePath("ellipse"), c.Undo(), c.Redo()):
        do(lab, command)
        run(lab, 1.5)
        assert lab.simulation.editor.rise == lab.simulation.parameters.rise == 0.02  # pyright: ignore
        assert np.ptp(take_page_snapshot(lab, 1.0).path.points[:, 2]) == pytest.approx(0.04, 0.02)
    do(lab, c.Set("rise", 0.0))
    run(lab, 1.5)
    assert lab.simulation.editor.curve.dimension == 2


@pytest.mark.parametrize("rise", [0.2, -1.0, float("nan")])
def test_a_rise_out_of_range_is_refused_and_changes_nothing(rise: float) -> None:
    lab = risen(0.02)
    do(lab, c.Set("rise", rise))
    assert lab.simulation.parameters.rise == lab.simulation.editor.rise == 0.02  # pyright: ignore
    assert lab.notice[1] == "warning"


def test_a_share_code_brings_back_the_path_with_its_rise() -> None:
    lab = risen(-0.035)
    do(lab, c.ChoosePath("ellipse"))
    lab.simulation.editor.advance(10.0)
    setup = capture(lab.simulation)
    again = Simulation(loop_cache())
    restore(again, decode(encode(setup)))
    assert again.entry is ARM and capture(again) == setup
    assert again.editor.rise == -0.035
    assert np.allclose(
        again.editor.curve.coefficients, lab.simulation.editor.curve.coefficients, atol=1e-9
    )


def test_a_robot_that_stays_in_its_plane_has_no_rise() -> None:
    lab = Lab(loop_cache(), FIVE_BAR)
    do(lab, c.Set("rise", 0.02))
    assert lab.simulation.editor.rise == 0.0 and lab.simulation.editor.curve.dimension == 2
    assert lab.message
