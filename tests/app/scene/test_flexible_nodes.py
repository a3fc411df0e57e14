"""A flexible link is a blade that tapers, with the straight one beside it when it bends."""

from __future__ import annotations

from collections.abc import Iterator
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import viser
from viser.transforms import SO3

from onpath.app.lab import commands as c
from onpath.app.lab.snapshots.snapshot import Snapshot
from onpath.app.scene import meshes
from onpath.app.scene.poses import poses_of
from onpath.app.scene.robot_nodes import GHOST
from onpath.app.scene.scene import Scene
from onpath.app.scene.stage_catalogue import stage_of
from tests.support.lab import do, new_lab, run, take_snapshot


@pytest.fixture
def server() -> Iterator[viser.ViserServer]:
    server = viser.ViserServer(host="127.0.0.1", port=0, verbose=False)
    yield server
    server.stop()


def ends(snapshot: Snapshot, scene: Scene) -> tuple[np.ndarray, np.ndarray]:
    """Beginnings of the straight blades, and where they end, shape (robots, 3), in the world."""
    poses = poses_of(scene.stage, snapshot.motion)
    rows = slice(-len(snapshot.robots), None)
    turns = [SO3(wxyz) for wxyz in poses["quaternions"][rows]]
    along = [turn.apply(np.array([1.0, 0.0, 0.0])) for turn in turns]
    begins = poses["bars"][rows]
    return begins, begins + poses["lengths"][rows][:, None] * np.stack(along)


@pytest.mark.parametrize("seconds", [0.0, 0.6])
def test_the_straight_blade_ends_at_the_rigid_tip(
    server: viser.ViserServer, seconds: float
) -> None:
    lab = new_lab()
    do(lab, c.ChooseRobot("flexible"))
    run(lab, 0.5)
    do(lab, c.Hold(True))
    run(lab, seconds)
    shown = take_snapshot(lab, 1.0)
    client: Any = SimpleNamespace(scene=server.scene, atomic=server.atomic)
    scene = Scene(client, stage_of(lab.simulation.robot))
    scene.build(shown)
    begins, tips = ends(shown, scene)
    for i, (side, view) in enumerate(shown.robots.items()):
        base = scene.stage.bases[side]
        np.testing.assert_allclose(begins[i], base + view.bars[-view.counts.strip, 0], atol=1e-6)
        np.testing.assert_allclose(tips[i], base + view.marks[0], atol=1e-6)
    handle: Any = server.scene.get_handle_by_name("/straight")
    beams: Any = server.scene.get_handle_by_name("/beams")
    assert len(handle.batched_positions) == len(shown.robots)
    strip = next(iter(shown.robots.values())).counts.strip
    widths = beams.batched_scales.reshape(len(shown.robots), strip, 3)[:, :, 2]
    assert (np.diff(widths) < 0).all() and widths.min() > GHOST  # hidden while nothing bends
    thin = np.ptp(meshes.part("blade").vertices[:, 1])
    assert thin < 0.25 * meshes.LINK_THICKNESS


def test_a_rigid_robot_has_no_blade(server: viser.ViserServer) -> None:
    lab = new_lab()
    client: Any = SimpleNamespace(scene=server.scene, atomic=server.atomic)
    Scene(client, stage_of(lab.simulation.robot)).build(take_snapshot(lab, 1.0))
    assert server.scene.get_handle_by_name("/straight") is None
