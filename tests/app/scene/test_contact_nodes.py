"""What holds an end-point is drawn where it holds, and the force is written beside the path."""

from __future__ import annotations

from collections.abc import Iterator
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import viser
from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.app.lab import commands as c
from onpath.app.scene import meshes
from onpath.app.scene.contact_nodes import CLEAR
from onpath.app.scene.scene import Scene
from onpath.app.scene.stage_catalogue import stage_of
from onpath.models.control.sides import LEFT, SIDES
from onpath.models.systems.catalogue import ROBOTS
from tests.support.lab import do, new_lab, run, take_snapshot


@pytest.mark.thorough
@settings(max_examples=3)
@given(name=st.sampled_from(list(ROBOTS)))
def test_an_end_point_that_is_held_back_slides_in_its_guide(name: str) -> None:
    lab = new_lab()
    do(lab, c.ChooseRobot(name))
    run(lab, 1.0)
    do(lab, c.Hold(True))
    run(lab, 0.5)
    shown = take_snapshot(lab, 1.0)
    assert set(shown.brakes) == set(SIDES)
    for side, (place, blocked, free) in shown.brakes.items():
        moved = shown.robots[side].end - place
        assert abs(moved @ blocked) < min(meshes.RAIL[0] / 2, np.linalg.norm(moved))
        assert np.allclose([blocked @ blocked, free @ free, blocked @ free], [1, 1, 0])


def test_a_brake_in_both_directions_leaves_none_free() -> None:
    lab = new_lab(0.5)
    do(lab, c.Set("hold_direction", "both"), c.Hold(True))
    assert not any(rows[2].any() for rows in take_snapshot(lab, 1.0).brakes.values())


@pytest.fixture
def server() -> Iterator[viser.ViserServer]:
    server = viser.ViserServer(host="127.0.0.1", port=0, verbose=False)
    yield server
    server.stop()


def test_guides_and_forces_come_and_go(
    server: viser.ViserServer, monkeypatch: pytest.MonkeyPatch
) -> None:
    lab = new_lab(0.5)
    first = take_snapshot(lab, 1.0)
    client: Any = SimpleNamespace(scene=server.scene, atomic=server.atomic)
    scene = Scene(client, stage_of(lab.simulation.robot))
    scene.build(first)
    handle: Any = server.scene.get_handle_by_name
    assert handle("/brakes/left") is None and not handle("/force_labels/left").visible
    do(lab, c.Hold(True))
    run(lab, 0.5)
    held = take_snapshot(lab, 1.0)
    scene.update_traces(held)
    assert handle("/brakes/left") is not None and handle("/brakes/right") is not None
    label, path = handle("/force_labels/left"), held.path.points
    assert label.visible and "N" in label.text
    height = label.position[2] - scene.stage.bases[LEFT][2]
    assert height in (
        pytest.approx(path[:, 2].max() + CLEAR),
        pytest.approx(path[:, 2].min() - CLEAR),
    )
    sent: list[object] = []
    monkeypatch.setattr(server.scene, "_queue_scene_message", sent.append)
    scene.update_traces(held)
    assert sent == []
    monkeypatch.undo()
    do(lab, c.Hold(False))
    scene.update_traces(take_snapshot(lab, 1.0))
    assert handle("/brakes/left") is None
