"""A symbol of a robot's joints is drawn where the quantity is: its arc turns by the joint angle."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import casadi as ca
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.app.lab.snapshots.snapshot import Counts, Motion, PageKey, PathSnapshot
from onpath.app.view.symbol_geometry import AT_JOINTS, has_meaning, symbol_lines
from onpath.models.arrays import Array
from onpath.models.paths.path_design import presets
from onpath.models.robot_files.file_chain import Options
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.rigid_chain import frame_poses
from onpath.models.systems.robot_file import read_robot
from onpath.models.systems.robots import Robot, RobotEntry
from tests.support.drawing import drawn
from tests.support.some_chains import random_arm

TWO_LINKS = {"five_bar", "flexible", "two_link_arm", "spatial_arm"}


def meant(symbol: str, robot: Robot, q: Array) -> tuple[Array, Array]:
    """The points of a symbol on a robot in a configuration, and the ends of its bars."""
    ends, joints = (each.reshape(-1, 3) for each in drawn(robot.skeleton, q, 1.0))
    tip = robot.position(robot.endpoint(q))
    counts = Counts(bars=len(ends) // 2, joints=len(joints), marks=0)
    points = np.concatenate([ends, joints, [tip, tip, tip, tip]])
    path = PathSnapshot(
        version=0,
        curve=presets()["circle"].curve,
        points=np.zeros((2, 3)),
        control_points=np.zeros((0, 3)),
        selected=None,
        refused=np.zeros((0, 3)),
    )
    motion = Motion(PageKey(), path, counts, points.reshape(1, -1))
    (line,) = symbol_lines(symbol, robot, motion)
    return robot.position(line), ends


def poses(robot: Robot) -> Array:
    z = np.random.default_rng(7).uniform(-0.06, 0.06, (12, 2))
    return robot.rest(robot.frame.lift(z))


def turned(arc: Array, centre: Array) -> float:
    rays = (arc - centre) / np.linalg.norm(arc - centre, axis=1)[:, None]
    return float(sum(np.arccos(np.clip(a @ b, -1.0, 1.0)) for a, b in pairwise(rays)))


@settings(max_examples=3)
@given(entry=st.sampled_from(list(ROBOTS.values())))
def test_the_arc_of_a_joint_turns_by_its_angle_and_ends_at_its_link(entry: RobotEntry) -> None:
    robot = entry.make(entry.parameters())
    names = [name.partition("_")[0] for name in robot.system.coordinate_names]
    for symbol in ("q_1", "q_2"):
        if not has_meaning(symbol, robot):
            assert symbol.replace("_", "") not in names or "_m" in str(names)
            continue
        place = names.index(symbol.replace("_", ""))
        for q in poses(robot):
            line, ends = meant(symbol, robot, q)
            if robot.chain is not None:
                assert np.abs(ends - line).max(axis=1).min() < 1e-9  # a joint
                continue
            link, centre, *arc = line
            assert turned(np.array(arc), centre) == pytest.approx(abs(q[place]), abs=1e-6)
            ray = (arc[-1] - centre) / np.linalg.norm(arc[-1] - centre)
            assert ray @ (link - centre) == pytest.approx(np.linalg.norm(link - centre))
            if robot.drawing.waist is None or robot.drawing.waist.name != f"q{'₁₂'[place]}":
                assert min(np.abs(ends - link).max(axis=1)) < 1e-9


@settings(max_examples=3)
@given(entry=st.sampled_from(list(ROBOTS.values())))
def test_the_angle_at_the_elbow_is_between_base_and_end_point(entry: RobotEntry) -> None:
    robot = entry.make(entry.parameters())
    assert has_meaning("delta", robot) is has_meaning("rho", robot) is (entry.name in TWO_LINKS)
    if entry.name not in TWO_LINKS:
        return
    for q in poses(robot):
        (base, tip), ends = meant("rho", robot, q)
        assert [*base, *tip] == pytest.approx([*ends[0], *ends[-1]])
        arc, _ = meant("delta", robot, q)
        elbow = ends[1]
        one, two = base - elbow, tip - elbow
        lengths = np.linalg.norm(one) * np.linalg.norm(two)
        assert turned(arc, elbow) == pytest.approx(np.arccos(one @ two / lengths), abs=1e-6)
        for point, ray in ((arc[0], one), (arc[-1], two)):
            assert np.cross(point - elbow, ray) == pytest.approx(np.zeros(3), abs=1e-9)
            assert (point - elbow) @ ray > 0


@pytest.mark.thorough
def test_the_joints_of_a_robot_from_a_file_are_shown(tmp_path: Path) -> None:
    file = tmp_path / "arm.urdf"
    file.write_text(random_arm(4), "utf-8")
    entry = read_robot(file, Options()).entry
    robot = entry.make(entry.parameters())
    assert robot.chain is not None
    assert [name for name in AT_JOINTS if has_meaning(name, robot)] == ["q_1", "q_2"]
    symbols = ca.SX.sym("q", robot.chain.n)
    origins = ca.Function("origins", [symbols], [frame_poses(robot.chain, symbols)[0]])
    for q in robot.rest(robot.frame.lift(np.array([[0.01, 0.02], [-0.02, 0.01]]))):
        for i, symbol in enumerate(("q_1", "q_2")):
            line, _ = meant(symbol, robot, q)
            assert line == pytest.approx(origins(q).full().T[[i]], abs=1e-9)


@pytest.mark.parametrize("name", ROBOTS)
def test_bars_are_told_as_they_are_drawn(name: str) -> None:
    robot = ROBOTS[name].make(ROBOTS[name].parameters())
    for q in poses(robot)[:3]:
        told, ends = meant("bars", robot, q)
        flat = robot.position(robot.output_at(ends))  # of a robot in a plane, in that plane
        np.testing.assert_allclose(told, flat, atol=1e-12)
