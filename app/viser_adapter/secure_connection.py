"""A browser's websocket: yields or handles only valid messages; limits rate, size and duration."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from contextlib import suppress
from functools import cache
from traceback import clear_frames
from typing import Any

from typing_extensions import override
from viser import _messages as wire
from websockets.exceptions import ConnectionClosed
from websockets.frames import CloseCode, Frame, Opcode
from websockets.protocol import State

from onpath.app.common.allowance import Allowance
from onpath.app.viser_adapter.connection_limits import CountedConnection
from onpath.app.viser_adapter.dropped import warn_once
from onpath.app.viser_adapter.limits import Limits
from onpath.app.viser_adapter.message_schema import InvalidMessage, MessageSchemas

FROM_BROWSER: tuple[type[Any], ...] = (
    wire.ViewerCameraMessage,
    wire.SceneNodeClickMessage,
    wire.SceneNodeDragMessage,
    wire.LocalStorageGetItemResponseMessage,
)
"""What a browser may send through viser's websocket; anything else is dropped."""
GESTURES = (wire.ViewerCameraMessage, wire.SceneNodeDragMessage)
"""Messages handled at once: a browser may send many in a row, and their handlers never wait."""
LONG = 4096  # [B]; a message counts once for each begun block of this size
_DATA = (Opcode.TEXT, Opcode.BINARY, Opcode.CONT)
_END_OF_REQUEST = b"\r\n\r\n"
_BAD_REQUEST = b"HTTP/1.1 400 Bad Request\r\nConnection: close\r\nContent-Length: 0\r\n\r\n"


class Received(bytes):
    """A decoded message in place of its bytes, which viser would decode again.

    Attributes:
        message: viser's message.
    """

    message: Any

    @classmethod
    def of(cls, message: Any) -> Received:
        """The substitute for a message's bytes."""
        received = cls()
        received.message = message
        return received


_deserialize = wire.Message.deserialize


def take_decoded_messages() -> None:
    """Make viser accept decoded messages. This patches viser for the whole process."""

    def deserialize(message: bytes) -> Any:
        return message.message if isinstance(message, Received) else _deserialize(message)

    wire.Message.deserialize = deserialize


class UnfinishedMessages:
    """Limits the memory of messages received in part. Use it on one event loop.

    Args:
        most: in total, [B].
    """

    def __init__(self, most: int) -> None:
        self._most, self._total = most, 0
        self._held: dict[SecureConnection, int] = {}

    def hold(self, connection: SecureConnection, size: int) -> None:
        """Set a connection's unfinished bytes; beyond the limit, cut off those with the most."""
        self._total += size - self._held.pop(connection, 0)
        if size:
            self._held[connection] = size
        while self._total > self._most:
            largest = max(self._held, key=self._held.__getitem__)
            self._total -= self._held.pop(largest)  # connection_lost comes later
            largest.cut_off()


@cache
def _schemas(max_magnitude: float) -> MessageSchemas:
    return MessageSchemas(FROM_BROWSER, max_magnitude)


class SecureConnection(CountedConnection):
    """A websocket that yields only valid messages, and is closed when there are too many.

    websockets only answers GET, so a HEAD request is passed on to it as GET. It hangs up without an
    answer on a malformed request, which a proxy takes for the end of this process; here it is
    answered.

    A message of `GESTURES` is handled as soon as it arrives, if no earlier message still waits.
    viser would handle it two turns of the event loop later, in two tasks, which takes half as much
    time again.

    Attributes:
        is_head: whether the request was HEAD, so that the response has no body.
        handle: handles a message at once; None until viser knows the client.
    """

    handle: Callable[[Any], None] | None = None

    def __init__(
        self, *args: Any, limits: Limits, unfinished: UnfinishedMessages, **kwargs: Any
    ) -> None:
        super().__init__(*args, **kwargs)
        self._limits, self._schemas = limits, _schemas(limits.max_magnitude)
        self._allowance = Allowance(limits.message_burst, limits.messages_per_second)
        self._drags = Allowance(limits.change_burst, limits.changes_per_second)
        self._commands = Allowance(limits.change_burst, limits.changes_per_second)
        self._closing: asyncio.Task[None] | None = None
        self._unfinished = unfinished
        self._deadline: asyncio.TimerHandle | None = None
        self._begun: bytes | None = b""  # start of the request, until its method is known
        self._request_size, self.is_head, self._refused = 0, False, False
        self._last = b""  # bytes of the request, in which its end may begin
        self._is_next = False  # whether no earlier message still waits
        self._decoded: Any = None  # the waiting message, if it is decoded already
        self._end: ConnectionClosed | None = None  # raised in the task that waited for a message

    @override
    def data_received(self, data: bytes) -> None:
        if self.request is None:
            data = self._of_request(data)
        elif self.protocol.state is State.CONNECTING:
            return  # nothing may be sent before the answer; websockets would fail on it
        if data:
            super().data_received(data)
            self._limit_unfinished()

    @override
    def send_data(self) -> None:
        """Send the protocol's data; answer a malformed request before the protocol ends."""
        malformed = self.request is None and self.protocol.handshake_exc is not None
        if malformed and self._request_size and not self._refused:
            self._refuse()
        super().send_data()

    def _refuse(self) -> None:
        self._refused = True
        with suppress(RuntimeError):  # the protocol has ended its side already
            self.transport.write(_BAD_REQUEST)

    @override
    def connection_lost(self, exc: Exception | None) -> None:
        super().connection_lost(exc)
        self.handle = None
        self._stop_waiting()
        self._unfinished.hold(self, 0)

    @override
    def process_event(self, event: Any) -> None:
        """Count all frames, including pings and fragments, and drop those that exceed the rate."""
        if isinstance(event, Frame) and event.opcode is not Opcode.CLOSE:
            if not self._allowance.take(1 + len(event.data) / LONG):
                self._close_flood(f"{self._limits.messages_per_second:g} messages")
            if self._closing is not None:
                return
            if event.fin and event.opcode in _DATA:
                self._stop_waiting()
            whole = event.fin and event.opcode is Opcode.BINARY and self.state is State.OPEN
            if whole and self._is_next and self._handles(bytes(event.data)):
                return
            self._is_next = self._is_next and event.opcode not in _DATA
        super().process_event(event)

    def _close_flood(self, most: str) -> None:
        """Close the connection, since at most `most` per second are allowed."""
        if self._closing is not None:
            return
        warn_once(self, "a flood of messages")
        reason = f"more than {most} per second"
        self._closing = self.loop.create_task(self.close(CloseCode.POLICY_VIOLATION, reason))

    def _decode(self, raw: bytes | str) -> Any:
        """Decode a message.

        Raises:
            InvalidMessage: the message is invalid, or there were too many of its kind.
        """
        message = self._schemas.decoded(raw)
        if isinstance(message, wire.SceneNodeDragMessage) and not self._drags.take():
            self._close_flood(f"{self._limits.changes_per_second:g} changes")
            raise InvalidMessage("a flood of changes")
        return message

    def _handles(self, raw: bytes) -> bool:
        """Handle a message at once, if it is one of `GESTURES` or invalid."""
        try:
            message = self._decode(raw)
        except InvalidMessage as wrong:
            warn_once(self, str(wrong))
            return True
        if self.handle is None or not isinstance(message, GESTURES):
            self._decoded = message
            return False
        self.handle(message)
        return True

    def cut_off(self) -> None:
        """Close a connection whose unfinished message takes too much memory, or too long."""
        warn_once(self, "an unfinished message")
        self.transport.abort()

    def _of_request(self, data: bytes) -> bytes:
        """The bytes to pass on: none until the method is known, and none after the request."""
        self._request_size += len(data)
        if self._begun is not None:
            self._begun += data
            if b"HEAD ".startswith(self._begun):
                return b""
            data, self._begun = self._begun, None
            self.is_head = data.startswith(b"HEAD ")
            data = b"GET " + data[5:] if self.is_head else data
        before, data = self._last, self._last + data
        request, end, _ = data.partition(_END_OF_REQUEST)
        self._last = data[1 - len(_END_OF_REQUEST) :]
        return (request + end)[len(before) :]

    def _limit_unfinished(self) -> None:
        """Limit the size of a request, and the memory and duration of an unfinished message."""
        if self.request is None:
            if self._request_size > self._limits.max_request_bytes:
                self._refuse()
                self.transport.abort()
            return
        protocol = self.protocol
        is_open = protocol.state is State.OPEN
        size = len(protocol.reader.buffer) + (protocol.current_size or 0) if is_open else 0
        if not size:
            self._stop_waiting()
        elif self._deadline is None:
            self._deadline = self.loop.call_later(self._limits.message_seconds, self._overdue)
        self._unfinished.hold(self, size)

    def _overdue(self) -> None:
        self._deadline = None
        if self.recv_messages.paused:  # this process is not reading
            self._deadline = self.loop.call_later(self._limits.message_seconds, self._overdue)
        else:
            self.cut_off()

    def _stop_waiting(self) -> None:
        if self._deadline is not None:
            self._deadline.cancel()
            self._deadline = None

    def forget_handler(self) -> None:
        """Break the reference cycles of viser's handler of this connection, once it has returned.

        Its tasks keep the error that ended them, whose traceback keeps its variables: the tasks.
        """
        end, self._end = self._end, None
        if end is not None:
            clear_frames(end.__traceback__)

    async def recv_data(self) -> str | bytes:
        """The next message of a data channel; see data_channel.py."""
        return await super().recv()

    def counts_change(self) -> bool:
        """Count a message that may make a lab compute; if there are too many, begin to close."""
        if not self._commands.take():
            self._close_flood(f"{self._limits.changes_per_second:g} changes")
        return self._closing is None

    @override
    async def recv(self, decode: bool | None = None) -> Any:
        while True:
            if not self.recv_messages.frames:
                await asyncio.sleep(0)  # until the earlier messages have been handled
                self._is_next = self.handle is not None and not self.recv_messages.frames
            try:
                raw = await super().recv(decode)
            except ConnectionClosed as end:
                self._end = end
                raise
            message, self._decoded = self._decoded, None
            try:
                return Received.of(self._decode(raw) if message is None else message)
            except InvalidMessage as wrong:
                warn_once(self, str(wrong))
