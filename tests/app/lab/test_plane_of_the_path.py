"""b, d and the centre of eq. (23): parameters of the flexible robot, in experiments and the lab."""

from __future__ import annotations

import gc
import weakref

import numpy as np
import pytest

from onpath.app.lab import commands as c
from onpath.app.lab.advance_together import advance_together
from onpath.app.lab.lab import Lab
from onpath.app.lab.setups.capture import capture
from onpath.app.lab.setups.restore import restore
from onpath.app.lab.setups.setup import Setup
from onpath.app.lab.setups.share_code import decode, encode
from onpath.models.arrays import Array
from onpath.models.closed_loop.loop_kind import Kind
from onpath.models.closed_loop.simulation import kernel_of
from onpath.models.studies.experiments import experiments
from onpath.models.studies.experiments import run as run_experiment
from onpath.models.systems.flexible_parameters import FlexibleParameters
from onpath.models.systems.flexible_robot import robot_for
from tests.support.lab import (
    FOLLOWER,
    FRAME,
    assert_sound,
    do,
    new_lab,
    replayed,
    run,
    states,
    take_snapshot,
    y,
)

PLANE = {"b": -0.3, "d": 0.45, "centre": 0.03}
SMALL = 1e-4  # [m]


def off_the_ellipse(points: Array, b: float, d: float, centre: float) -> Array:
    """Distance to y1 = b y2 + d, y2² + (y3 - centre)² = 0.05², from (23) alone, (n,), [m]."""
    angle = np.linspace(-np.pi, np.pi, 4000)
    y2, y3 = 0.05 * np.cos(angle), 0.05 * np.sin(angle) + centre
    ellipse = np.column_stack([b * y2 + d, y2, y3])
    return np.array([np.linalg.norm(ellipse - point, axis=1).min() for point in points])


def flexible(**plane: float) -> Lab:
    lab = new_lab()
    do(lab, c.ChooseRobot("flexible"), *[c.Set(*each) for each in plane.items()])
    assert lab.message_level == "info"
    return lab


def test_an_experiment_follows_the_ellipse_of_its_numbers() -> None:
    values = {"output": "composite", "duration": 2.5, "reverse_at": 0, **PLANE}
    trajectory = run_experiment(experiments()["flexible"].with_values(values), "path_following")
    late = trajectory.t > 2
    distance = off_the_ellipse(trajectory.fields["y"][late][::20], **PLANE)
    assert distance.max() < 4 * SMALL
    np.testing.assert_allclose(trajectory.distance[late][::20], distance, atol=SMALL)


def test_the_experiment_starts_as_far_off_any_plane() -> None:
    usual = experiments()["flexible"]
    moved = usual.with_values(PLANE)
    off = [
        e.robot().frame.lift(e.robot().frame.planar(e.begin())) - e.begin() for e in (usual, moved)
    ]
    np.testing.assert_allclose(off[0], off[1], atol=1e-12)


def test_robots_with_other_planes_share_their_loops_and_last_as_long_as_they_are_used() -> None:
    own = FlexibleParameters(b=-0.31, d=0.45, centre=0.03)
    robot, kind = robot_for(own), Kind("path_following")
    assert robot is robot_for(own) and robot is not robot.core
    assert robot.core is robot_for(FlexibleParameters()) is robot.core.core
    assert kernel_of(robot, kind) is kernel_of(robot.core, kind)
    assert robot.frame.numbers == (-0.31, 0.45, 0.03)
    gone = weakref.ref(robot)
    del robot
    gc.collect()
    assert gone() is None


def test_another_plane_in_the_lab_begins_a_run_there() -> None:
    lab = flexible()
    run(lab, 0.3)
    runs, before = lab.simulation.run_number, take_snapshot(lab, 1.0)
    for name, value in PLANE.items():
        do(lab, c.Set(name, value))
    assert "restarted" in lab.message and lab.simulation.run_number > runs
    assert (
        take_snapshot(lab, 1.0).key != before.key
    )  # the page is built anew: drags are in that plane
    run(lab, 2.5)
    assert_sound(lab)
    way = replayed(lab.simulation)[FOLLOWER].fields["y"][-400::20]
    assert off_the_ellipse(way, **PLANE).max() < 1e-3
    drawn = lab.simulation.robot.output_at(take_snapshot(lab, 1.0, before).path.points)
    assert off_the_ellipse(drawn, **PLANE).max() < SMALL


@pytest.mark.parametrize(("name", "value"), [("d", 0.7), ("centre", 0.2), ("d", np.nan), ("b", 3)])
def test_a_plane_out_of_reach_is_refused_and_changes_nothing(name: str, value: float) -> None:
    lab = flexible(centre=0.15, d=0.6)
    run(lab, 0.2)
    before, robot = states(lab.simulation), lab.simulation.robot
    do(lab, c.Set(name, value))
    assert lab.message and lab.message_level == "warning"
    assert lab.simulation.robot is robot
    for side, state in states(lab.simulation).items():
        np.testing.assert_array_equal(state, before[side])


def test_labs_with_different_planes_run_together_as_alone() -> None:
    together = [flexible(), flexible(**PLANE)]
    alone = [flexible(), flexible(**PLANE)]
    for _ in range(20):
        advance_together([lab.frame(FRAME) for lab in together])
        for lab in alone:
            lab.advance(FRAME)
    for a, b in zip(together, alone, strict=True):
        np.testing.assert_array_equal(y(a.simulation, FOLLOWER), y(b.simulation, FOLLOWER))
        assert a.simulation.runs[FOLLOWER].distance == b.simulation.runs[FOLLOWER].distance
        assert a.simulation.runs[FOLLOWER].max_distance < 5e-3


def test_set_ups_carry_it_wherever_the_lab_was_before() -> None:
    lab = flexible(**PLANE)
    do(lab, c.ChoosePath("ellipse"))
    setup = capture(lab.simulation)
    for other in (new_lab(), flexible(), flexible(d=0.55)):
        restore(other.simulation, decode(encode(setup)))
        assert capture(other.simulation) == setup
        assert other.simulation.robot is lab.simulation.robot
        run(other, 0.2)
        assert_sound(other)
        restore(other.simulation, Setup(robot="flexible"))
        assert other.simulation.robot is other.simulation.robot.core
