"""A stand-in for a process of the lab behind a proxy: it takes every websocket and does no more."""

from __future__ import annotations

import socket
import struct
import threading
from contextlib import suppress

NAME = "X-Stand-In"
RESET = struct.pack("ii", 1, 0)  # a socket that lingers for 0 s is reset when it is closed


class StandIn:
    """A server at a port that can be killed and started again.

    Args:
        name: which it answers with, in the header `NAME`.

    Attributes:
        asked: the paths of all requests, as they came.
    """

    def __init__(self, port: int, name: str) -> None:
        self.port, self.name = port, name
        self.asked: list[str] = []
        self._listener: socket.socket | None = None
        self._open = set[socket.socket]()

    @property
    def runs(self) -> bool:
        """Whether it has been started."""
        return self._listener is not None

    def start(self) -> None:
        """Listen and answer."""
        self._listener = socket.create_server(("127.0.0.1", self.port), backlog=500)
        threading.Thread(target=self._serve, args=(self._listener,), daemon=True).start()

    def kill(self) -> None:
        """End as kill -9 ends a process: all connections are reset."""
        listener, self._listener = self._listener, None
        if listener is not None:
            with suppress(OSError):
                listener.shutdown(socket.SHUT_RDWR)  # ends the thread's accept
            listener.close()
        while self._open:
            guest = self._open.pop()
            guest.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, RESET)
            with suppress(OSError):
                guest.shutdown(socket.SHUT_RDWR)
            guest.close()

    def _serve(self, listener: socket.socket) -> None:
        with suppress(OSError):
            while True:
                guest = listener.accept()[0]
                self._open.add(guest)
                threading.Thread(target=self._answer, args=(guest,), daemon=True).start()

    def _answer(self, guest: socket.socket) -> None:
        text = b""
        with suppress(OSError):
            while b"\r\n\r\n" not in text:
                more = guest.recv(1 << 16)
                if not more:
                    return
                text += more
            self.asked.append(text.split(b" ")[1].decode("latin-1"))
            if b"\r\nupgrade:" in text.lower():
                status = "101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade"
            else:
                status = "200 OK\r\nContent-Length: 0"
            guest.sendall(f"HTTP/1.1 {status}\r\n{NAME}: {self.name}\r\n\r\n".encode())
