"""One address for several processes: one accepts, and dispatches to the least-loaded worker.

If the processes shared the port, the kernel would distribute connections at random: of sixty
students, 23 might be on one core and 37 on the other.
"""

from __future__ import annotations

import os
import selectors
import socket
from contextlib import suppress
from typing import Any

CHANNEL = "ONPATH_CHANNEL"  # environment variable of a worker: file descriptor of its channel
CAN_HAND_OVER = hasattr(socket, "send_fds")
SIGNAL = b"."  # sent by a worker when it is ready, and for every connection that it has closed


class Reception:
    """Accepts connections, and passes them to the workers through their channels.

    Args:
        listener: the listening socket; connections are accepted once a worker is ready.
    """

    def __init__(self, listener: socket.socket) -> None:
        listener.setblocking(False)
        self._listener = listener
        self._open: dict[socket.socket, int] = {}  # open connections of the workers that are ready
        self._selector = selectors.DefaultSelector()

    def join(self) -> socket.socket:
        """A new channel; returns the worker's end, see `CHANNEL`."""
        ours, theirs = socket.socketpair()
        ours.setblocking(False)
        self._selector.register(ours, selectors.EVENT_READ)
        return theirs

    def attend(self, seconds: float) -> None:
        """Process events, waiting up to `seconds` for the first."""
        for key, _ in self._selector.select(seconds):
            found: Any = key.fileobj
            if found is not self._listener:
                self._listen_to(found)
            elif self._open:  # the last worker may have just ended
                self._accept()

    def close(self) -> None:
        """Stop accepting."""
        self._selector.close()
        self._listener.close()

    def _accept(self) -> None:
        try:
            connection, _ = self._listener.accept()
        except OSError:  # the client has disconnected
            return
        with connection:
            for channel in sorted(self._open, key=lambda channel: self._open[channel]):
                with suppress(OSError):  # the worker has ended, or does not read
                    socket.send_fds(channel, [SIGNAL], [connection.fileno()])
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


def handover_socket(host: str, port: int) -> HandoverSocket | None:
    """The socket from which this process gets connections, if another one accepts them."""
    number = os.environ.get(CHANNEL)
    return None if number is None else HandoverSocket(int(number), (host, port))


class HandoverSocket(socket.socket):
    """A worker's end of its channel. asyncio uses it like a listening socket."""

    def __init__(self, descriptor: int, address: tuple[str, int]) -> None:
        super().__init__(fileno=descriptor)
        self._address = address

    def getsockname(self) -> tuple[str, int]:
        """The address."""
        return self._address

    def listen(self, backlog: int = 0, /) -> None:
        """Report that this worker is ready."""
        self.send(SIGNAL)

    def accept(self) -> tuple[socket.socket, Any]:
        """A connection that was handed over, and the client's address.

        Raises:
            BlockingIOError: there is none.
            ConnectionAbortedError: the client has disconnected.
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
    """A connection that reports when it is closed.

    Attributes:
        channel: to which it reports.
    """

    channel: socket.socket

    def close(self) -> None:
        """Close, and report it the first time."""
        is_open = self.fileno() >= 0
        super().close()
        if is_open:
            with suppress(OSError):  # the accepting process has ended
                self.channel.send(SIGNAL)
