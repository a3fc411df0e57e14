"""Frames of messages in viser's format; the messages that recur in every frame are serialised once.

viser takes 50 µs to serialise and compress the update of a page's robots, 24 times a second. Only
its numbers change, and they stand behind the messages, so the messages are stored and not
compressed.
"""

from __future__ import annotations

import time
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import msgspec
import numpy as np
from viser import _messages
from viser.infra import Message, _infra

MOST_STORED = 1 << 14  # [B] of a frame without its arrays, up to which it need not be compressed
_MAGIC = (0xFD2FB528).to_bytes(4, "little")


@dataclass(frozen=True, eq=False)
class GroupForm:
    """Float32 properties of nodes that are always updated together, from one array.

    Attributes:
        properties: node, property, and its span in the array; a node's properties in succession.
        owner: of the nodes.
    """

    properties: list[tuple[str, str, slice]]
    owner: str

    @cached_property
    def encoded(self) -> list[msgspec.Raw]:
        """The messages of an update whose arrays are the first ones of a frame."""
        numbers = np.zeros(max(span.stop for _, _, span in self.properties), np.float32)
        messages = _serialised(GroupUpdate(self, numbers).messages(), [])
        return [msgspec.Raw(msgspec.msgpack.encode(message)) for message in messages]


@dataclass(frozen=True, slots=True, eq=False)
class GroupUpdate:
    """The update of a group; stands for `messages`."""

    group: GroupForm
    numbers: np.ndarray

    def messages(self) -> list[Message]:
        """The same update as viser's messages, one for each node."""
        updates = dict[str, dict[str, Any]]()
        for (node, name, _), array in zip(self.group.properties, self.arrays(), strict=True):
            updates.setdefault(node, {})[name] = array
        return [
            _messages.SceneNodeUpdateMessage(node, values, owner=self.group.owner)
            for node, values in updates.items()
        ]

    def arrays(self) -> list[np.ndarray]:
        """The numbers of each property."""
        return [self.numbers[span] for _, _, span in self.group.properties]


def expanded(messages: Iterable[Message | GroupUpdate]) -> list[Message]:
    """The messages, each group replaced by viser's messages for its nodes."""
    parts = (m.messages() if isinstance(m, GroupUpdate) else [m] for m in messages)
    return [message for part in parts for message in part]


def packed(messages: Sequence[Message | GroupUpdate]) -> bytes | None:
    """Messages in viser's format: lengths, msgpack in a zstd frame, then the raw arrays.

    Returns:
        The frame; None if the messages are long and should be compressed, as viser does.
    """
    arrays: list[Any] = []
    wire: list[Any] = []
    for message in messages:
        if isinstance(message, GroupUpdate) and not arrays:
            wire += message.group.encoded
            arrays += message.arrays()
        else:
            wire += _serialised(expanded([message]), arrays)
    lengths = [array.nbytes for array in arrays]
    window = {"messages": wire, "timestampSec": time.perf_counter(), "binaryBufferLengths": lengths}
    inner = msgspec.msgpack.encode(window)
    if len(inner) > MOST_STORED:
        return None
    outer = stored(inner)
    head = len(inner).to_bytes(8, "little") + len(outer).to_bytes(8, "little") + outer
    parts: list[Any] = [head]
    _infra._append_aligned_buffers(parts, arrays, len(head))
    return b"".join(parts)


def stored(data: bytes) -> bytes:
    """A zstd frame of uncompressed data (RFC 8878, 3.1.1), which must be below 128 kB.

    It has a header with a content size of 4 bytes, and one last, raw block.
    """
    size = len(data)
    block = (size << 3 | 1).to_bytes(3, "little")
    return _MAGIC + b"\xa0" + size.to_bytes(4, "little") + block + data


def _serialised(messages: Iterable[Message], arrays: list[Any]) -> list[dict[str, Any]]:
    """The messages as viser serialises them; their arrays are appended to `arrays`."""
    return [message.as_serializable_dict(arrays) for message in messages]
