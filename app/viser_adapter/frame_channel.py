"""Batched scene updates: one network write per browser and frame.

viser takes 60 µs for every assignment to a property, wakes its event loop for every message, and
then waits for more of them; for twenty browsers that is more than one core. Here all messages of a
frame are one write, issued for all browsers together (`FrameChannel`). Several properties of a node
are one message (`update_node`). Nodes that move in every frame (`NodeGroup`) need no new messages:
their numbers follow stored messages (frame_packing.py). This uses private parts of viser, which
tests pin.
"""

from __future__ import annotations

import asyncio
from collections.abc import Sequence
from contextlib import suppress
from functools import partial
from threading import get_ident
from typing import Any
from weakref import WeakKeyDictionary

import numpy as np
import viser
from viser import _messages
from viser.infra import Message
from websockets.asyncio.server import ServerConnection
from websockets.protocol import State

from onpath.app.viser_adapter.frame_packing import (
    GroupForm,
    GroupUpdate,
    expanded,
    packed,
)

MOST_UNSENT = 1 << 16  # [B] unsent; beyond it, viser's queue merges outdated messages
_ready: WeakKeyDictionary[asyncio.AbstractEventLoop, list[FrameChannel]] = WeakKeyDictionary()
"""Channels with pending messages, by the event loop that sends them."""


def update_node(handle: Any, **given: np.ndarray | str | float) -> None:
    """Set float32 arrays, numbers and texts of a scene node, without viser's checks of changes."""
    values = {
        name: value if isinstance(value, str | float) else np.array(value, np.float32, order="C")
        for name, value in given.items()
    }
    for name, value in values.items():
        setattr(handle._impl.props, name, value)
    message = _messages.SceneNodeUpdateMessage(handle._impl.name, values)
    handle._impl.api._queue_scene_message(message)


def move_node(handle: Any, position: np.ndarray) -> None:
    """Set a scene node's position, without viser's check whether it has changed."""
    handle._impl.position[:] = position
    message = _messages.SetPositionMessage(handle._impl.name, tuple(position.tolist()))
    handle._impl.api._queue_scene_message(message)


class NodeGroup:
    """Float32 properties of some nodes that are always updated together, from one array.

    The handles do not keep the values.

    Args:
        properties: node, property, and its span in the array; a node's properties in succession.
    """

    def __init__(self, properties: Sequence[tuple[Any, str, slice]]) -> None:
        self._api = properties[0][0]._impl.api
        channel = getattr(self._api._websock_interface.queue_message, "__self__", None)
        self._channel = channel if isinstance(channel, FrameChannel) else None
        named = [(handle._impl.name, name, span) for handle, name, span in properties]
        self._form = GroupForm(named, self._api._owner_id)

    def update(self, numbers: np.ndarray) -> None:
        """Set all properties; `numbers` is float32 and must not be modified afterwards."""
        update = GroupUpdate(self._form, numbers)
        if self._channel is not None:
            self._channel._take(update)
            return
        for message in update.messages():
            self._api._queue_scene_message(message)


class FrameChannel:
    """Collects the simulation thread's messages to one browser, and sends those of a frame as one.

    A short frame bypasses viser's queue if that is empty; any other goes through it, which keeps
    the order.
    """

    def __init__(self, client: viser.ClientHandle) -> None:
        connection = client._websock_connection
        self._client_id = connection.client_id
        self._sockets = client._viser_server._websock_server._live_connections
        self._loop = connection._state.event_loop
        self._buffer = connection._state.message_buffer
        self._recorders = connection._record_handles
        self._collector: int | None = None
        self._messages: list[Message | GroupUpdate] = []
        self._queue = partial(type(connection).queue_message, connection)
        connection.queue_message = self._take  # of an earlier channel too, if there was one

    @property
    def closed(self) -> bool:
        """Whether the browser has disconnected."""
        return self._buffer.done

    def __enter__(self) -> None:
        """Collect the messages of this thread until `send`."""
        self._collector = get_ident()

    def __exit__(self, *_: object) -> None:
        """Send the messages of this thread immediately again."""
        self._collector = None
        if self._messages:
            _ready.setdefault(self._loop, []).append(self)

    def send(self) -> None:
        """Send the frames of all channels of this server, with one call of its event loop."""
        if not self._messages:
            return  # nothing to send, or sent together with another channel's frame
        if channels := _ready.pop(self._loop, None):
            frames = [(channel, *channel._packed()) for channel in channels]
            with suppress(RuntimeError):  # the server has stopped
                self._loop.call_soon_threadsafe(_write, frames)

    def _take(self, message: Message | GroupUpdate) -> None:
        if self._collector == get_ident():
            self._messages.append(message)
        elif not self.closed:  # for example while a page is being built
            self._enqueue(message)

    def _enqueue(self, *messages: Message | GroupUpdate) -> None:
        for message in expanded(messages):
            self._queue(message)

    def _packed(self) -> tuple[list[Message | GroupUpdate], bytes | None]:
        messages, self._messages = self._messages, []
        return messages, packed(messages)

    def write(self, messages: list[Message | GroupUpdate], data: bytes | None) -> None:
        """Send a frame, packed unless it is long. Call it on the event loop."""
        socket = self._sockets.get(self._client_id)
        if self.closed or socket is None or socket.protocol.state is not State.OPEN:
            return
        if data is not None and self._is_free(socket):
            socket.protocol.send_binary(data)
            socket.send_data()
        else:
            self._enqueue(*messages)

    def _is_free(self, socket: ServerConnection) -> bool:
        unsent = socket.transport.get_write_buffer_size()
        return not self._buffer.message_from_id and not self._recorders and unsent < MOST_UNSENT


def _write(frames: list[tuple[FrameChannel, list[Message | GroupUpdate], bytes | None]]) -> None:
    for channel, messages, data in frames:
        channel.write(messages, data)
