"""The client end of a websocket at the byte level, for simulating misbehaving clients."""

from __future__ import annotations

import select
import socket
from collections.abc import Mapping

from websockets.frames import Frame, Opcode
from websockets.sync.client import ClientConnection

from tests.bench.client_protocol import SUBPROTOCOL, answer, unpacked

WAIT = 10.0  # [s]
QUESTIONS = 2  # number of a lab's questions to a new client


def frames(*payloads: bytes, opcode: Opcode = Opcode.BINARY) -> bytes:
    """Bytes that a browser would write to its socket."""
    return b"".join(Frame(opcode, payload).serialize(mask=True) for payload in payloads)


def handshake(port: int, subprotocol: str | None = SUBPROTOCOL) -> bytes:
    """The request for a websocket."""
    lines = [
        "GET / HTTP/1.1",
        f"Host: 127.0.0.1:{port}",
        "Upgrade: websocket",
        "Connection: Upgrade",
        "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==",
        "Sec-WebSocket-Version: 13",
        *([f"Sec-WebSocket-Protocol: {subprotocol}"] if subprotocol is not None else []),
    ]
    return ("\r\n".join(lines) + "\r\n\r\n").encode()


def knock(
    port: int, subprotocol: str | None = SUBPROTOCOL, source: str = "127.0.0.1"
) -> socket.socket:
    """Open a socket and send the websocket handshake, without reading the answer."""
    raw = socket.create_connection(("127.0.0.1", port), WAIT, source_address=(source, 0))
    raw.sendall(handshake(port, subprotocol))
    return raw


def say(raw: socket.socket, *payloads: bytes, opcode: Opcode = Opcode.BINARY) -> None:
    """Write messages once the handshake is answered: until then, a server may ignore them."""
    raw.recv(1, socket.MSG_PEEK)
    raw.sendall(frames(*payloads, opcode=opcode))


def is_closed(raw: socket.socket) -> bool:
    """Whether the other end has closed; discards what has been received."""
    try:
        while select.select([raw], [], [], 0)[0]:
            if not raw.recv(1 << 16):
                return True
    except OSError:
        return True
    return False


def answer_questions(client: ClientConnection, stored: Mapping[str, str] | None = None) -> None:
    """Answer the initial questions to a new client, but no later ones."""
    answered = 0
    while answered < QUESTIONS:
        raw = client.recv(WAIT)
        assert isinstance(raw, bytes)
        for reply in filter(None, (answer(message, stored) for message in unpacked(raw))):
            client.send(reply)
            answered += 1
