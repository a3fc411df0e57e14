"""Scenes and connections are free as soon as they end, without a collection of garbage."""

from __future__ import annotations

import gc
import socket
import threading
import weakref
from collections.abc import Iterator
from typing import Any

import pytest

from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.server.lab_server import LabServer
from onpath.app.viser_adapter.connection_limits import CountedConnection
from onpath.app.viser_adapter.scene_release import release_scene
from onpath.app.viser_adapter.secure_server import make_server
from tests.bench.client_protocol import CAMERA, packed
from tests.bench.raw_socket import frames, knock
from tests.support.own_socket import feeds
from tests.support.student import Student
from tests.support.waiting import wait_for

WAIT = 20.0  # [s]


@pytest.fixture
def server() -> Iterator[LabServer]:
    """A server in a process that collects no garbage."""
    server = LabServer("127.0.0.1", 0, LoopCache())
    gc.disable()
    yield server
    gc.enable()
    server.stop()


def arrived(server: LabServer) -> Student:
    """A tab whose page is shown."""
    student = Student(f"ws://127.0.0.1:{server.server.get_port()}")
    student.open()
    student.read(lambda: student.moving > 5)
    return student


def parts_of(server: LabServer) -> list[weakref.ref[Any]]:
    """What the only scene is made of."""
    (feed,), (client,) = feeds(server).values(), server.server.get_clients().values()
    shown: Any = feed.scene
    nodes = client.scene._handle_from_node_name.values()
    assert nodes
    return [weakref.ref(part) for part in (shown._scene, shown._overlays, *nodes)]


def test_a_scene_is_free_as_soon_as_its_tab_closes(server: LabServer) -> None:
    student = arrived(server)
    parts = parts_of(server)
    student.close()
    wait_for(lambda: not any(part() for part in parts), WAIT)


def test_a_scene_that_is_built_anew_leaves_nothing(server: LabServer) -> None:
    student = arrived(server)
    parts = parts_of(server)
    student.tell({"is": "dark", "on": True})
    student.read(lambda: not any(part() for part in parts))
    student.close()


def test_what_was_not_sent_is_forgotten(server: LabServer) -> None:
    student = arrived(server)
    (client,) = server.server.get_clients().values()
    buffer = client._websock_connection.get_message_buffer()
    may_send = threading.Event()
    server.server.get_event_loop().call_soon_threadsafe(may_send.wait, WAIT)
    client.scene.add_box("/never_seen")
    assert buffer.message_from_id
    release_scene(client)
    assert not buffer.message_from_id
    may_send.set()
    student.close()


GREETING = frames(packed("ViewerCameraMessage", **CAMERA))
SAID = {
    "nothing": b"",
    "a greeting": GREETING,
    "an unfinished message": GREETING[:-5],
    "no message": frames(b"nonsense"),
    "no frame": b"\xff\xff nonsense",
}


class Connections:
    """A server in a process that collects no garbage, and what its connections are made of."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self._parts, opened = list[list[weakref.ref[Any]]](), CountedConnection.connection_made

        def connection_made(connection: CountedConnection, transport: Any) -> None:
            parts = (connection, connection.protocol.reader, transport)
            self._parts.append([weakref.ref(part) for part in parts])
            opened(connection, transport)

        monkeypatch.setattr(CountedConnection, "connection_made", connection_made)
        self.server = make_server(port=0)
        self.port = self.server.get_port()

    def are_free(self, number: int) -> bool:
        """Whether so many have been made, and all but the last one are free."""
        freed = [not any(part() for part in parts) for parts in self._parts[:-1]]
        return len(self._parts) == number and all(freed)


@pytest.fixture
def connections(monkeypatch: pytest.MonkeyPatch) -> Iterator[Connections]:
    connections = Connections(monkeypatch)
    gc.disable()
    yield connections
    gc.enable()
    connections.server.stop()


@pytest.mark.parametrize("said", SAID.values(), ids=SAID)
def test_a_websocket_is_free_as_soon_as_it_ends(connections: Connections, said: bytes) -> None:
    for _ in range(3):
        tab = knock(connections.port)
        assert tab.recv(1)
        tab.sendall(said)
        tab.close()
    wait_for(lambda: connections.are_free(3), WAIT)


@pytest.mark.parametrize(
    "said", [b"", b"nonsense\r\n\r\n", b"GET /none HTTP/1.1\r\nHost: a\r\n\r\n"]
)
def test_a_connection_that_is_no_tab_is_free_as_soon_as_it_ends(
    connections: Connections, said: bytes
) -> None:
    """Without a collection, until which thousands could come and go."""
    for _ in range(3):
        with socket.create_connection(("127.0.0.1", connections.port)) as client:
            client.sendall(said)
            client.shutdown(socket.SHUT_WR)
            while client.recv(4096):
                pass
    wait_for(lambda: connections.are_free(3), WAIT)
