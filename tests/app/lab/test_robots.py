"""What holds for every robot of the catalogue, and for one that is a single new file."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import casadi as ca
import numpy as np
import pytest

from onpath.app.exports.figures import experiment_figure
from onpath.app.exports.files import csv_bytes, picture_file
from onpath.app.lab import commands as c
from onpath.app.lab.lab import Lab
from onpath.app.lab.setups.capture import capture
from onpath.app.lab.setups.restore import restore
from onpath.app.lab.setups.share_code import decode, encode
from onpath.app.lab.simulation import Simulation
from onpath.app.lab.snapshots.robot_geometry import geometry_function, robot_snapshots
from onpath.app.lab.snapshots.take_snapshot import take_page_snapshot as take_snapshot
from onpath.app.scene.poses import poses_of
from onpath.app.scene.stage_catalogue import stage_of
from onpath.app.view.robot_sketch import robot_sketch
from onpath.app.view.robots import picture_of
from onpath.models.control.settable import specs
from onpath.models.control.sides import DEFAULT_LAWS, LEFT, SIDES
from onpath.models.paths.curve_faults import curve_faults
from onpath.models.paths.path_design import presets
from onpath.models.studies.experiments import experiments, run
from onpath.models.systems import catalogue
from onpath.models.systems.catalogue import FLEXIBLE, ROBOTS
from onpath.models.systems.robots import RobotEntry
from tests.support.lab import FOLLOWER, TRACKER, assert_drawable, assert_sound, do, loop_cache, y
from tests.support.lab import run as run_lab
from tests.support.new_robot import GANTRY, new_robot
from tests.support.overhead_crane import ROBOT as CRANE

NEW = pytest.param(CRANE.name, marks=pytest.mark.thorough)  # five coordinates, three motors
NAMES_OF_ALL = [*ROBOTS, "gantry", NEW]


@pytest.fixture
def gantry(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """A robot that is one more file in the folder of the robots, and nothing else."""
    with new_robot(tmp_path, monkeypatch):
        yield


@pytest.fixture(params=NAMES_OF_ALL)
def entry(
    request: pytest.FixtureRequest, gantry: None, monkeypatch: pytest.MonkeyPatch
) -> RobotEntry:
    monkeypatch.setitem(ROBOTS, CRANE.name, CRANE)
    return ROBOTS[request.param]


def lab_with(entry: RobotEntry, seconds: float = 0.0) -> Lab:
    """As a user comes to it: from the first robot, by the menu."""
    lab = Lab(loop_cache())
    do(lab, c.ChooseRobot(entry.name))
    run_lab(lab, seconds)
    return lab


def off_path(simulation: Simulation, side: str) -> float:
    """How far the controlled output is off the path, [m]."""
    return float(np.abs(simulation.runs[side].shown()["xi"]).max())


def test_the_catalogue_finds_it_by_its_name(entry: RobotEntry) -> None:
    robot = entry.make(entry.parameters())
    assert ROBOTS[robot.name] is entry and robot.system.n == len(robot.system.coordinate_names)
    assert robot.system.m >= robot.system.p == robot.frame.p
    assert entry.make(entry.parameters()) is entry.make(entry.parameters())


def test_two_robots_of_one_name_are_refused(gantry: None, tmp_path: Path) -> None:
    (tmp_path / "other.py").write_text(GANTRY)
    try:
        with pytest.raises(ValueError, match="another robot named 'gantry'"):
            catalogue.found_robots()
    finally:
        sys.modules.pop("onpath.models.systems.other", None)


@pytest.mark.thorough
def test_it_follows_the_circle_in_the_lab_and_waits_when_held(entry: RobotEntry) -> None:
    lab = lab_with(entry, 2.0)
    simulation = lab.simulation
    for name in SIDES:
        assert simulation.runs[name].diverged is None
        assert off_path(simulation, name) < 2e-4
    do(lab, c.Hold(True))
    run_lab(lab, 1.0)
    do(lab, c.Hold(False))
    follower, tracker = (simulation.runs[name] for name in (FOLLOWER, TRACKER))
    assert follower.diverged is None, "stopped while held"
    if tracker.diverged is None:
        assert follower.max_distance < tracker.max_distance / 3
    run_lab(lab, 0.5)
    assert_sound(lab)


@pytest.mark.thorough
def test_a_pull_moves_it_and_it_comes_back(entry: RobotEntry) -> None:
    lab = lab_with(entry, 0.5)
    simulation = lab.simulation
    target = simulation.robot.position(y(simulation, FOLLOWER) + 0.01)
    do(lab, c.Grab(FOLLOWER, target))
    run_lab(lab, 0.5)
    assert_sound(lab)
    do(lab, c.Release(FOLLOWER))
    run_lab(lab, 1.5)
    assert simulation.runs[FOLLOWER].diverged is None
    assert off_path(simulation, FOLLOWER) < 2e-3


def test_bars_join_joints_and_end_at_the_end_point_also_in_the_scene(entry: RobotEntry) -> None:
    lab = lab_with(entry, 0.3)
    simulation = lab.simulation
    robot, stage = simulation.robot, stage_of(simulation.robot)
    snapshot = take_snapshot(lab, 1.0)
    assert_drawable(snapshot)
    views = [snapshot.robots[name] for name in stage.bases]
    poses = poses_of(stage, snapshot.motion)
    q = [simulation.runs[name].fields()["q"] for name in stage.bases]
    for i, (view, configuration) in enumerate(zip(views, q, strict=True)):
        ends, last = view.bars.reshape(-1, 3), robot.position(robot.endpoint(configuration))
        np.testing.assert_allclose(view.tip, last, atol=1e-9)
        logged = simulation.runs[list(stage.bases)[i]].shown()["y"]
        np.testing.assert_allclose(view.end, robot.position(logged), atol=1e-12)
        for joint in view.joints:
            assert np.linalg.norm(ends - joint, axis=1).min() < 1e-9
        links, strip = view.counts.links, view.counts.strip
        one = [*range(i * links, (i + 1) * links)]  # the links of all robots come first
        one += range(len(views) * links + i * strip, len(views) * links + (i + 1) * strip)
        bars = view.bars
        lengths = np.linalg.norm(bars[:, 1] - bars[:, 0], axis=1)
        np.testing.assert_allclose(poses["lengths"][one], lengths, atol=1e-6)
        np.testing.assert_allclose(np.linalg.norm(poses["quaternions"][one], axis=1), 1, atol=1e-6)
        begins = poses["bars"][one] - stage.origins[i]
        depths = robot.drawing.depths
        layers = [depths.back if back else depths.front for back in view.counts.behind]
        off = np.linalg.norm(begins - bars[:, 0], axis=1)
        np.testing.assert_allclose(off, layers, atol=1e-6)
        np.testing.assert_allclose(poses["tips"][i], stage.origins[i] + view.tip, atol=1e-6)


def test_one_function_gives_points_and_poses(entry: RobotEntry) -> None:
    robot = entry.make(entry.parameters())
    function, counts = geometry_function(robot, closed=True)
    assert function.n_out() == 1
    sizes = [int(np.prod(shape)) for shape in counts.pose_shapes]
    assert function.nnz_out(0) == len(SIDES) * (3 * counts.points + sum(sizes))


def test_bars_and_path_lie_in_what_the_camera_shows(entry: RobotEntry) -> None:
    lab = lab_with(entry)
    simulation = lab.simulation
    stage = stage_of(simulation.robot)
    for design in presets().values():
        if curve_faults(simulation.robot.margin, design.curve):
            continue
        z = design.curve.at(np.linspace(-np.pi, np.pi, 60))
        places = simulation.robot.position(simulation.robot.frame.lift(z))
        low, high = (np.array(corner) for corner in (stage.low, stage.high))
        assert (places >= low - 1e-9)[:, [0, 2]].all() and (places <= high + 1e-9)[:, [0, 2]].all()
    view = robot_snapshots(simulation.robot, simulation.editor.curve, simulation.instant())[
        FOLLOWER
    ]
    assert view.bars[..., 2].min() >= stage.floor  # a base may stand on it
    assert stage.title[2] > view.bars[..., 2].max()


def test_neighbours_do_not_reach_into_each_other(entry: RobotEntry) -> None:
    stage = stage_of(entry.make(entry.parameters()))
    left, right = stage.origins
    assert np.linalg.norm(right - left) >= stage.high[0] - stage.low[0]


def test_it_has_a_picture(entry: RobotEntry) -> None:
    assert picture_of(entry).startswith("data:image/")


def test_a_sketch_shows_the_plane_of_the_outputs_wherever_it_is() -> None:
    upright = ROBOTS["two_link_arm"].make(ROBOTS["two_link_arm"].parameters())

    def lying(q: ca.SX, exaggeration: ca.SX) -> tuple[ca.SX, ca.SX]:
        bars, joints = upright.skeleton(q, exaggeration)
        turned = ca.DM([[1, 0, 0], [0, 0, 1], [0, 1, 0]])
        return turned @ bars, turned @ joints

    flat = replace(upright.drawing, axes=((1, 0, 0), (0, 1, 0)))
    assert robot_sketch(replace(upright, drawing=flat, skeleton=lying)) == robot_sketch(upright)


@pytest.mark.thorough
def test_what_it_did_can_be_taken_home(entry: RobotEntry) -> None:
    lab = lab_with(entry, 0.3)
    simulation = lab.simulation
    history = simulation.history.all()
    head = csv_bytes(simulation.robot, history).decode().splitlines()[0]
    assert all(name in head for name in simulation.robot.system.coordinate_names)
    assert picture_file(
        entry.name, simulation.parameters, simulation.history.copy(), "en"
    ).startswith(b"\x89PNG")


@pytest.mark.thorough
def test_its_share_code_brings_back_the_same_lab(entry: RobotEntry) -> None:
    lab = lab_with(entry, 0.1)
    simulation = lab.simulation
    do(lab, c.Set("K1", 350.0), c.ChoosePath("ellipse"))
    own = next(n for n, spec in specs(entry.parameters).items() if spec.group == "realism")
    do(lab, c.Set(own, specs(entry.parameters)[own].on or 100))
    simulation.editor.advance(1.0)
    setup = capture(simulation)
    again = Simulation(loop_cache())
    restore(again, decode(encode(setup)))
    assert again.entry is entry and again.parameters == simulation.parameters
    assert again.editor.design.name == "ellipse" and capture(again) == setup


def test_a_drag_leads_as_far_as_the_hand_in_the_lab(entry: RobotEntry) -> None:
    lab = lab_with(entry)
    robot = lab.simulation.robot
    box = stage_of(robot).reachable
    for corner in (box.lower, box.upper):
        target = robot.output_at(corner)
        do(lab, c.Grab(FOLLOWER, target))
        hand = robot.position(lab.simulation.forces.hands[FOLLOWER])
        np.testing.assert_allclose(hand, robot.position(target), atol=1e-12)
        beyond = robot.output_at(corner + 0.3 * np.sign(corner - (box.lower + box.upper) / 2))
        do(lab, c.Grab(FOLLOWER, beyond))
        np.testing.assert_allclose(
            robot.position(lab.simulation.forces.hands[FOLLOWER]), hand, atol=1e-12
        )


BENDING = GANTRY.replace(
    "    return Robot(\n",
    """    return Robot(
        extras={"deflection": 0.01 * q[0], "temperature": v[0]},
""",
)


@pytest.fixture
def bending(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[RobotEntry]:
    """A robot in one file that says that it bends."""
    with new_robot(tmp_path, monkeypatch, BENDING) as entry:
        link = FLEXIBLE.flexible_link
        monkeypatch.setitem(ROBOTS, "gantry", replace(entry, flexible_link=link))
        yield ROBOTS["gantry"]


def test_a_figure_shows_what_a_new_robot_has_to_plot(bending: RobotEntry) -> None:
    chosen = experiments(bending.name)["position"].with_values({"duration": "0.1", "r": "0.04"})
    log = run(chosen, DEFAULT_LAWS[LEFT])
    figure = experiment_figure(chosen, [log])
    (axes,) = (axes for axes in figure.axes if axes.get_ylabel().startswith("deflection"))
    (line,) = axes.lines
    np.testing.assert_allclose(np.asarray(line.get_ydata()), 1e3 * 0.01 * log.fields["q"][:, 0])
