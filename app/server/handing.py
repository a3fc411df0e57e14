"""One address for several processes: one accepts, and hands each connection to who has fewest.

Left to itself, the kernel spreads connections by chance over processes that share a port: sixty
students may be 23 on one core and 37 on the other.
"""

from __future__ import annotations

import os
import selectors
import socket
from contextlib import suppress
from typing import Any

CHANNEL = "ONPATH_CHANNEL"  # in a worker's environment: the descriptor of its end
CAN_HAND = hasattr(socket, "send_fds")
SAID = b"."  # by a worker: it is ready, and then for each connection that it has closed


class Reception:
    """Accepts connections for the workers that have joined; their ends are channels to us.

    Args:
        listener: where they come; accepted from as soon as a worker is ready.
    """

    def __init__(self, listener: socket.socket) -> None:
        listener.setblocking(False)
        self._listener = listener
        self._open: dict[socket.socket, int] = {}  # connections of those that are ready
        self._selector = selectors.DefaultSelector()

    def join(self) -> socket.socket:
        """The other end of a new channel, for a worker; see `CHANNEL`."""
        ours, theirs = socket.socketpair()
        ours.setblocking(False)
        self._selector.register(ours, selectors.EVENT_READ)
        return theirs

    def attend(self, seconds: float) -> None:
        """Do what there is to do, or wait so long for it."""
        for key, _ in self._selector.select(seconds):
            found: Any = key.fileobj
            if found is not self._listener:
                self._listen_to(found)
            elif self._open:  # the last of them may have ended just now
                self._accept()

    def close(self) -> None:
        """Accept no more."""
        self._selector.close()
        self._listener.close()

    def _accept(self) -> None:
        try:
            connection, _ = self._listener.accept()
        except OSError:  # who came is gone
            return
        with connection:
            for channel in sorted(self._open, key=lambda channel: self._open[channel]):
                with suppress(OSError):  # it has ended, or is stuck
                    socket.send_fds(channel, [SAID], [connection.fileno()])
                    self._open[channel] += 1
                    return

    def _listen_to(self, channel: socket.socket) -> None:
        try:
            said = channel.recv(4096)
        except OSError:
            said = b""
        if not said:
            self._selector.unregister(channel)
            channel.close()
            if self._open.pop(channel, None) is not None and not self._open:
                self._selector.unregister(self._listener)
            return
        if not self._open:
            self._selector.register(self._listener, selectors.EVENT_READ)
        self._open[channel] = self._open.get(channel, 1) - len(said)


def handed(host: str, port: int) -> Handed | None:
    """Where this process gets the connections to an address, if another one hands them to it."""
    number = os.environ.get(CHANNEL)
    return None if number is None else Handed(int(number), (host, port))


class Handed(socket.socket):
    """A worker's end of its channel: to asyncio it is a socket that listens at an address."""

    def __init__(self, descriptor: int, address: tuple[str, int]) -> None:
        super().__init__(fileno=descriptor)
        self._address = address

    def getsockname(self) -> tuple[str, int]:
        """The address."""
        return self._address

    def listen(self, backlog: int = 0, /) -> None:
        """Be ready."""
        self.send(SAID)

    def accept(self) -> tuple[socket.socket, Any]:
        """A connection that has been handed over, and whose it is.

        Raises:
            BlockingIOError: there is none.
            ConnectionAbortedError: who came is gone.
        """
        _, descriptors, _, _ = socket.recv_fds(self, 1, 1)
        if not descriptors:
            raise BlockingIOError
        connection = _WorkerConnection(fileno=descriptors[0])
        connection.channel = self
        try:
            return connection, connection.getpeername()
        except OSError:
            connection.close()
            raise ConnectionAbortedError from None


class _WorkerConnection(socket.socket):
    """Says when it is closed.

    Attributes:
        channel: to whom.
    """

    channel: socket.socket

    def close(self) -> None:
        """Once."""
        is_open = self.fileno() >= 0
        super().close()
        if is_open:
            with suppress(OSError):  # nobody listens any more
                self.channel.send(SAID)
