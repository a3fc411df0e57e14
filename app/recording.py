"""The scene of the last seconds as one HTML page that plays in any browser, without a server."""

from __future__ import annotations

import numpy as np

from app.figure import robot_views
from app.hardening import make_server
from app.history import Stretch
from app.samples import sample_layout
from app.scene import Scene
from app.snapshot import PathView, Snapshot
from app.stage import set_initial_camera
from app.stages import stage_of
from app.take_snapshot import CURVE_POINTS
from lessons.words import ENGLISH, Words
from models.robots import Robot

RATE = 30.0  # [Hz]


def record_scene(robot: Robot, history: list[Stretch], words: Words = ENGLISH) -> bytes:
    """A standalone page that replays the history.

    The scene is built once more on a server of its own that nobody is told of.
    """
    server = make_server(port=0)
    try:
        stage = stage_of(robot)
        set_initial_camera(server, stage)
        scene = Scene(server, stage=stage, words=words)  # type: ignore[arg-type]  # has scene, atomic()
        frames = _frames(history)
        serializer = None
        for number, stretch in enumerate(frames):
            snapshot = _snapshot(robot, stretch, number, frames[max(0, number - 45) : number])
            if serializer is None:
                scene.build(snapshot)
                serializer = server.get_scene_serializer()
            scene.update(snapshot)
            scene.update_path(snapshot)
            if number % 3 == 0:
                scene.update_traces(snapshot)
            serializer.insert_sleep(1 / RATE)
        assert serializer is not None
        return serializer.as_html().encode()
    finally:
        server.stop()


def _frames(history: list[Stretch]) -> list[Stretch]:
    """Stretches at about the film's rate."""
    times = np.array([s.time for s in history])
    wanted = np.arange(times[0], times[-1] + 1e-9, 1 / RATE)
    return [history[i] for i in np.searchsorted(times, wanted).clip(max=len(times) - 1)]


def _snapshot(robot: Robot, stretch: Stretch, number: int, before: list[Stretch]) -> Snapshot:
    where = sample_layout(robot).slices["y"]
    traces = np.array([s.sample[:, where] for s in [*before, stretch]], dtype=float)
    views = robot_views(robot, stretch.curve, stretch.instant(), traces[:-1])
    theta = np.linspace(-np.pi, np.pi, CURVE_POINTS)
    path = PathView(
        version=id(stretch.curve),
        points=robot.place(robot.frame.lift(stretch.curve.at(theta))),
        control_points=np.zeros((0, 3)),
        selected=None,
        refused=np.zeros((0, 3)),
    )
    return Snapshot(stretch.time, True, 1.0, views, path, False, None, "", "info")
