"""What moves, told to a browser thirty times a second at a bearable price.

viser takes 60 µs for an assignment to a property, wakes its event loop for every message and then
waits for more of them; for twenty browsers that is more than a core. Here several properties of a
node are one message (`update_node`), and all messages of a frame one write to the network, done
for all browsers together (`FrameChannel`). This uses viser's private parts; tests pin them.
"""

from __future__ import annotations

import asyncio
import time
from contextlib import suppress
from functools import partial
from threading import get_ident
from typing import Any
from weakref import WeakKeyDictionary

import msgspec
import numpy as np
import viser
from viser import _messages
from viser.infra import Message, _infra
from viser.infra._messages import wire_field_names
from websockets.asyncio.server import ServerConnection
from websockets.protocol import State

from onpath.app.viser_adapter.compression import compress

UPDATES = {
    kind: wire_field_names(kind)
    for kind in (_messages.SceneNodeUpdateMessage, _messages.GuiUpdateMessage)
}
MOST_UNSENT = 1 << 16  # [B] that a slow network may owe a browser, before viser merges what is late
_DTYPES = {np.dtype(kind): np.dtype(kind).str for kind in (np.float32, np.float64)}  # it is slow
_ready: WeakKeyDictionary[asyncio.AbstractEventLoop, list[FrameChannel]] = WeakKeyDictionary()
"""Channels with something to send, by the event loop that does it."""


def update_node(handle: Any, **arrays: np.ndarray) -> None:
    """Set float32 properties of a node, without a look at whether they have changed."""
    values = {name: np.array(array, np.float32, order="C") for name, array in arrays.items()}
    for name, value in values.items():
        setattr(handle._impl.props, name, value)
    message = _messages.SceneNodeUpdateMessage(handle._impl.name, values)
    handle._impl.api._queue_scene_message(message)


def update_gui(handle: Any, name: str, value: str | tuple[np.ndarray, ...]) -> None:
    """Set a property of the panel, without a look at its type and whether it has changed.

    Arrays must stay as they are from now on.
    """
    setattr(handle._impl.props, name, value)
    handle._queue_update(name, value)


class FrameChannel:
    """All that the simulation thread tells one browser during a frame, as one message.

    It goes past viser's queue when that is empty, and else through it, so that the order is kept.

    Attributes:
        frames: how many were not empty.
    """

    def __init__(self, client: viser.ClientHandle) -> None:
        connection = client._websock_connection
        self._client_id = connection.client_id
        self._sockets = client._viser_server._websock_server._live_connections
        self._loop = connection._state.event_loop
        self._buffer = connection._state.message_buffer
        self._recorders = connection._record_handles
        self._collector: int | None = None
        self.frames = 0
        self._messages: list[Message] = []
        self._queue = partial(type(connection).queue_message, connection)
        connection.queue_message = self._take  # of an earlier channel too, if there was one

    @property
    def closed(self) -> bool:
        """Whether the browser is gone."""
        return self._buffer.done

    def __enter__(self) -> None:
        """What this thread tells the browser from now on waits for `send`."""
        self._collector = get_ident()

    def __exit__(self, *_: object) -> None:
        """What it tells from now on goes at once."""
        self._collector = None
        if self._messages:
            self.frames += 1
            _ready.setdefault(self._loop, []).append(self)

    def send(self) -> None:
        """Send the frames of all channels of this server, with one call of its event loop."""
        if channels := _ready.pop(self._loop, None):
            frames = [(channel, *channel._packed()) for channel in channels]
            with suppress(RuntimeError):  # the server has stopped
                self._loop.call_soon_threadsafe(_write, frames)

    def _take(self, message: Message) -> None:
        if message.excluded_self_client == self._client_id:
            return  # an echo of its own widgets for the other browsers of a page; there are none
        if self._collector == get_ident():
            self._messages.append(message)
        elif not self.closed:  # while a page is being built, say
            self._queue(message)

    def _packed(self) -> tuple[list[Message], bytes]:
        messages, self._messages = self._messages, []
        return messages, packed(messages)

    def write(self, messages: list[Message], data: bytes) -> None:
        """On the event loop."""
        socket = self._sockets.get(self._client_id)
        if self.closed or socket is None or socket.protocol.state is not State.OPEN:
            return
        if self._is_free(socket):
            socket.protocol.send_binary(data)
            socket.send_data()
        else:
            for message in messages:
                self._queue(message)

    def _is_free(self, socket: ServerConnection) -> bool:
        unsent = socket.transport.get_write_buffer_size()
        return not self._buffer.message_from_id and not self._recorders and unsent < MOST_UNSENT


def _write(frames: list[tuple[FrameChannel, list[Message], bytes]]) -> None:
    for channel, messages, data in frames:
        channel.write(messages, data)


def _wire(message: Message, arrays: list[memoryview]) -> dict[str, Any]:
    """As viser does it, but quicker for what `update_node` and `update_gui` make."""
    kind, known = type(message), len(arrays)
    if kind not in UPDATES:
        return message.as_serializable_dict(arrays)
    fields = {name: getattr(message, name) for name in UPDATES[kind]}
    try:
        fields["updates"] = {k: _told(value, arrays) for k, value in fields["updates"].items()}
    except TypeError:
        del arrays[known:]
        return message.as_serializable_dict(arrays)
    fields["type"] = kind.__name__
    return fields


def _told(value: Any, arrays: list[memoryview]) -> Any:
    """A value as it goes over the wire; arrays go apart.

    Raises:
        TypeError: that is viser's business.
    """
    kind = type(value)
    if kind in (str, bool, int, float):
        return value
    if kind is tuple:
        return [_told(each, arrays) for each in value]
    if kind is not np.ndarray or not value.flags.c_contiguous:
        raise TypeError(kind)
    arrays.append(value.data)
    dtype = _DTYPES.get(value.dtype) or value.dtype.str
    return {"__binary_index": len(arrays) - 1, "dtype": dtype}


def packed(messages: list[Message]) -> bytes:
    """Messages as viser sends them: lengths, compressed msgpack, then the arrays as they are."""
    arrays: list[memoryview] = []
    window = {
        "messages": [_wire(message, arrays) for message in messages],
        "timestampSec": time.perf_counter(),
        "binaryBufferLengths": [array.nbytes for array in arrays],
    }
    inner = msgspec.msgpack.encode(window)
    outer = compress(inner)
    lengths = (len(inner).to_bytes(8, "little"), len(outer).to_bytes(8, "little"))
    parts: list[bytes | memoryview] = [*lengths, outer]
    _infra._append_aligned_buffers(parts, arrays, 16 + len(outer))
    return b"".join(parts)
