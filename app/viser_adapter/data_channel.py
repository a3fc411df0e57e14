"""The websocket of our own part of a page: data for it, and commands; see README.md.

A page opens it at its own address, before viser's, and it passes the same checks. Its subprotocol
tells the two apart. The first message greets the server, which then decides what the page is told.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Sequence
from contextlib import suppress
from functools import partial

from websockets.exceptions import ConnectionClosed
from websockets.frames import CloseCode
from websockets.protocol import State

from onpath.app.common.error_log import log_error
from onpath.app.viser_adapter.secure_connection import SecureConnection

FAMILY = "onpath-"
SUBPROTOCOL = f"{FAMILY}3"
GREETING = 90.0  # [s] within which the greeting must come; a page and its network may be slow
NO_GREETING = 4001  # websocket close code: the first message was no valid greeting
MOST_UNSENT = 1 << 16  # [B] unsent, beyond which a page gets no further data
AGAIN = 0.05  # [s] until sending to a page that reads slowly is tried again

Message = Callable[[], bytes]
"""Makes a message; called on the network thread."""


class PageStream:
    """What one page is told, whether or not it is connected.

    Args:
        left: called on the event loop when the page's connection has ended, and no other has come.

    Attributes:
        receive: called on the event loop with each message of the page; returns the answer, or
            nothing.
        opened: how often it has been opened; each time, a page knows nothing yet.
        is_busy: whether the last messages have not been sent, because the page reads slowly. Then
            no others may be handed over.
    """

    def __init__(self, channel: DataChannel, left: Callable[[], None] = lambda: None) -> None:
        self._channel, self._left = channel, left
        self._connection: SecureConnection | None = None
        self._ending: asyncio.Task[None] | None = None  # else it might be collected
        self.receive: Callable[[str], bytes] = ignored
        self.opened, self.is_busy = 0, False

    @property
    def is_open(self) -> bool:
        """Whether a page listens."""
        return self._connection is not None

    def hand_over(self, *messages: Message) -> None:
        """Send messages with the next `DataChannel.send`. Call it in the simulation thread."""
        self.is_busy = True
        self._channel.take(self, messages)

    def say(self, message: bytes) -> None:
        """Send a message at once; it is lost if the page is not connected. Thread-safe."""
        self._channel.call(partial(self._say, message))

    # On the event loop

    async def serve(self, connection: SecureConnection) -> None:
        """Serve a page's connection until it ends or another one comes."""
        before, self._connection = self._connection, connection
        self.is_busy = False
        self.opened += 1
        if before is not None:
            closing = before.close(CloseCode.GOING_AWAY, "this page has opened another connection")
            self._ending = connection.loop.create_task(closing)
        try:
            while True:
                text = await connection.recv_data()
                if not isinstance(text, str):
                    await connection.close(CloseCode.UNSUPPORTED_DATA, "expected text")
                    return
                if connection.counts_change() and (answer := self.receive(text)):
                    await connection.send(answer, text=True)
        finally:
            if self._connection is connection:
                self._connection, self.is_busy = None, False
                self._left()

    def write(self, messages: Sequence[Message]) -> None:
        """Send messages, or wait until less is unsent."""
        if self._connection is None:
            self.is_busy = False
        else:
            self._write_to(self._connection, messages)

    def _write_to(self, connection: SecureConnection, messages: Sequence[Message]) -> None:
        if connection is not self._connection or connection.protocol.state is not State.OPEN:
            return  # its successor is told everything
        if connection.transport.get_write_buffer_size() > MOST_UNSENT:
            connection.loop.call_later(AGAIN, self._write_to, connection, messages)
            return
        self.is_busy = False
        for message in messages:
            connection.protocol.send_text(message())
        connection.send_data()

    def end(self) -> None:
        """Begin to close the connection, if there is one; its page connects again."""
        self.receive = ignored  # its owner refers to this stream
        connection, self._connection, self.is_busy = self._connection, None, False
        if connection is not None:
            closing = connection.close(CloseCode.SERVICE_RESTART, "the lab has moved")
            self._ending = connection.loop.create_task(closing)

    def _say(self, message: bytes) -> None:
        connection = self._connection
        if connection is not None and connection.protocol.state is State.OPEN:
            connection.protocol.send_text(message)
            connection.send_data()


Greet = Callable[[str, SecureConnection], PageStream | None]


class DataChannel:
    """The data channels of all pages of a server.

    Args:
        greet: called on the event loop with the first message of each connection; returns what its
            page is told, or None if the message is no valid greeting.
    """

    def __init__(self, greet: Greet = lambda *_: None) -> None:
        self._greet = greet
        self._loop: asyncio.AbstractEventLoop | None = None
        self._ready: list[tuple[PageStream, Sequence[Message]]] = []

    async def handle(self, connection: SecureConnection) -> None:
        """Serve a connection, from its greeting on."""
        self._loop = connection.loop
        with suppress(ConnectionClosed):
            try:
                async with asyncio.timeout(GREETING):
                    text = await connection.recv_data()
            except TimeoutError:
                await connection.close(CloseCode.TRY_AGAIN_LATER, "expected a greeting")
                return
            stream = self._greet(text, connection) if isinstance(text, str) else None
            if stream is None:
                await connection.close(NO_GREETING, "expected a valid greeting")
            else:
                await stream.serve(connection)

    def call(self, act: Callable[[], None]) -> None:
        """Call a function on the event loop. Thread-safe."""
        if self._loop is not None:
            with suppress(RuntimeError):  # the server has stopped
                self._loop.call_soon_threadsafe(act)

    def take(self, stream: PageStream, messages: Sequence[Message]) -> None:
        """Keep messages until `send`."""
        self._ready.append((stream, messages))

    def send(self) -> None:
        """Send what has been handed over, with one call of the event loop."""
        if self._ready:
            ready, self._ready = self._ready, []
            self.call(partial(_write, ready))


def ignored(_: str) -> bytes:
    """Receive a message for which nobody waits."""
    return b""


def _write(ready: list[tuple[PageStream, Sequence[Message]]]) -> None:
    for stream, messages in ready:
        try:
            stream.write(messages)
        except Exception as error:  # the other pages get theirs
            log_error(error)
