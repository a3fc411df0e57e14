"""The second websocket of a page: data for our own part of it, and commands; see README.md.

It is opened at the same address as viser's and passes the same checks. Its subprotocol tells them
apart. A page that viser's checks have let in is given a ticket through viser's websocket, which its
script sends first; without it, nothing is sent or read. A ticket ends with its page.
"""

from __future__ import annotations

import asyncio
import secrets
from collections.abc import Callable, Sequence
from contextlib import suppress
from weakref import WeakValueDictionary

import msgspec
from websockets.exceptions import ConnectionClosed
from websockets.frames import CloseCode
from websockets.protocol import State

from onpath.app.common.error_log import log_error
from onpath.app.viser_adapter.secure_connection import SecureConnection

VERSION = 2
FAMILY = "onpath-"
SUBPROTOCOL = f"{FAMILY}{VERSION}"
GREETING = 90.0  # [s] within which the ticket must come; a page may be slow, and so may be its way
NO_TICKET = 4001  # closes a connection whose ticket is not valid: the page needs another one
TICKET = 24  # random bytes of a ticket
MOST_UNSENT = 1 << 16  # [B] unsent, beyond which a page gets no further data
AGAIN = 0.05  # [s] until a page that reads slowly is tried again

Message = Callable[[], bytes]
"""Makes a message; called on the network thread."""


class Hello(msgspec.Struct, frozen=True, forbid_unknown_fields=True, tag_field="is", tag="hello"):
    """The first message of a page.

    Attributes:
        ticket: that the page was given.
    """

    ticket: str


def ticket_in(message: object) -> str:
    """The ticket in a page's first message; empty if it has none."""
    try:
        return msgspec.json.decode(message, type=Hello).ticket if isinstance(message, str) else ""
    except (ValueError, RecursionError):
        return ""


class PageStream:
    """The data channel of one page, whether or not a script has opened it.

    Attributes:
        ticket: opens it.
        opened: how often it has been opened; each time, a page knows nothing yet.
        is_busy: whether the last messages have not been sent, because the page reads slowly. Then
            no others may be handed over.
    """

    def __init__(self, channel: DataChannel, receive: Callable[[str], bytes]) -> None:
        self._channel, self._receive = channel, receive
        self._connection: SecureConnection | None = None
        self._ending: asyncio.Task[None] | None = None  # else it might be collected
        self.ticket = secrets.token_urlsafe(TICKET)
        self.opened, self.is_busy = 0, False

    @property
    def is_open(self) -> bool:
        """Whether a script listens."""
        return self._connection is not None

    def hand_over(self, *messages: Message) -> None:
        """Send messages with the next `DataChannel.send`. Call it in the simulation thread."""
        self.is_busy = True
        self._channel.take(self, messages)

    def close(self) -> None:
        """End the ticket and the connection. Thread-safe."""
        self._receive = _ignored  # its owner refers to this stream
        self._channel.end(self)

    # On the event loop

    async def serve(self, connection: SecureConnection) -> None:
        """Serve a connection that has shown the ticket, until it ends or another one comes."""
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
                if connection.counts_change() and (answer := self._receive(text)):
                    await connection.send(answer, text=True)
        finally:
            if self._connection is connection:
                self._connection = None

    def write(self, messages: Sequence[Message]) -> None:
        """Send messages, or wait until less is unsent."""
        if self._connection is None:
            self.is_busy = False
        else:
            self._write_to(self._connection, messages)

    def _write_to(self, connection: SecureConnection, messages: Sequence[Message]) -> None:
        if connection is not self._connection or connection.protocol.state is not State.OPEN:
            return  # its successor is told everything anew
        if connection.transport.get_write_buffer_size() > MOST_UNSENT:
            connection.loop.call_later(AGAIN, self._write_to, connection, messages)
            return
        self.is_busy = False
        for message in messages:
            connection.protocol.send_text(message())
        connection.send_data()

    def end(self) -> None:
        """Begin to close the connection, if there is one."""
        connection, self._connection = self._connection, None
        if connection is not None:
            closing = connection.close(CloseCode.GOING_AWAY, "this page has ended")
            self._ending = connection.loop.create_task(closing)


class DataChannel:
    """The data channels of all pages of a server."""

    def __init__(self) -> None:
        self._streams = WeakValueDictionary[str, PageStream]()  # its page keeps it
        self._loop: asyncio.AbstractEventLoop | None = None
        self._ready: list[tuple[PageStream, Sequence[Message]]] = []

    @property
    def tickets(self) -> int:
        """Number of valid tickets."""
        return len(self._streams)

    def open(self, receive: Callable[[str], bytes]) -> PageStream:
        """A channel for a new page, with a ticket. Thread-safe.

        Args:
            receive: called on the event loop with each message of the page; returns the answer, or
                nothing.
        """
        stream = PageStream(self, receive)
        self._streams[stream.ticket] = stream
        return stream

    def end(self, stream: PageStream) -> None:
        """End a ticket and its connection. Thread-safe."""
        self._streams.pop(stream.ticket, None)
        if self._loop is not None:
            with suppress(RuntimeError):  # the server has stopped
                self._loop.call_soon_threadsafe(stream.end)

    async def handle(self, connection: SecureConnection) -> None:
        """Serve a connection, from its ticket on."""
        self._loop = connection.loop
        with suppress(ConnectionClosed):
            try:
                async with asyncio.timeout(GREETING):
                    ticket = ticket_in(await connection.recv_data())
            except TimeoutError:
                await connection.close(CloseCode.TRY_AGAIN_LATER, "expected a ticket")
                return
            stream = self._streams.get(ticket)
            if stream is None:
                await connection.close(NO_TICKET, "expected a valid ticket")
            else:
                await stream.serve(connection)

    def take(self, stream: PageStream, messages: Sequence[Message]) -> None:
        """Keep messages until `send`."""
        self._ready.append((stream, messages))

    def send(self) -> None:
        """Send what has been handed over, with one call of the event loop."""
        if self._ready and self._loop is not None:
            ready, self._ready = self._ready, []
            with suppress(RuntimeError):  # the server has stopped
                self._loop.call_soon_threadsafe(_write, ready)


def _ignored(_: str) -> bytes:
    return b""


def _write(ready: list[tuple[PageStream, Sequence[Message]]]) -> None:
    for stream, messages in ready:
        try:
            stream.write(messages)
        except Exception as error:  # the other pages get theirs
            log_error(error)
