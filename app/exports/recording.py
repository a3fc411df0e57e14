"""The scene of the last seconds as one HTML page that plays in any browser, without a server."""

from __future__ import annotations

import numpy as np

from onpath.app.lab.plot_samples import sample_layout
from onpath.app.lab.segments import Segment
from onpath.app.lab.snapshots.obstacles import wall_then
from onpath.app.lab.snapshots.robot_geometry import robot_snapshots
from onpath.app.lab.snapshots.snapshot import PathSnapshot, Snapshot
from onpath.app.lab.snapshots.take_snapshot import path_points
from onpath.app.scene.scene import Scene
from onpath.app.scene.stage import set_initial_camera
from onpath.app.scene.stage_catalogue import stage_of
from onpath.app.viser_adapter.film_server import FilmServer
from onpath.lessons.words import ENGLISH, Words
from onpath.models.systems.robots import Robot

RATE = 30.0  # [Hz], frames of a recording


def record_scene(robot: Robot, history: list[Segment], words: Words = ENGLISH) -> bytes:
    """A standalone page that replays the history.

    The scene is rebuilt in a `FilmServer`.
    """
    frames = _frames(history)
    studio, stage = FilmServer(), stage_of(robot)
    set_initial_camera(studio, stage)
    scene = Scene(studio, stage, words=words)  # type: ignore[arg-type]  # has scene, atomic()
    scene.build(_snapshot(robot, frames[0], []))
    serializer = studio.get_scene_serializer()
    for number, segment in enumerate(frames):
        snapshot = _snapshot(robot, segment, frames[max(0, number - 45) : number])
        scene.update(snapshot.motion)
        if number % 3 == 0:
            scene.update_traces(snapshot)
        serializer.insert_sleep(1 / RATE)
    return serializer.as_html().encode()


def _frames(history: list[Segment]) -> list[Segment]:
    """Sample the history at about the recording's rate."""
    times = np.array([s.time for s in history])
    wanted = np.arange(times[0], times[-1] + 1e-9, 1 / RATE)
    return [history[i] for i in np.searchsorted(times, wanted).clip(max=len(times) - 1)]


def _snapshot(robot: Robot, segment: Segment, before: list[Segment]) -> Snapshot:
    outputs = sample_layout(robot).slices["y"]
    traces = np.array([s.sample[:, outputs] for s in [*before, segment]], dtype=float)
    robots = robot_snapshots(robot, segment.curve, segment.instant(), traces[:-1])
    path = PathSnapshot(
        version=id(segment.curve),
        curve=segment.curve,
        points=robot.position(robot.frame.lift(path_points(segment.curve))),
        control_points=np.zeros((0, 3)),
        selected=None,
        refused=np.zeros((0, 3)),
    )
    return Snapshot(
        time=segment.time,
        running=True,
        achieved_speed=1.0,
        robots=robots,
        path=path,
        held=False,
        grabbed=None,
        message="",
        message_level="info",
        wall=wall_then(robot, segment),
    )
