"""Simulated browsers do what real ones do, and the shortcuts for many of them change nothing."""

from __future__ import annotations

import asyncio
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import viser
import websockets.sync.client
from lab import FOLLOWER
from websockets.typing import Subprotocol

from app.hardening import make_server
from app.load import crowd
from app.loop_store import LoopStore
from app.node_update import update_node
from app.protocol import CAMERA, SUBPROTOCOL, packed, unpacked
from app.server import LabServer
from models.catalogue import ROBOTS
from models.curves import circle
from models.simulation import FREE, Push, brake_at, kernel_of, kind_of, pushed, settings_vector


@pytest.fixture
def server() -> Iterator[viser.ViserServer]:
    server = make_server(port=0)
    yield server
    server.stop()


def told(server: viser.ViserServer, name: str, fields: set[str]) -> dict[str, Any]:
    """The first update of these fields of a node that a browser gets."""
    address = f"ws://127.0.0.1:{server.get_port()}"
    with websockets.sync.client.connect(
        address, subprotocols=[Subprotocol(SUBPROTOCOL)], compression=None
    ) as socket:
        socket.send(packed("ViewerCameraMessage", **CAMERA))
        while True:
            raw = socket.recv(timeout=10)
            assert isinstance(raw, bytes)
            for message in unpacked(raw):
                if message.get("name") == name and fields <= message.get("updates", {}).keys():
                    return message


def test_one_message_does_what_assignments_do(server: viser.ViserServer) -> None:
    corners = np.eye(3, dtype=np.float32)
    nodes = [
        server.scene.add_batched_meshes_simple(
            f"/{name}",
            corners,
            np.array([[0, 1, 2]]),
            np.tile([1.0, 0, 0, 0], (2, 1)),
            np.zeros((2, 3)),
        )
        for name in ("assigned", "updated")
    ]
    there = np.arange(6, dtype=np.float32).reshape(2, 3)
    turned = np.tile(np.array([0, 1, 0, 0], dtype=np.float32), (2, 1))
    nodes[0].batched_positions, nodes[0].batched_wxyzs = there, turned
    update_node(nodes[1], batched_positions=there, batched_wxyzs=turned)
    kept = there.copy()
    there += 1  # nobody may hold on to what was given
    both = told(server, "/updated", {"batched_positions", "batched_wxyzs"})
    for field in ("batched_positions", "batched_wxyzs"):
        one = told(server, "/assigned", {field})
        assert one["owner"] == both["owner"]
        assert one["updates"][field].dtype == both["updates"][field].dtype
        assert np.array_equal(one["updates"][field], both["updates"][field])
    assert np.array_equal(both["updates"]["batched_positions"].reshape(2, 3), kept)
    assert np.array_equal(nodes[1].batched_positions, kept)


@pytest.mark.parametrize("name", ROBOTS)
def test_filling_in_a_push_is_the_same_as_packing_anew(name: str) -> None:
    parameters, curve = ROBOTS[name].parameters(), circle(0.05)
    robot = ROBOTS[name].make(parameters)
    kernel = kernel_of(robot, kind_of(FOLLOWER, parameters, curve))
    y = robot.frame.lift(np.array([0.01, 0.02]))
    pushes = [FREE, Push(hand=y), Push(hold=brake_at(robot, curve, y, 0.3))]
    pushes.append(Push(pushes[1].hand, pushes[2].hold))
    packs = [settings_vector(robot, kernel, parameters, curve, push) for push in pushes]
    for before in packs:
        for push, pack in zip(pushes, packs, strict=True):
            assert np.array_equal(pushed(kernel, before, push), pack)


def test_simulated_browsers_see_and_do_what_real_ones_do(tmp_path: Path) -> None:
    server = LabServer("127.0.0.1", 0, LoopStore(None, tmp_path))
    seen = asyncio.run(crowd(server.server.get_port(), 2, seconds=4.5, settled=2.0))
    labs = server.simulation.labs
    server.stop()
    assert seen["clients"] == 2
    assert 10 < seen["slowest_hz"] < 35
    assert all(lab.session.time > 1.0 for lab in labs)
    assert max(run.max_distance for lab in labs for run in lab.session.runs.values()) > 0.004
    assert any(lab.session.parameters.K1 != 400.0 for lab in labs)
