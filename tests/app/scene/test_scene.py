"""The scene, built on a real viser server without a browser; drags are played to its callbacks."""

from __future__ import annotations

import socket
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import viser
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from onpath.app.common import palette
from onpath.app.lab import commands as c
from onpath.app.lab.snapshots.part_poses import bar_quaternions, waist_angle
from onpath.app.lab.snapshots.robot_geometry import geometry_function, path_place
from onpath.app.lab.snapshots.snapshot import (
    TIP,
    PathSnapshot,
    RobotSnapshot,
    Snapshot,
)
from onpath.app.lab.snapshots.take_snapshot import take_page_snapshot
from onpath.app.scene import meshes
from onpath.app.scene.mouse import SceneCallbacks
from onpath.app.scene.poses import trace_segments
from onpath.app.scene.robot_nodes import FORCE, TRACE_SEGMENTS, part_looks
from onpath.app.scene.scene import Scene
from onpath.app.scene.stage import FIELD_OF_VIEW, Pose, Stage, view_of
from onpath.app.scene.stage_catalogue import stage_of
from onpath.models.control.sides import DEFAULT_LAWS, LEFT, RIGHT, SIDES
from onpath.models.paths.curves import TABLE_SHAPE, circle
from onpath.models.paths.path_design import presets
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.drawing import BACK_LAYER, FRONT_LAYER
from onpath.models.systems.five_bar_robot import RIGID_FIVE_BAR
from tests.support.drags import play
from tests.support.drawing import drawn_length, evaluated
from tests.support.lab import do, new_lab, run

FIVE_BAR = RIGID_FIVE_BAR
RIGID = stage_of(FIVE_BAR)
STAGES = {name: stage_of(entry.make(entry.parameters())) for name, entry in ROBOTS.items()}


def robot(
    q1: float,
    q2: float,
    force: tuple[float, float, float] = (0.0, 0.0, 0.0),
    law: str = DEFAULT_LAWS[RIGHT],
) -> RobotSnapshot:
    """A rigid five-bar."""
    q, pull = np.array([q1, q2]), (force[0], force[2])
    seen = np.concatenate([FIVE_BAR.endpoint(q), pull, [0.0]])
    function, counts = geometry_function(FIVE_BAR, closed=True)
    both = np.tile(q[:, None], 2), np.tile(seen[:, None], 2)
    table = circle(0.05).table().reshape(TABLE_SHAPE, order="F")
    place = path_place(FIVE_BAR, 2).reshape(3, 3, order="F")
    flat = np.array(function(*both, table, 1.0, place))[:, 0]
    points, poses = np.split(flat, [3 * counts.points])
    points = points.reshape(-1, 3)
    trace = np.linspace(np.zeros(3), points[TIP], 50)
    return RobotSnapshot(law, points, poses, counts, trace, 0.0, 0.0, 0.0, np.zeros(2))


def path(version: int = 0, n_points: int = 6) -> PathSnapshot:
    """A circle with control points on it."""
    turn = np.linspace(0.0, 2.0 * np.pi, 101)[:, None]
    circle = np.array([0.2, 0.0, 0.2]) + 0.05 * np.hstack([np.cos(turn), 0 * turn, np.sin(turn)])
    curve = presets()["circle"].curve
    return PathSnapshot(version, curve, circle, circle[:n_points], None, np.zeros((0, 3)))


def snapshot(q1: float = 1.5, q2: float = 3.0, **changes: Any) -> Snapshot:
    """Both robots in the same pose."""
    both = {side: robot(q1, q2, law=DEFAULT_LAWS[side]) for side in SIDES}
    whole = Snapshot(0.0, True, 1.0, both, path(), False, None, "", "info")
    return replace(whole, **changes)


@pytest.fixture(scope="module")
def server():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    server = viser.ViserServer(host="127.0.0.1", port=port, verbose=False)
    yield server
    server.stop()


@pytest.fixture
def lab(server, monkeypatch):
    """A built scene, the messages it sent since, and what its hooks heard."""
    server.scene.reset()
    heard: list[tuple[Any, ...]] = []
    hooks = SceneCallbacks(
        on_grab=lambda *a: heard.append(("grab", *a)),
        on_release=lambda *a: heard.append(("release", *a)),
        on_point_dragged=lambda *a: heard.append(("dragged", *a)),
        on_point_drag_end=lambda *a: heard.append(("dropped", *a)),
        on_point_selected=lambda *a: heard.append(("selected", *a)),
    )
    client: Any = SimpleNamespace(scene=server.scene, atomic=server.atomic)
    scene = Scene(client, RIGID, hooks)
    scene.build(snapshot())
    sent: list[Any] = []
    queue = server.scene._queue_scene_message
    monkeypatch.setattr(server.scene, "_queue_scene_message", lambda m: (sent.append(m), queue(m)))
    return SimpleNamespace(scene=scene, api=server.scene, sent=sent, heard=heard)


def test_a_moving_frame_costs_at_most_four_messages(lab):
    lab.scene.update(snapshot(1.4, 2.9).motion)
    assert 0 < len(lab.sent) <= 4


def test_a_still_frame_costs_nothing(lab):
    lab.scene.update(snapshot().motion)
    assert lab.sent == []


def test_a_force_shows_and_then_hides_its_arrow(lab):
    nodes = [lab.api.get_handle_by_name(f"/force_{i}") for i in range(len(SIDES))]
    for newtons in (10.0, 20.0):
        pulled = {name: robot(1.5, 3.0, force=(newtons, 0.0, 0.0)) for name in SIDES}
        lab.scene.update(snapshot(robots=pulled).motion)
        for node in nodes:
            assert drawn_length(node) == pytest.approx(RIGID.force_scale * newtons, rel=1e-5)
    lab.scene.update(snapshot().motion)
    assert [drawn_length(node) for node in nodes] == [0.0, 0.0]


def test_a_force_at_one_robot_draws_no_arrow_at_the_other(lab):
    one, other = SIDES
    lab.scene.update(
        snapshot(
            robots={one: robot(1.5, 3.0, force=(10.0, 0.0, 0.0)), other: robot(1.5, 3.0)}
        ).motion
    )
    lengths = [drawn_length(lab.api.get_handle_by_name(f"/force_{i}")) for i in range(2)]
    np.testing.assert_allclose(lengths, [10.0 * RIGID.force_scale, 0.0], rtol=1e-5)


def test_poses_that_are_not_finite_are_not_sent(lab):
    broken = {side: robot(np.nan, 3.0, law=DEFAULT_LAWS[side]) for side in SIDES}
    lab.scene.update(snapshot(robots=broken).motion)
    lab.scene.update_traces(snapshot(robots=broken))
    assert lab.sent == []


def test_path_is_redrawn_only_when_its_version_changes(lab):
    moved = replace(path(), points=path().points + 0.01)
    lab.scene.update(snapshot(path=moved).motion)
    assert lab.sent == []
    lab.scene.update(snapshot(path=replace(moved, version=1)).motion)
    assert 0 < len(lab.sent) <= 3


@pytest.mark.parametrize("count", [0, 3, 9])
def test_number_of_control_points_may_change(lab, count):
    lab.scene.update(snapshot(path=path(1, count)).motion)
    points = lab.api.get_handle_by_name("/path/points")
    assert (points is None) == (count == 0)
    if count:
        assert len(points.batched_positions) == len(points.batched_wxyzs) == 2 * count


def test_an_unscaled_control_point_covers_next_to_nothing(lab):
    """viser leaves one at the origin, invisible, where it blocks the camera."""
    points = lab.api.get_handle_by_name("/path/points")
    assert points.batched_scales is None
    assert np.abs(points.vertices).max() < 0.01


def test_refused_places_come_and_go(lab):
    marks = replace(path(), refused=np.zeros((2, 3)))
    for version, refused in ((1, marks), (2, path())):
        lab.scene.update(snapshot(path=replace(refused, version=version)).motion)
        shown = lab.api.get_handle_by_name("/path/refused") is not None
        assert shown == (version == 1)


@pytest.mark.parametrize("instance", [0, 1])
def test_pulling_an_end_point_tells_the_robot_and_the_place(lab, instance):
    name, target = SIDES[instance], np.array([0.21, 0.0, 0.13])
    for phase in ("start", "update", "end"):
        play(lab, "/grips", phase, instance, RIGID.bases[name], RIGID.bases[name] + target)
    assert [event[:2] for event in lab.heard] == [("grab", name)] * 2 + [("release", name)]
    np.testing.assert_allclose(lab.heard[1][2], target, atol=1e-9)


@pytest.mark.parametrize("robot_index", [0, 1])
def test_a_dragged_point_moves_by_what_the_mouse_moved(lab, robot_index):
    base, index = RIGID.bases[SIDES[robot_index]], 4
    point = path().control_points[index]
    pressed = base + point + [0.003, 0.0, -0.002]
    shift = np.array([0.02, 0.0, 0.01])
    instance = robot_index * len(path().control_points) + index
    play(lab, "/path/points", "start", instance, pressed, pressed)
    play(lab, "/path/points", "update", instance, pressed, pressed + shift)
    play(lab, "/path/points", "end", instance, pressed, pressed + shift)
    assert [event[0] for event in lab.heard] == [
        "selected", "dragged", "dragged", "dragged", "dropped"
    ]  # fmt: skip
    assert all(event[1] == index for event in lab.heard)
    np.testing.assert_allclose(lab.heard[1][2], point, atol=1e-9)
    np.testing.assert_allclose(lab.heard[2][2], point + shift, atol=1e-9)


@pytest.mark.parametrize(
    ("path_first", "selected", "beside", "taken"),
    [
        (False, None, 0.0, "grab"),
        (True, None, 0.0, "dragged"),
        (True, None, 0.016, "grab"),  # nearer to the rim of what takes the press
        (False, 4, 0.0, "dragged"),
        (False, 3, 0.0, "grab"),
    ],
)
def test_where_an_end_point_covers_a_control_point_the_one_that_is_meant_is_taken(
    lab, path_first, selected, beside, taken
):
    lab.scene.mouse.path_first = path_first
    lab.scene.update(snapshot(path=replace(path(1), selected=selected)).motion)
    name = SIDES[1]
    point = path().control_points[4] + [beside, 0.0, 0.0]
    pressed, shift = RIGID.bases[name] + point, np.array([0.02, 0.0, 0.01])
    for phase, way in (("start", 0.0), ("update", 1.0), ("end", 1.0)):
        play(lab, "/grips", phase, 1, pressed, pressed + way * shift)
    heard = [event[0] for event in lab.heard]
    if taken == "grab":
        assert heard == ["grab", "grab", "release"]
        return
    assert heard == ["selected", "dragged", "dragged", "dragged", "dropped"]
    assert all(event[1] == 4 for event in lab.heard)
    np.testing.assert_allclose(lab.heard[2][2], path().control_points[4] + shift, atol=1e-9)


def test_a_freehand_stroke_is_told_once_in_the_robots_frame(lab):
    strokes: list[np.ndarray] = []
    lab.scene.begin_freehand(strokes.append)
    base = RIGID.bases[RIGHT]
    corners = np.array([(0.1, 0.0, 0.1), (0.2, 0.0, 0.1), (0.2, 0.0, 0.2), (0.1, 0.0, 0.2)])
    phases = ("start", "update", "update", "end")
    for phase, corner in zip(phases, corners, strict=True):
        play(lab, "/freehand/sheet", phase, 1, base + corners[0], base + corner)
    assert len(strokes) == 1
    np.testing.assert_allclose(strokes[0], corners, atol=1e-9)
    assert lab.api.get_handle_by_name("/freehand/sheet") is None
    assert lab.api.get_handle_by_name("/freehand/line") is None


def test_the_singular_zone_can_be_shown_and_hidden(lab):
    for visible in (True, True, False):
        lab.scene.show_singular_zone(visible)
        assert (lab.api.get_handle_by_name(f"/zone/{RIGHT}") is not None) == visible


@pytest.mark.parametrize("waist", [-0.6, 0.0, 0.9])
def test_bars_point_along_their_links_whatever_the_waist(waist):
    turn = Rotation.from_euler("z", waist)
    bars = turn.apply(robot(1.3, 2.8).bars.reshape(-1, 3)).reshape(-1, 2, 3)
    along = bars[:, 1] - bars[:, 0]
    along[3] += turn.apply([0.0, 0.02, 0.0])  # a bent beam leaves the plane
    assert evaluated(waist_angle, bars.reshape(-1, 3).T)[0] == pytest.approx(waist)
    quaternions = evaluated(bar_quaternions, along.T, waist)[0]
    turned = Rotation.from_quat(quaternions.T, scalar_first=True)
    unit = along / np.linalg.norm(along, axis=1)[:, None]
    np.testing.assert_allclose(turned.apply([1.0, 0.0, 0.0]), unit, atol=1e-12)
    normal = turn.apply([0.0, 1.0, 0.0])
    np.testing.assert_allclose(turned[:3].apply([0.0, 1.0, 0.0]), [normal] * 3, atol=1e-12)


@pytest.mark.parametrize("length", [0, 1, 2, TRACE_SEGMENTS + 1, 1000])
def test_traces_are_connected_and_end_at_the_newest_point(length):
    trace = np.cumsum(np.ones((length, 3)), axis=0)
    segments = trace_segments(trace, TRACE_SEGMENTS)
    assert segments.shape == (TRACE_SEGMENTS, 2, 3)
    np.testing.assert_array_equal(segments[1:, 0], segments[:-1, 1])
    if length:
        np.testing.assert_array_equal(segments[-1, 1], trace[-1])


@pytest.mark.parametrize("size", [(1400, 800), (390, 844), (2560, 600)])
@pytest.mark.parametrize("top", [0, 200])
@pytest.mark.parametrize("stage", STAGES.values(), ids=STAGES)
def test_camera_shows_both_robots_below_the_margin(size, top, stage: Stage):
    pose = view_of(stage, size, top)
    x, y = in_picture(pose, stage.corners, size)
    slack = 2.0
    assert x.min() > -slack and x.max() < size[0] + slack
    assert y.min() > top - slack and y.max() < size[1] + slack
    widest = max(np.ptp(x) / size[0], np.ptp(y) / (size[1] - top))
    assert widest > 0.8


@pytest.mark.parametrize("size", [(1366, 768), (390, 844)])
@pytest.mark.parametrize("name", STAGES)
def test_a_path_that_is_seen_from_the_side_is_looked_at_from_above(
    size: tuple[int, int], name: str
) -> None:
    stage, robot = STAGES[name], ROBOTS[name].make(ROBOTS[name].parameters())
    angle = np.linspace(0, 2 * np.pi, 90)
    circle = np.column_stack([np.cos(angle), np.sin(angle)])
    path = robot.position(robot.frame.lift(0.04 * circle))
    usual, pose = view_of(stage, size, 40), view_of(stage, size, 40, path)
    shown = [in_picture(each, stage.origins[0] + path, size) for each in (usual, pose)]
    heights, widths = ([float(np.ptp(each[i])) for each in shown] for i in (1, 0))
    assert heights[1] > 0.6 * widths[1]
    assert widths[1] >= widths[0] - 1 and heights[1] >= heights[0] - 1
    for base in stage.origins:
        x, y = in_picture(pose, base + path, size)
        assert x.min() > 0 and x.max() < size[0] and y.min() > 38 and y.max() < size[1]


@given(
    size=st.tuples(st.integers(300, 2600), st.integers(250, 1500)),
    name=st.sampled_from(list(STAGES)),
)
def test_there_is_room_to_pull(size: tuple[int, int], name: str) -> None:
    """A quarter of the distance between the robots is free around their usual paths."""
    stage, robot = STAGES[name], ROBOTS[name].make(ROBOTS[name].parameters())
    pose = view_of(stage, size)
    apart = float(np.linalg.norm(np.ptp(stage.origins, axis=0)))
    far = 0.05 + 0.25 * apart
    around = robot.position(robot.frame.lift(far * np.array([(1, 0), (-1, 0), (0, 1), (0, -1)])))
    for base in stage.bases.values():
        x, y = in_picture(pose, base + around, size)
        slack = 2.0
        assert x.min() > -slack and x.max() < size[0] + slack
        assert y.min() > -slack and y.max() < size[1] + slack


@pytest.mark.thorough
@settings(max_examples=8, deadline=None)
@given(angle=st.floats(0, 2 * np.pi), far=st.floats(0.02, 0.1), begun=st.floats(0.5, 4.0))
def test_no_elbow_leaves_its_half_while_one_pulls(angle: float, far: float, begun: float) -> None:
    lab = new_lab(begun)
    width = float(np.ptp(RIGID.origins[:, 0]))
    at = (0.05 + far) * np.array([np.cos(angle), np.sin(angle)])
    do(lab, c.Grab(RIGHT, lab.simulation.robot.frame.lift(at)))
    middle = (RIGID.low + RIGID.high)[0] / 2
    for _ in range(30):
        run(lab, 0.1)
        for each in take_page_snapshot(lab, 1.0).robots.values():
            ends = each.points[: 2 * each.counts.bars, 0]
            elbows = np.delete(ends, np.argmax(ends))  # but for the end-point
            assert np.abs(elbows - middle).max() < width / 2


def in_picture(pose: Pose, points: np.ndarray, size: tuple[int, int]) -> tuple[np.ndarray, ...]:
    """Where a camera shows points, shape (k, 3): from the left and from above, [px]."""
    forward = (pose.look_at - pose.position) / np.linalg.norm(pose.look_at - pose.position)
    right = np.cross(forward, [0.0, 0.0, 1.0])
    right /= np.linalg.norm(right)
    up = np.cross(right, forward)
    scale = size[1] / 2 / np.tan(FIELD_OF_VIEW / 2)
    seen = points - pose.position
    x = size[0] / 2 + scale * (seen @ right) / (seen @ forward)
    return x, size[1] / 2 - scale * (seen @ up) / (seen @ forward)


@pytest.mark.parametrize("law", DEFAULT_LAWS.values())
def test_ring_and_dot_can_be_told_apart_on_a_telephone(law: str) -> None:
    """The smaller of the two discs has a radius of 3 px or more, and a rim of 1.5 px."""
    size, stage = (390, 211), RIGID  # beside a lesson
    pose = view_of(stage, size, 21.0)
    away = float(np.linalg.norm(pose.look_at - pose.position))
    metre = size[1] / (2 * away * np.tan(FIELD_OF_VIEW / 2))  # [px]
    scales, _ = part_looks(RIGHT, law, robot(1.5, 3.0).counts, is_narrow=True)
    bearing = meshes.part("bearing").vertices[:, 0].max()
    usual, _ = part_looks(RIGHT, law, robot(1.5, 3.0).counts)
    wider = [i for i, scale in enumerate(scales) if scale != usual[i]]
    outer, inner = (scales[i][0] * bearing * metre for i in wider)
    assert inner > 3.0 and outer - inner > 1.5


def test_layers_keep_links_apart():
    assert BACK_LAYER - FRONT_LAYER > meshes.LINK_THICKNESS


def test_the_sides_differ_in_lightness_or_blue_for_every_eye():
    tracker, follower = (np.array(palette.OF_SIDE[side].rgb) for side in SIDES)
    assert abs(int(tracker[2]) - int(follower[2])) > 120
    assert palette.OF_SIDE[LEFT].hex == "#d55e00"


def test_drawing_is_reported_as_possible_until_it_ends(lab):
    notes = [lab.api.get_handle_by_name(f"/notes/{side}") for side in SIDES]
    lab.scene.begin_freehand(lambda stroke: None)
    lab.scene.update_traces(snapshot())
    assert lab.scene.is_drawing
    assert all(note.visible and "one stroke" in note.text for note in notes)
    lab.scene.end_freehand()
    lab.scene.update_traces(snapshot())
    assert not lab.scene.is_drawing and not any(note.visible for note in notes)


def test_a_force_too_small_for_an_arrow_draws_none(lab):
    """A head of no length was a dot at the end-point."""
    newtons = 0.9 * FORCE.shortest / RIGID.force_scale
    pulled = {name: robot(1.5, 3.0, force=(newtons, 0.0, 0.0)) for name in SIDES}
    lab.scene.update(snapshot(robots=pulled).motion)
    assert FORCE.shortest > 0.2 * FORCE.head_length
    assert not any(lab.api.get_handle_by_name(f"/force_{i}").visible for i in range(len(SIDES)))
