"""The wall in a lab, and the direction of a hold: what acts on the robots, and what is kept."""

from __future__ import annotations

import math
from dataclasses import astuple, replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.app.exports.files import csv_bytes
from onpath.app.lab import commands as c
from onpath.app.lab.lab import Lab
from onpath.app.lab.setups.capture import capture
from onpath.app.lab.setups.restore import restore
from onpath.app.lab.setups.setup import Setup
from onpath.app.lab.setups.share_code import decode, encode
from onpath.app.lab.setups.stored import from_data
from onpath.app.lab.snapshots.obstacles import wall_then
from onpath.models.closed_loop.lab_settings import settings_of_wall
from onpath.models.closed_loop.obstacles import DIRECTIONS, FARTHEST, Wall
from onpath.models.control.sides import SIDES
from onpath.models.systems.catalogue import ROBOTS
from tests.support.lab import (
    FOLLOWER,
    TRACKER,
    assert_sound,
    do,
    new_lab,
    replayed,
    run,
    take_snapshot,
    y,
)

SLACK = 1e-9


def walled(seconds: float, wall: Wall, robot: str = "five_bar") -> Lab:
    lab = new_lab()
    do(lab, c.ChooseRobot(robot), c.Set("wall", True))
    do(lab, *[c.Set(name, value) for name, value in settings_of_wall(wall).items()])
    assert lab.simulation.wall is not None
    run(lab, seconds)
    return lab


def depths(lab: Lab, y: np.ndarray) -> np.ndarray:
    """How deep end-points are in the wall, shape (n, p) -> (n,), [m]."""
    wall = lab.simulation.wall
    assert wall is not None
    place, normal = wall.lifted(lab.simulation.robot.frame)
    return (place - y) @ normal


@pytest.mark.thorough
@settings(max_examples=3)
@given(robot=st.sampled_from(list(ROBOTS)))
def test_a_wall_pushes_out_and_nowhere_else(robot: str) -> None:
    """F is along the normal, never inwards, and only where the end-point is in the wall."""
    lab = walled(1.5, Wall(0.0, 0.03, -math.pi / 2), robot)
    _, normal = lab.simulation.wall.lifted(lab.simulation.robot.frame)  # type: ignore[union-attr]
    pushed = 0.0
    for record in replayed(lab.simulation).values():
        force, deep = record.fields["force"], depths(lab, record.fields["y"])
        out = force @ normal
        assert np.abs(force - out[:, None] * normal).max() < SLACK and out.min() >= 0
        assert not out[deep <= 0].any()
        pushed = max(pushed, float(out.max()))
        assert deep.max() < 0.02
    assert pushed > 0.1


@settings(max_examples=25, deadline=None)
@given(st.floats(-0.03, 0.03), st.floats(-0.03, 0.03), st.floats(-3.1, 3.1))
def test_a_wall_that_nobody_reaches_changes_nothing(z1: float, z2: float, angle: float) -> None:
    """A half-plane whose surface is 60 mm from the middle of the circle, solid beyond it."""
    ahead = np.array([math.cos(angle), math.sin(angle)])
    aside = np.array([-ahead[1], ahead[0]])
    z = -0.06 * ahead + (z1 + z2) * aside
    lab, free = walled(0.4, Wall(float(z[0]), float(z[1]), angle)), new_lab(0.4)
    for name in SIDES:
        np.testing.assert_array_equal(y(lab.simulation, name), y(free.simulation, name))


def test_the_follower_waits_at_a_wall_and_the_tracker_goes_round() -> None:
    """A path is not a timetable: the clock drags its robot along the wall, and on behind it."""
    lab = walled(4.0, Wall(0.0, 0.04, -math.pi / 2))
    ways = replayed(lab.simulation)
    theta = {name: np.unwrap(way.fields["theta"][-1500:, 0]) for name, way in ways.items()}
    assert np.ptp(theta[FOLLOWER]) < 0.05 < 2 * math.pi < np.ptp(theta[TRACKER])
    forces = take_snapshot(lab, 1.0).wall_forces
    last = ways[FOLLOWER].fields["force"][-1]
    assert forces[FOLLOWER] == pytest.approx(np.linalg.norm(last), rel=0.02)


def test_it_stands_at_the_same_place_of_both_robots_and_is_drawn_there() -> None:
    lab = walled(0.1, Wall(0.01, 0.02, 0.3))
    robot = lab.simulation.robot
    place, along, normal = take_snapshot(lab, 1.0).wall
    assert place == pytest.approx(robot.position(robot.frame.lift(np.array([0.01, 0.02]))))
    assert normal == pytest.approx([math.cos(0.3), 0, math.sin(0.3)])
    assert abs(along @ normal) < 1e-12 and np.linalg.norm(along) == pytest.approx(1)
    do(lab, c.Set("wall", False))
    assert take_snapshot(lab, 1.0).wall.shape == (0, 3)
    assert take_snapshot(lab, 1.0).wall_forces == {}


@pytest.mark.thorough
@settings(max_examples=3)
@given(robot=st.sampled_from(list(ROBOTS)))
def test_the_drawn_surface_is_where_the_force_begins(robot: str) -> None:
    lab = walled(0.05, Wall(0.01, 0.02, 2.2), robot)
    snapshot, made = take_snapshot(lab, 1.0), lab.simulation.robot
    place, along, _ = snapshot.wall
    points = made.output_at(place + np.linspace(-0.1, 0.1, 5)[:, None] * along)
    assert np.abs(depths(lab, points)).max() < 1e-12
    in_plane = made.frame.lift(made.frame.planar(points))
    assert np.abs(in_plane - points).max() < 1e-12


def test_it_stays_from_run_to_run_and_belongs_to_its_robot() -> None:
    lab = walled(0.2, Wall(0.0, 0.04, 1.0))
    wall = lab.simulation.wall
    do(lab, c.Reset())
    assert lab.simulation.wall == wall and all(
        p.wall for p in lab.simulation.forces.pushes.values()
    )
    do(lab, c.ChooseRobot("flexible"))
    assert lab.simulation.wall is None and not any(
        p.acts for p in lab.simulation.forces.pushes.values()
    )
    do(lab, c.ChooseRobot("five_bar"))
    assert lab.simulation.wall == wall and all(
        p.wall for p in lab.simulation.forces.pushes.values()
    )


def test_hands_and_brakes_come_and_go_and_the_wall_stays() -> None:
    lab = walled(0.2, Wall(0.0, 0.04, -1.5))
    for command in (
        *(c.Hold(True), c.MoveHand(0.01, 0.0), c.Release(), c.Hold(False)),
        *(c.Set("hold_direction", "both"), c.Hold(True), c.MoveHand(0.0, 0.01), c.Hold(False)),
    ):
        do(lab, command)
        run(lab, 0.1)
        assert all(push.wall is not None for push in lab.simulation.forces.pushes.values())
        assert_sound(lab)
    do(lab, c.Release())
    for push in lab.simulation.forces.pushes.values():
        assert push.hand is None and push.hold is None and push.hold_normal is None


def test_mouse_and_keys_move_and_turn_it() -> None:
    lab = new_lab(0.1)
    do(lab, c.NudgeWall(right=0.01))  # there is none: this places one
    first = lab.simulation.wall
    assert first is not None and first.angle == pytest.approx(-math.pi / 2)
    top = lab.simulation.editor.curve.at(lab.simulation.editor.curve.sample())[:, 1].max()
    assert 0 < first.z2 < top
    do(lab, c.NudgeWall(right=0.01, up=-0.004), c.NudgeWall(turn=0.1))
    moved = replace(first, z1=first.z1 + 0.01, z2=first.z2 - 0.004, angle=first.angle + 0.1)
    assert lab.simulation.wall == moved
    do(lab, c.MoveWall(np.array([0.03, 0.0])))
    for end in (1, -1):  # solid where the end's turn to the left is
        do(lab, c.SwingWall(end, np.array([0.03, 0.0]) + end * np.array([0.0, 0.1])))
        assert lab.simulation.wall.normal == pytest.approx([1.0, 0.0], abs=1e-9)  # type: ignore[union-attr]
    do(lab, c.MoveWall(np.array([9.0, -9.0])))
    assert (lab.simulation.wall.z1, lab.simulation.wall.z2) == (FARTHEST, -FARTHEST)  # type: ignore[union-attr]


@pytest.mark.parametrize(
    "bad",
    [
        c.Set("wall_z1", math.nan),
        c.Set("wall_angle", math.inf),
        c.MoveWall(np.array([math.nan, 0.0])),
        c.MoveWall(np.zeros(3)),
        c.SwingWall(1, np.array([math.inf, 0.0])),
        c.NudgeWall(right=math.nan),
        c.Set("hold_direction", "upwards"),
        c.Set("hold_direction", "x" * 10_000),
    ],
    ids=repr,
)
def test_nonsense_is_refused_and_changes_nothing(bad: c.Command) -> None:
    lab = walled(0.1, Wall(0.0, 0.04, 1.0))
    wall = lab.simulation.wall
    do(lab, bad)
    assert lab.message and lab.message_level == "warning"
    assert lab.simulation.wall == wall and lab.simulation.settings.hold_direction == "along"


def test_looking_back_shows_the_wall_of_that_time_and_continuing_uses_the_present_one() -> None:
    lab = walled(0.5, Wall(0.0, 0.04, -1.5))
    then = take_snapshot(lab, 1.0).wall
    do(lab, c.MoveWall(np.array([0.02, 0.035])))
    run(lab, 0.5)
    do(lab, c.Set("wall", False))
    run(lab, 0.5)
    do(lab, c.LookAt(1.2))
    np.testing.assert_allclose(take_snapshot(lab, 1.0).wall, then, atol=1e-12)
    do(lab, c.LookAt(0.7))
    assert take_snapshot(lab, 1.0).wall[0][0] == pytest.approx(then[0][0] + 0.02)
    do(lab, c.GoOn())
    assert lab.simulation.wall is None and not any(
        p.acts for p in lab.simulation.forces.pushes.values()
    )
    do(lab, c.Set("wall", True), c.UndoGoOn())
    assert all(push.wall is not None for push in lab.simulation.forces.pushes.values())


def test_a_film_shows_the_wall_while_it_stands() -> None:
    lab = walled(0.3, Wall(0.0, 0.04, -1.5))
    drawn = take_snapshot(lab, 1.0).wall
    do(lab, c.Set("wall", False))
    run(lab, 0.3)
    history = lab.simulation.history.all()
    np.testing.assert_allclose(wall_then(lab.simulation.robot, history[0]), drawn, atol=1e-12)
    assert not len(wall_then(lab.simulation.robot, history[-1]))


def test_a_table_tells_the_force_of_the_wall() -> None:
    lab = walled(1.5, Wall(0.0, 0.04, -math.pi / 2))
    rows = csv_bytes(lab.simulation.robot, lab.simulation.history.all()).decode().splitlines()
    column = rows[0].split(",").index("force2_N")
    assert min(float(row.split(",")[column]) for row in rows[1:]) < -0.1


# What is kept and sent ---------------------------------------------------------------------------


def test_set_ups_and_share_codes_carry_wall_and_direction() -> None:
    lab = walled(0.1, Wall(0.0123456, -0.04, 2.5))
    do(lab, c.Set("hold_direction", "across"), c.ChooseRobot("flexible"), c.Set("wall", True))
    setup = capture(lab.simulation)
    other = new_lab()
    restore(other.simulation, decode(encode(setup)))
    assert capture(other.simulation) == setup
    assert other.simulation.settings.hold_direction == "across"
    assert other.simulation.wall is not None and lab.simulation.wall is not None
    assert astuple(other.simulation.wall) == pytest.approx(astuple(lab.simulation.wall), rel=1e-5)
    do(other, c.ChooseRobot("five_bar"))
    assert other.simulation.wall == Wall(0.0123456, -0.04, 2.5)
    assert all(push.wall is not None for push in other.simulation.forces.pushes.values())
    restore(other.simulation, Setup())
    assert capture(other.simulation) == Setup()


@pytest.mark.parametrize(
    "wall", [[1.0], [0.1, 0.1], [0.1, 0.1, 9.0], [5.0, 0.0, 0.0], [0.0] * 4, ["x", 0, 0]]
)
def test_a_wall_in_a_code_that_no_lab_has_is_refused(wall: list[Any]) -> None:
    with pytest.raises(ValueError):
        from_data({"defaults": 2, "benches": {"five_bar": {"wall": wall}}})
    with pytest.raises(ValueError):
        from_data({"defaults": 2, "hold": "upwards"})


# The direction of a hold -------------------------------------------------------------------------


@pytest.mark.parametrize("direction", DIRECTIONS)
def test_a_hold_acts_in_the_directions_chosen_and_is_free_in_the_others(direction: str) -> None:
    lab = new_lab()
    do(lab, c.Set("speed", 2.0))
    run(lab, 0.6)
    do(lab, c.Set("hold_direction", direction), c.Hold(True))
    push = lab.simulation.forces.pushes[FOLLOWER]
    assert push.hold is not None
    curve, theta = lab.simulation.editor.curve, lab.simulation.runs[FOLLOWER].shown()["theta"]
    along = curve.at(theta, 1)[0] / np.linalg.norm(curve.at(theta, 1)[0])
    left = np.array([-along[1], along[0]])
    begun = lab.simulation.time
    run(lab, 0.5)
    record = replayed(lab.simulation)[FOLLOWER]
    force = record.fields["force"][record.t > begun + 0.01]
    assert (np.abs(force @ along).max() > 0.3) == (direction != "across")
    assert (
        direction == "both"
        or np.abs(force @ (left if direction == "along" else along)).max() < 1e-9
    )
    moved = np.abs((y(lab.simulation, FOLLOWER) - push.hold[0]) @ np.stack([along, left], axis=1))
    assert (moved[0] < 2e-3) == (direction != "across")
    assert moved[1] < 2e-3 or direction == "along"


def test_another_direction_is_taken_at_once_by_a_hold_that_is_on() -> None:
    lab = new_lab(0.3)
    do(lab, c.Hold(True))
    run(lab, 0.2)
    do(lab, c.Set("hold_direction", "both"))
    assert lab.simulation.forces.held == set(SIDES)
    assert all(push.hold_normal is not None for push in lab.simulation.forces.pushes.values())
