"""Batched sending to many browsers does not change what each receives."""

from __future__ import annotations

import asyncio
from collections.abc import Iterator
from contextlib import contextmanager
from threading import Event, Thread, get_ident
from typing import Any

import numpy as np
import pytest
import viser
import websockets.sync.client
from websockets.typing import Subprotocol

from onpath.app.viser_adapter.frame_channel import FrameChannel, update_node
from onpath.app.viser_adapter.secure_server import make_server
from tests.bench.client_protocol import CAMERA, SUBPROTOCOL, packed, unpacked
from tests.support.waiting import wait_for


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


@contextmanager
def browser(server: viser.ViserServer) -> Iterator[tuple[viser.ClientHandle, Any]]:
    """A client as the server knows it, and its socket."""
    address = f"ws://127.0.0.1:{server.get_port()}"
    with websockets.sync.client.connect(
        address, subprotocols=[Subprotocol(SUBPROTOCOL)], compression=None
    ) as socket:
        socket.send(packed("ViewerCameraMessage", **CAMERA))
        wait_for(server.get_clients, 30.0)
        (client,) = server.get_clients().values()
        yield client, socket


def told_until(socket: Any, last: str) -> list[list[str]]:
    """What a browser is told of nodes, frame by frame, until the node `last` is updated.

    A node's name, marked when it is made anew.
    """
    frames: list[list[str]] = []
    while not any(last in frame for frame in frames):
        messages = [m for m in unpacked(socket.recv(timeout=10)) if m.get("name", "")[1:].isdigit()]
        made = ["" if "updates" in m else "new " for m in messages]
        frames.append([how + m["name"] for how, m in zip(made, messages, strict=True)])
    return [frame for frame in frames if frame]


def test_what_one_thread_tells_in_a_frame_arrives_at_once_and_in_order(
    server: viser.ViserServer,
) -> None:
    with browser(server) as (client, socket):
        channel = FrameChannel(client)
        names = [f"/{i}" for i in range(5)]
        nodes = [client.scene.add_point_cloud(n, np.zeros((1, 3)), (0, 0, 0)) for n in names]
        for node in nodes[:2]:  # nodes wait in viser's queue: these must wait behind them
            with channel:
                update_node(node, points=np.ones((1, 3)))
            channel.send()
        told = [name for frame in told_until(socket, "/1") for name in frame]
        assert all(told.index(f"new {name}") < told.index(name) for name in names[:2])
        with channel:
            for node in nodes[2:4]:
                update_node(node, points=np.ones((1, 3)))
            other = Thread(target=lambda: update_node(nodes[4], points=np.ones((1, 3))))
            other.start()
            other.join()
            assert told_until(socket, "/4") == [["/4"]]  # another thread waits for nothing
        channel.send()
        assert told_until(socket, "/3") == [["/2", "/3"]]
        channel.send()  # nothing is sent twice
        update_node(nodes[0], points=np.zeros((1, 3)))
        assert told_until(socket, "/0") == [["/0"]]


def test_nothing_is_sent_to_a_browser_that_has_gone(
    server: viser.ViserServer, recwarn: pytest.WarningsRecorder
) -> None:
    with browser(server) as (client, _):
        channel = FrameChannel(client)
        node = client.scene.add_point_cloud("/node", np.zeros((1, 3)), (0, 0, 0))
        assert not channel.closed
    wait_for(lambda: not server.get_clients(), 30.0)
    assert channel.closed
    with channel:
        update_node(node, points=np.ones((1, 3)))
    channel.send()
    done = Event()
    server.get_event_loop().call_soon_threadsafe(done.set)
    assert done.wait(5.0) and not recwarn.list


def test_what_a_thread_tells_while_the_network_wakes_up_is_told(
    server: viser.ViserServer, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Then asyncio's event raises an error in that thread, see `MessageEvent`."""
    with browser(server) as (client, socket):
        wake, ours = asyncio.Event.set, get_ident()

        def set_(event: asyncio.Event) -> None:
            wake(event)
            if get_ident() == ours:
                raise RuntimeError("deque mutated during iteration")

        monkeypatch.setattr(asyncio.Event, "set", set_)
        for name in ("/0", "/1"):
            client.scene.add_point_cloud(name, np.zeros((1, 3)), (0, 0, 0))
        assert [name for frame in told_until(socket, "new /1") for name in frame]
        server.scene.add_point_cloud("/2", np.zeros((1, 3)), (0, 0, 0))
        assert [name for frame in told_until(socket, "new /2") for name in frame]
