"""A hand holds an end-point while it is pulled, and costs nothing otherwise."""

from __future__ import annotations

from collections.abc import Iterator
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import viser

from onpath.app.lab import commands as c
from onpath.app.lab.lab import Lab
from onpath.app.scene import hand_nodes
from onpath.app.scene.scene import Scene
from onpath.app.scene.stage_catalogue import stage_of
from onpath.models.control.sides import LEFT, SIDES
from tests.support.lab import do, new_lab, run, take_snapshot


@pytest.fixture
def server() -> Iterator[viser.ViserServer]:
    server = viser.ViserServer(host="127.0.0.1", port=0, verbose=False)
    yield server
    server.stop()


def show(scene: Scene, lab: Lab) -> None:
    """Both kinds of update."""
    shown = take_snapshot(lab, 1.0)
    scene.update(shown.motion)
    scene.update_traces(shown)


def places(node: Any) -> np.ndarray:
    """Where the hands are that are seen, shape (n, 3), [m]."""
    return node.batched_positions[node.batched_scales[:, 0] > 0] if node.visible else np.zeros(0)


@pytest.mark.parametrize("robot", ["five_bar", "flexible", "spatial_arm", "two_link_arm"])
def test_a_hand_is_at_each_end_point_that_is_pulled(
    server: viser.ViserServer, monkeypatch: pytest.MonkeyPatch, robot: str
) -> None:
    sent = list[dict[str, np.ndarray]]()
    update = hand_nodes.update_node

    def counted(node: Any, **arrays: np.ndarray) -> None:
        sent.append(arrays)
        update(node, **arrays)

    monkeypatch.setattr(hand_nodes, "update_node", counted)
    lab = new_lab()
    do(lab, c.ChooseRobot(robot))
    run(lab, 0.5)
    stage = stage_of(lab.simulation.robot)
    client: Any = SimpleNamespace(scene=server.scene, atomic=server.atomic)
    scene = Scene(client, stage)
    scene.build(take_snapshot(lab, 1.0))
    node = scene._hands._node
    for _ in range(5):
        run(lab, 0.1)
        show(scene, lab)
    assert not node.visible and sent == []
    for together in (True, False):
        do(
            lab,
            c.Set("copy", together),
            c.Grab(LEFT, lab.simulation.runs[LEFT].shown()["y"] + 0.02),
        )
        for _ in range(3):
            run(lab, 0.1)
            show(scene, lab)
            view = take_snapshot(lab, 1.0).robots
            pulled = SIDES if together else (LEFT,)
            ends = np.stack([stage.bases[side] + view[side].tip for side in pulled])
            assert places(node) == pytest.approx(ends, abs=1e-4)
        do(lab, c.Release(LEFT))
        show(scene, lab)
        assert not node.visible
    count = len(sent)
    run(lab, 0.2)
    show(scene, lab)
    assert len(sent) == count
    do(lab, c.Hold(True))
    run(lab, 0.2)
    show(scene, lab)
    assert not node.visible  # a brake is drawn as a clamp
