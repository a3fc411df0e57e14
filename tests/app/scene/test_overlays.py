"""What is drawn on demand costs nothing when off, and is made anew only for a reason."""

from __future__ import annotations

import socket
from collections import Counter
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import viser

from onpath.app.common import palette
from onpath.app.lab import commands as c
from onpath.app.lab.commands.scripts import ScriptPull
from onpath.app.lab.lab import Lab
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.lab.snapshots.snapshot import END, MARKER
from onpath.app.lab.snapshots.take_snapshot import take_motion, take_page_snapshot
from onpath.app.scene.arrows import SHORTEST
from onpath.app.scene.error_nodes import ErrorNodes
from onpath.app.scene.overlays import Overlays
from onpath.app.scene.plane_picture import map_corners
from onpath.app.scene.rank_nodes import largest, map_picture
from onpath.app.scene.robot_labels import RobotLabels
from onpath.app.scene.stage_catalogue import stage_of
from onpath.app.scene.tube_nodes import tube_shape
from onpath.app.server.lab_server import LabServer
from onpath.app.server.server_options import ServerOptions
from onpath.app.view.notes import rank_note, tube_note
from onpath.app.viser_adapter.images import add_png, png_of
from onpath.lessons.action_schema import SceneMark
from onpath.lessons.vocabulary.names import DRAWINGS
from onpath.lessons.words import ENGLISH
from onpath.models.control.rank_test import rank_grid
from onpath.models.paths.curve_faults import ambiguities
from onpath.models.paths.path_design import presets
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.drawing import Drawing
from onpath.models.systems.robots import RobotEntry
from onpath.models.systems.two_link_arm import TWO_LINK_ARM
from tests.support.built_in import built_in_course
from tests.support.drawing import drawn_length
from tests.support.lab import do, loop_cache, run
from tests.support.student import Student
from tests.support.waiting import wait_for

TYPICAL = "five_bar", "flexible", "seven_axes"
ENTRIES = pytest.mark.parametrize("entry", [ROBOTS[name] for name in TYPICAL], ids=TYPICAL)


@pytest.fixture(scope="module")
def server() -> Iterator[viser.ViserServer]:
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    server = viser.ViserServer(host="127.0.0.1", port=port, verbose=False)
    yield server
    server.stop()


class Shown:
    """A lab, and the overlays that follow it; `sent` are the messages since it was last read."""

    def __init__(self, entry: RobotEntry, scene: Any) -> None:
        self.lab = Lab(loop_cache(), entry)
        run(self.lab, 0.1)
        robot, self.messages = self.lab.simulation.robot, list[Any]()
        stage = stage_of(robot)
        self.overlays = Overlays(scene, stage, robot, set[str](), lambda work: work())

    def follow(self) -> list[str]:
        """Names of the messages by which the scene follows the lab."""
        self.messages.clear()
        self.overlays.update(take_motion(self.lab))
        self.overlays.follow(take_page_snapshot(self.lab, 1.0))
        return [type(message).__name__ for message in self.messages]


@pytest.fixture
def shown(entry: RobotEntry, server: viser.ViserServer, monkeypatch: pytest.MonkeyPatch) -> Shown:
    server.scene.reset()
    made = Shown(entry, server.scene)
    queue = server.scene._queue_scene_message

    def take(message: Any) -> None:
        made.messages.append(message)
        queue(message)

    monkeypatch.setattr(server.scene, "_queue_scene_message", take)
    return made


@ENTRIES
def test_off_it_sends_nothing_whatever_happens(shown: Shown) -> None:
    assert shown.follow() == []
    do(shown.lab, c.ChoosePath("ellipse"), c.Set("payload", 0.1))
    run(shown.lab, 0.2)
    assert shown.follow() == []


@ENTRIES
@pytest.mark.parametrize("name", DRAWINGS)
def test_a_switch_draws_and_removes_and_a_still_lab_sends_nothing_more(
    shown: Shown, name: str
) -> None:
    do(shown.lab, c.SetRunning(False))
    shown.overlays.switches.add(name)
    assert shown.follow()
    assert shown.follow() == []
    shown.overlays.switches.remove(name)
    assert set(shown.follow()) == {"RemoveSceneNodeMessage"}
    assert shown.follow() == []


@ENTRIES
def test_marks_are_at_both_robots_and_go_with_their_step(shown: Shown) -> None:
    """A text and an arrow at each robot."""
    mark = SceneMark((10.0, 20.0), text="here")
    shown.overlays.marks = (mark, SceneMark((0.0, 50.0), (0.0, 80.0)))
    sent = Counter(shown.follow())
    assert sent["LabelMessage"] == 2 and sent["ArrowMessage"] == 2
    assert shown.follow() == []
    shown.overlays.marks = (mark,)
    assert "LabelMessage" in shown.follow()
    shown.overlays.marks = ()
    assert set(shown.follow()) == {"RemoveSceneNodeMessage"}


@pytest.mark.thorough
@ENTRIES
def test_the_arrows_lead_to_the_timetable_and_to_the_path(shown: Shown) -> None:
    """With a hand at both, so that both errors are there; d is the distance that is measured."""
    do(shown.lab, c.Set("K1", 100.0), ScriptPull((20.0, 15.0)))
    run(shown.lab, 0.6)
    motion, snapshot = take_motion(shown.lab), take_page_snapshot(shown.lab, 1.0)
    stage = shown.overlays.stage
    nodes = ErrorNodes(shown.overlays._scene, stage, motion)
    moved = stage.origins - 0.012 * stage.away
    for i, view in enumerate(snapshot.robots.values()):
        (begin, clock), (again, path) = nodes._drawn[i] - moved[i]
        np.testing.assert_allclose([begin, again], [motion.point(i, END)] * 2, atol=1e-9)
        np.testing.assert_allclose(clock, motion.point(0, MARKER), atol=1e-9)
        assert np.linalg.norm(path - begin) == pytest.approx(view.distance, abs=2e-4)
        assert view.distance > 3e-3
    nodes.remove()


@pytest.mark.thorough
@ENTRIES
def test_the_arrows_are_as_long_as_the_errors_that_they_stand_for(shown: Shown) -> None:
    """Free, held and let go; an error too short to be seen has no arrow, so neither has none."""
    motion = take_motion(shown.lab)
    nodes = ErrorNodes(shown.overlays._scene, shown.overlays.stage, motion)
    scene = shown.overlays._scene
    seen = Counter[bool]()
    for step in range(24):
        do(shown.lab, *({8: [c.Hold(True)], 16: [c.Hold(False)]}.get(step, [])))
        run(shown.lab, 0.15)
        motion, views = take_motion(shown.lab), take_page_snapshot(shown.lab, 1.0).robots
        nodes.follow(motion)
        for i, view in enumerate(views.values()):
            clock = float(np.linalg.norm(motion.point(0, MARKER) - motion.point(i, END)))
            for name, error in ("e", clock), ("d", view.distance):
                node: Any = scene.get_handle_by_name(f"/show/errors/{name}_{i}")
                seen[node.visible] += 1
                if node.visible:
                    assert drawn_length(node) == pytest.approx(error, abs=3e-4)
                else:
                    assert error < SHORTEST + 3e-4
    assert min(seen[True], seen[False]) > 5
    nodes.remove()


@ENTRIES
def test_only_labels_move_with_the_robots(shown: Shown) -> None:
    switches = shown.overlays.switches
    switches |= {"tube", "grid", "rank"}
    shown.follow()
    run(shown.lab, 0.2)
    assert shown.follow() == []
    switches.add("labels")
    shown.follow()
    run(shown.lab, 0.2)
    moves = {"SetPositionMessage"}
    if (
        shown.lab.simulation.robot.chain is None
    ):  # the joints of chains have labels, which do not turn
        moves.add("SceneNodeUpdateMessage")
    assert set(shown.follow()) == moves


@ENTRIES
def test_a_path_makes_the_tube_anew_and_a_parameter_of_the_plant_the_map(shown: Shown) -> None:
    do(shown.lab, c.SetRunning(False))
    switches, overlays = shown.overlays.switches, shown.overlays
    switches |= {"tube", "rank"}
    shown.follow()
    tube, rank = overlays.shape, overlays.rank_map
    do(shown.lab, c.Set("K1", 350.0))
    assert shown.follow() == []
    of_plant = "rho" if shown.lab.simulation.entry.flexible_link else "payload"
    do(shown.lab, c.Set(of_plant, 0.15))
    shown.follow()
    assert overlays.rank_map is not rank and overlays.shape is tube
    rank = overlays.rank_map
    do(shown.lab, c.ChoosePath("ellipse"))
    shown.follow()
    assert overlays.shape is not tube and overlays.rank_map is rank


@ENTRIES
def test_the_tube_is_that_of_the_path_that_is_drawn(entry: RobotEntry) -> None:
    lab = Lab(loop_cache(), entry)
    do(lab, c.SetRunning(False), c.ChoosePath("ellipse"))
    lab.simulation.editor.advance(10.0)
    snapshot = take_page_snapshot(lab, 1.0)
    robot, curve = lab.simulation.robot, lab.simulation.editor.curve
    shape = tube_shape(robot, snapshot.path)
    z = robot.frame.planar(robot.output_at(shape.offsets[:, 0]))
    _, distance = curve.plan.nearest(z)
    steps = distance / shape.step
    assert np.abs(steps - np.round(steps)).max() < 1e-6 and steps.max() >= 2.9
    assert distance.max() < shape.width


@pytest.mark.parametrize("name", presets())
def test_every_preset_has_a_tube_that_can_be_drawn(name: str) -> None:
    lab = Lab(loop_cache())
    do(lab, c.SetRunning(False), c.ChoosePath(name))
    lab.simulation.editor.advance(10.0)
    shape = tube_shape(lab.simulation.robot, take_page_snapshot(lab, 1.0).path)
    crosses = bool(ambiguities(lab.simulation.editor.design.curve))
    for points in (shape.fill.vertices, shape.normals, shape.offsets):
        assert (len(points) or crosses) and np.isfinite(points).all()
    assert (shape.width < 5e-3) == crosses  # there is no tube at a crossing
    is_straight = lab.simulation.editor.design.name == "segment"
    assert np.isinf(shape.width) == is_straight
    assert ("straight" in tube_note(shape.width, ENGLISH)) == is_straight


@pytest.mark.thorough
def test_the_tube_of_a_rising_path_lies_around_it_in_space() -> None:
    entry = ROBOTS["spatial_arm"]
    lab = Lab(loop_cache(), entry)
    do(lab, c.SetRunning(False), c.Set("rise", 0.03))
    lab.simulation.editor.advance(10.0)
    robot, path = lab.simulation.robot, take_page_snapshot(lab, 1.0).path
    curve = path.curve
    assert curve.dimension == 3
    shape = tube_shape(robot, path)
    around = robot.output_at(shape.fill.vertices)
    gaps = around[:, None] - curve.at(curve.sample(2000))
    distance = np.linalg.norm(gaps, axis=-1).min(axis=1)
    assert np.ptp(distance) < 1e-6 and 0.9 * shape.width < distance.mean() < shape.width


@ENTRIES
def test_the_map_is_seen_where_the_robot_reaches_and_nowhere_else(entry: RobotEntry) -> None:
    robot = entry.make(entry.parameters())
    low, high = map_corners(stage_of(robot), robot)
    grid = rank_grid(robot, entry.parameters(), low, high)
    assert grid.values.shape == (64, 64)
    home = (np.zeros(2) - low) / (high - low)
    assert ((home > 0) & (home < 1)).all()
    picture = map_picture(robot, grid, 1.0)
    finer = len(picture) // 64
    opaque = picture[::-1, :, 3].reshape(64, finer, 64, finer).mean(axis=(1, 3)) > 127
    differ = opaque != np.isfinite(grid.values)
    assert differ.mean() < 0.02
    brightest = np.unravel_index(np.nanargmax(grid.values), grid.values.shape)
    row, column = (int((i + 0.5) * finer) for i in brightest)
    shade = picture[len(picture) - 1 - row, column, :3].astype(int)
    assert np.abs(shade - palette.SCALE[-1].rgb).max() < 12


def test_the_colour_scale_is_viridis() -> None:
    import matplotlib

    shares = np.linspace(0.0, 1.0, 101)
    viridis = 255 * matplotlib.colormaps["viridis"](shares)[:, :3]
    assert np.abs(palette.on_scale(shares) - viridis).max() < 12


def test_a_picture_that_is_encoded_beforehand_is_sent_as_viser_sends_one(
    server: viser.ViserServer,
) -> None:
    picture = np.random.default_rng(1).integers(0, 255, (8, 5, 4), dtype=np.uint8)
    position, turn = np.array([1.0, 2.0, 3.0]), np.array([0.0, 1.0, 0.0, 0.0])
    own = add_png(server.scene, "/own", png_of(picture), (0.5, 0.8), position, turn)
    still = {"cast_shadow": False, "receive_shadow": False}
    place: Any = {"position": position, "wxyz": turn}
    theirs = server.scene.add_image("/theirs", picture, 0.5, 0.8, format="png", **still, **place)
    assert own._impl.props == theirs._impl.props
    assert (own.position == theirs.position).all() and (own.wxyz == theirs.wxyz).all()


def test_a_robot_without_names_has_axes_alone(server: viser.ViserServer) -> None:
    entry = ROBOTS["two_link_arm"]
    motion = take_motion(Lab(loop_cache(), entry))
    stage, nameless = stage_of(TWO_LINK_ARM), replace(TWO_LINK_ARM, drawing=Drawing())
    labels = RobotLabels(server.scene, stage, nameless, motion)
    labels.update(motion)
    assert server.scene.get_handle_by_name("/show/arcs") is None
    assert server.scene.get_handle_by_name("/show/axes_0") is not None
    labels.remove()
    assert server.scene.get_handle_by_name("/show/axes_0") is None


def test_numbers_stand_beside_the_colours_and_the_lines() -> None:
    entry = ROBOTS["flexible"]
    robot = entry.make(entry.parameters())
    grid = rank_grid(robot, entry.parameters(), *map_corners(stage_of(robot), robot))
    note = rank_note(largest(grid.values), 0.5, ENGLISH)
    assert f"{largest(grid.values):.3g}" in note and "(m/s²)/(N m)" in note
    assert "α = 0.5" in note and "α" not in rank_note(1.0, None, ENGLISH)
    shape = tube_shape(robot, take_page_snapshot(Lab(loop_cache(), entry), 1.0).path)
    assert "50.0 mm" in tube_note(shape.width, ENGLISH)
    assert "every" in tube_note(shape.width, ENGLISH, (shape.step, shape.degrees))


@pytest.fixture
def lessons() -> Iterator[LabServer]:
    server = LabServer("127.0.0.1", 0, LoopCache(), ServerOptions(course=built_in_course()[0]))
    yield server
    server.stop()


@pytest.mark.thorough
def test_a_projector_shows_it_in_a_lesson_too(lessons: LabServer) -> None:
    with Student(f"ws://127.0.0.1:{lessons.server.get_port()}") as student:
        student.open()
        student.read(lambda: student.code)
        lab = wait_for(lambda: lessons.registry.find(student.code), 30.0).scheduled.lab
        for command in (c.OpenLesson("01-path-or-timetable"), c.Set("presenting", True)):
            lab.post(command)
        student.read(lambda: student.sees("Step 1 of") and student.state["presenting"])
        student.settle("tube", True)
        (client,) = lessons.server.get_clients().values()
        student.read(lambda: client.scene.get_handle_by_name("/show/tube") is not None)
