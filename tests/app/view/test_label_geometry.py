"""Labels stand where the quantities are: an arc turns by its joint angle, and ends at its bar."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import casadi as ca
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.app.view.label_geometry import IN_FRONT, SIDES, axes_of, label_function
from onpath.models.arrays import Array
from onpath.models.robot_files.file_chain import Options
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.rigid_chain import frame_poses
from onpath.models.systems.robot_file import read_robot
from onpath.models.systems.robots import Robot, RobotEntry
from tests.support.drawing import drawn
from tests.support.some_chains import random_arm


def poses(robot: Robot, count: int = 12) -> Array:
    """Configurations with the end-point at places where paths are, (count, n)."""
    z = np.random.default_rng(5).uniform(-0.08, 0.08, (count, 2))
    return robot.rest(robot.frame.lift(z))


def labels(robot: Robot, q: Array) -> tuple[Array, Array]:
    """The lines in a configuration, (n, 2, 3), and the ends of the bars."""
    ends = drawn(robot.skeleton, q, 1.0)[0].reshape(-1, 3)
    found = label_function(robot, len(ends) // 2)
    points = np.array(found.function(ends.T, robot.position(robot.endpoint(q)))).T
    return points[len(found.names) :].reshape(-1, 2, 3), ends


def turned(line: Array, centre: Array) -> float:
    """Angle by which the pieces of an arc turn about its centre, [rad]."""
    rays = [line[0, 0] - centre, *(line[:, 1] - centre)]
    steps = [np.dot(a, b) / np.linalg.norm(a) / np.linalg.norm(b) for a, b in pairwise(rays)]
    return float(np.arccos(np.clip(steps, -1.0, 1.0)).sum())


@settings(max_examples=3)
@given(entry=st.sampled_from(list(ROBOTS.values())))
def test_arcs_turn_by_the_joint_angles_that_they_name(entry: RobotEntry) -> None:
    robot = entry.make(entry.parameters())
    count = len(robot.drawing.angles)
    for q in poses(robot):
        lines, _ = labels(robot, q)
        begin = 0
        for number, name in enumerate(coordinates(robot)):
            arc, centre = lines[begin : begin + SIDES], lines[begin + SIDES, 0]
            joint = joint_names(robot).index(name)
            assert turned(arc, centre) == pytest.approx(abs(q[joint]), abs=1e-6)
            begin += SIDES + (1 if number < count else 2)  # a waist has a line at either end
        assert begin == len(lines)


def joint_names(robot: Robot) -> list[str]:
    """The name of each coordinate: φ for phi_rad, q₁ for q1_rad."""
    heads = [name.partition("_")[0] for name in robot.system.coordinate_names]
    return [{"phi": "φ", "q1": "q₁", "q2": "q₂", "q3": "q₃"}.get(head, head) for head in heads]


def coordinates(robot: Robot) -> list[str]:
    """Names of the angles, in the order in which they are drawn."""
    drawing = robot.drawing
    waist = [] if drawing.waist is None else [drawing.waist.name]
    return [*(angle.name for angle in drawing.angles), *waist]


@settings(max_examples=3)
@given(entry=st.sampled_from(list(ROBOTS.values())))
def test_an_arc_ends_at_its_bar(entry: RobotEntry) -> None:
    robot = entry.make(entry.parameters())
    for q in poses(robot):
        lines, ends = labels(robot, q)
        for number, angle in enumerate(robot.drawing.angles):
            begin = number * (SIDES + 1)
            centre, end = lines[begin + SIDES, 0], lines[begin + SIDES - 1, 1]
            along = ends[2 * angle.bar + 1] - ends[2 * angle.bar]
            ray = (end - centre) / np.linalg.norm(end - centre)
            assert ray @ along / np.linalg.norm(along) == pytest.approx(1.0, abs=1e-6)


@settings(max_examples=3)
@given(entry=st.sampled_from(list(ROBOTS.values())))
def test_every_joint_is_named_and_lengths_do_not_change(entry: RobotEntry) -> None:
    robot = entry.make(entry.parameters())
    names = zip(joint_names(robot), robot.system.coordinate_names, strict=True)
    joints = [short for short, name in names if "rad" in name]
    if robot.chain is not None:  # its axes point anywhere: they have names, and no arcs
        joints = []
    assert sorted(coordinates(robot)) == joints
    each = [labels(robot, q)[1] for q in poses(robot)]
    for length in robot.drawing.lengths:
        sizes = [np.linalg.norm(ends[length.end] - ends[length.begin]) for ends in each]
        assert np.ptp(sizes) < 1e-9


@pytest.mark.parametrize("text", ["planar_arm", "seven_axes", "random"])
def test_the_name_of_every_joint_of_a_chain_stands_before_it(text: str, tmp_path: Path) -> None:
    """In the random one, two axes meet, and one joint slides."""
    if text == "random":
        file = tmp_path / "arm.urdf"
        file.write_text(random_arm(4), "utf-8")
        entry = read_robot(file, Options()).entry
    else:
        entry = ROBOTS[text]
    robot = entry.make(entry.parameters())
    chain = robot.chain
    assert chain is not None
    q = robot.rest(robot.frame.lift(np.array([[0.01, 0.02], [-0.02, 0.01]])))
    symbols = ca.SX.sym("q", chain.n)
    places = ca.Function("origins", [symbols], [frame_poses(chain, symbols)[0]])
    for each in q:
        ends = drawn(robot.skeleton, each, 1.0)[0].reshape(-1, 3)
        found = label_function(robot, len(ends) // 2)
        points = np.array(found.function(ends.T, robot.position(robot.endpoint(each)))).T
        at = dict(zip(found.names, points, strict=False))
        assert ", ".join(found.names).split(", ") == [f"q{'₁₂₃₄₅₆₇'[i]}" for i in range(chain.n)]
        for i, origin in enumerate(places(each).full().T):
            (name,) = (name for name in at if f"q{'₁₂₃₄₅₆₇'[i]}" in name)
            assert at[name] == pytest.approx(origin + [0, -IN_FRONT * robot.reach, 0], abs=1e-12)


@settings(max_examples=3)
@given(entry=st.sampled_from(list(ROBOTS.values())))
def test_axes_begin_where_the_output_is_0_and_point_where_it_grows(entry: RobotEntry) -> None:
    robot = entry.make(entry.parameters())
    for number, (begin, end) in enumerate(axes_of(robot)):
        y = robot.output_at(np.array([begin, end]))
        assert np.allclose(y[0], 0.0)
        assert y[1] == pytest.approx(y[1][number] * np.eye(robot.system.p)[number])
        assert y[1][number] > 0
