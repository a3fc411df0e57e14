"""The client end of a websocket at the byte level, for simulating misbehaving clients."""

from __future__ import annotations

import select
import socket

from websockets.frames import Frame, Opcode
from websockets.sync.client import ClientConnection

from onpath.app.server.arrivals import PAGE_KEY
from tests.bench.client_protocol import SUBPROTOCOL, answer, unpacked

WAIT = 10.0  # [s]


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


def answer_question(client: ClientConnection, page: str) -> None:
    """Answer the question to which page a new client belongs."""
    while True:
        raw = client.recv(WAIT)
        assert isinstance(raw, bytes)
        if replies := list(filter(None, (answer(m, {PAGE_KEY: page}) for m in unpacked(raw)))):
            return client.send(replies[0])
