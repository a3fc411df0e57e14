"""Messages of which only a part comes: bounded memory, for a bounded time."""

from __future__ import annotations

import select
import socket
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import partial
from typing import Any

import pytest
import viser
from websockets.frames import Frame, Opcode

from onpath.app.viser_adapter.secure_connection import SecureConnection
from onpath.app.viser_adapter.secure_server import Limits, make_server
from tests.bench.client_protocol import CAMERA, packed
from tests.bench.raw_socket import frames, is_closed, knock
from tests.support import waiting

WAIT = 20.0  # [s]; only ends a test that would hang
PENDING = 10.0  # [s] after which websockets closes what is no complete request
PART = 100_000  # [B]
LONG = 3600.0  # [s]
ANNOUNCED = b"\x82\xff" + (900_000).to_bytes(8, "big") + bytes(4)
wait_for = partial(waiting.wait_for, seconds=WAIT)


def fragment(size: int, opcode: Opcode = Opcode.BINARY) -> bytes:
    """The first part of a message of several frames."""
    return Frame(opcode, bytes(size), fin=False).serialize(mask=True)


def one_frame(size: int) -> bytes:
    """The first part of a single frame."""
    return ANNOUNCED + bytes(size)


PARTS: list[Callable[[int], bytes]] = [fragment, one_frame]


@contextmanager
def serving(**limits: Any) -> Iterator[viser.ViserServer]:
    server = make_server(port=0, limits=Limits(**limits))
    yield server
    server.stop()


def tabs(server: viser.ViserServer, count: int) -> list[socket.socket]:
    """Connections that have been admitted."""
    made = [knock(server.get_port()) for _ in range(count)]
    for raw in made:
        wait_for(lambda raw=raw: select.select([raw], [], [], 0)[0])
    return made


def held(server: viser.ViserServer) -> int:
    """By unfinished messages, as the server counts, [B]."""
    sockets = list(server._websock_server._live_connections.values())
    guarded = [each for each in sockets if isinstance(each, SecureConnection)]
    return guarded[0]._unfinished._total if guarded else 0


@pytest.mark.parametrize("part", PARTS)
def test_together_they_stay_within_a_budget(part: Callable[[int], bytes]) -> None:
    with serving(max_unfinished_bytes=5 * PART, message_seconds=LONG) as server:
        (honest, *hostile) = tabs(server, 13)
        message = frames(packed("ViewerCameraMessage", **CAMERA))
        honest.sendall(message[:20])
        for raw in hostile:
            raw.sendall(part(PART))
        wait_for(lambda: sum(map(is_closed, hostile)) == 8)
        wait_for(lambda: 4 * PART <= held(server) <= 5 * PART)
        assert not is_closed(honest)  # who holds most goes first
        honest.sendall(message[20:])
        wait_for(server.get_clients)
        for raw in hostile:
            raw.close()
        wait_for(lambda: held(server) == 0)
        honest.close()


@pytest.mark.parametrize("part", PARTS)
def test_a_message_that_never_ends_closes_its_sender(part: Callable[[int], bytes]) -> None:
    with serving(message_seconds=0.2) as server:
        (raw,) = tabs(server, 1)
        raw.sendall(part(10))
        wait_for(lambda: is_closed(raw))
        wait_for(lambda: not server._websock_server._live_connections)
        raw.close()


def test_a_message_that_arrives_byte_by_byte_is_closed_too() -> None:
    with serving(message_seconds=0.2) as server:
        (raw,) = tabs(server, 1)
        raw.sendall(ANNOUNCED)

        def goes_on() -> bool:
            try:
                raw.sendall(b"x")
            except OSError:
                return False
            return not is_closed(raw)

        wait_for(lambda: not goes_on())
        raw.close()


def test_complete_messages_in_pieces_have_no_total_time_limit() -> None:
    """The time of a message begins with it, though the one before was in the same packet."""
    message = frames(packed("ViewerCameraMessage", **CAMERA))
    with serving(message_seconds=LONG) as server:
        (raw,) = tabs(server, 1)
        raw.sendall(message + message[:9])
        (connection,) = wait_for(lambda: list(server._websock_server._live_connections.values()))
        wait_for(lambda: connection._deadline)
        first = connection._deadline
        raw.sendall(message[9:] + message[:11])
        wait_for(lambda: connection._deadline is not first and connection._deadline)
        assert first.cancelled() and not connection._deadline.cancelled()
        raw.sendall(message[11:])
        wait_for(lambda: connection._deadline is None and held(server) == 0)
        assert not is_closed(raw)
        raw.close()


def test_a_request_has_a_size() -> None:
    lines = b"GET / HTTP/1.1\r\n" + b"".join(
        b"X%d: " % n + b"x" * 8000 + b"\r\n" for n in range(60)
    )
    with (
        serving(max_request_bytes=65_536) as server,
        socket.create_connection(("127.0.0.1", server.get_port())) as raw,
    ):
        raw.sendall(lines[:60_000])
        assert not is_closed(raw)
        with suppress(OSError):
            raw.sendall(lines[60_000:])
        waiting.wait_for(lambda: is_closed(raw), PENDING / 2)
