"""Simulated browsers do what real ones do, and the shortcuts for many of them change nothing."""

from __future__ import annotations

import asyncio
from collections.abc import Iterator
from contextlib import aclosing, contextmanager
from pathlib import Path
from socket import create_server
from threading import Event, Thread
from time import sleep
from typing import Any

import numpy as np
import pytest
import viser
import websockets.exceptions
import websockets.sync.client
from lab import FOLLOWER
from viser import uplot
from websockets.typing import Subprotocol

from app.hardening import make_server
from app.load import Seen, Unserved, crowd, first_poses
from app.loop_store import LoopStore
from app.node_update import Channel, update_node, update_plot
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


def test_a_plot_is_told_what_an_assignment_tells(server: viser.ViserServer) -> None:
    lines = np.arange(6.0).reshape(2, 3)
    series = (uplot.Series(label="x"), uplot.Series(label="y"))
    with browser(server) as (client, socket):
        plots = [client.gui.add_uplot((np.zeros(2), np.zeros(2)), series) for _ in range(2)]
        plots[0].data = tuple(lines)
        update_plot(plots[1], lines)
        kept = lines.copy()
        lines += 1  # nobody may hold on to what was given
        updates: list[Any] = []
        while len(updates) < 2:
            messages = unpacked(socket.recv(timeout=10))
            updates += [m for m in messages if "data" in m.get("updates", {})]
    assert [m["uuid"] for m in updates] == [plot._impl.uuid for plot in plots]
    assert updates[0]["type"] == updates[1]["type"]
    for one, other in zip(*(m["updates"]["data"] for m in updates), strict=True):
        assert one.dtype == other.dtype and np.array_equal(one, other)
    assert np.array_equal(np.array(plots[1].data), kept)


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
    async def look(port: int) -> list[Seen]:
        async with aclosing(crowd(port, 2, seconds=4.5)) as seen:
            return [await anext(seen) for _ in range(2)]

    server = LabServer("127.0.0.1", 0, LoopStore(None, tmp_path))
    try:
        first, then = asyncio.run(look(server.server.get_port()))
        labs = server.simulation.labs
    finally:
        server.stop()
    assert first.clients == then.clients == 2
    assert then.seconds == pytest.approx(4.5, abs=0.5)
    assert 10 < then.slowest_hz <= then.median_hz < 62
    assert then.bytes_per_s > 0 and 0 < then.cpu < 1.5
    assert all(lab.session.time > 1.0 for lab in labs)
    assert max(run.max_distance for lab in labs for run in lab.session.runs.values()) > 0.004
    assert any(lab.session.parameters.K1 != 400.0 for lab in labs)


def test_a_crowd_that_is_not_served_says_so(tmp_path: Path) -> None:
    async def settle(port: int, patience: float) -> None:
        async with aclosing(crowd(port, 2, 1.0, patience)) as seen:
            await anext(seen)

    server = LabServer("127.0.0.1", 0, LoopStore(None, tmp_path), most_clients=1)
    try:
        with pytest.raises(Unserved, match=r"only 1 of 2 clients .* moving robots in 3 s"):
            asyncio.run(settle(server.server.get_port(), 3.0))
    finally:
        server.stop()
    with (
        answering(REFUSED, REFUSED) as (port, _),
        pytest.raises(Unserved, match=r"turned away: .*503"),
    ):
        asyncio.run(settle(port, 5.0))


@contextmanager
def browser(server: viser.ViserServer) -> Iterator[tuple[viser.ClientHandle, Any]]:
    """A client as the server knows it, and its socket."""
    address = f"ws://127.0.0.1:{server.get_port()}"
    with websockets.sync.client.connect(
        address, subprotocols=[Subprotocol(SUBPROTOCOL)], compression=None
    ) as socket:
        socket.send(packed("ViewerCameraMessage", **CAMERA))
        while not server.get_clients():
            sleep(0.01)
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
        channel = Channel(client)
        names = [f"/{i}" for i in range(5)]
        nodes = [client.scene.add_point_cloud(n, np.zeros((1, 3)), (0, 0, 0)) for n in names]
        for node in nodes[:2]:  # nodes wait in viser's queue: these must wait behind them
            with channel.frame():
                update_node(node, points=np.ones((1, 3)))
            channel.send()
        told = [name for frame in told_until(socket, "/1") for name in frame]
        assert all(told.index(f"new {name}") < told.index(name) for name in names[:2])
        with channel.frame():
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


def test_nobody_is_told_anything_when_he_is_gone(
    server: viser.ViserServer, recwarn: pytest.WarningsRecorder
) -> None:
    with browser(server) as (client, _):
        channel = Channel(client)
        node = client.scene.add_point_cloud("/node", np.zeros((1, 3)), (0, 0, 0))
        assert not channel.closed
    while server.get_clients():
        sleep(0.01)
    assert channel.closed
    with channel.frame():
        update_node(node, points=np.ones((1, 3)))
    channel.send()
    done = Event()
    server.get_event_loop().call_soon_threadsafe(done.set)
    assert done.wait(5.0) and not recwarn.list


REFUSED = b"HTTP/1.1 503 Service Unavailable\r\nContent-Length: 0\r\nConnection: close\r\n\r\n"


@contextmanager
def answering(*answers: bytes) -> Iterator[tuple[int, Thread]]:
    """A port where each connection gets one of these answers in turn, then none is taken."""

    def serve() -> None:
        for answer in answers:
            connection, _ = listener.accept()
            with connection:
                connection.recv(4096)
                connection.sendall(answer)
        listener.close()

    with create_server(("127.0.0.1", 0)) as listener:
        thread = Thread(target=serve, daemon=True)
        thread.start()
        yield int(listener.getsockname()[1]), thread


def test_the_bench_waits_for_a_server_that_is_not_ready(tmp_path: Path) -> None:
    async def wait(port: int, early: Thread) -> None:
        waiting = asyncio.create_task(first_poses(port))
        await asyncio.to_thread(early.join, 5.0)
        assert not early.is_alive() and not waiting.done()
        server = LabServer("127.0.0.1", port, LoopStore(None, tmp_path))
        try:
            await asyncio.wait_for(waiting, 20.0)
        finally:
            server.stop()

    with answering(REFUSED, b"", b"HTTP/1.1 ") as (port, early):
        asyncio.run(wait(port, early))


def test_the_bench_does_not_wait_for_a_server_that_refuses() -> None:
    forbidden = REFUSED.replace(b"503", b"403")
    with answering(forbidden) as (port, _), pytest.raises(websockets.exceptions.InvalidStatus):
        asyncio.run(asyncio.wait_for(first_poses(port), 5.0))
