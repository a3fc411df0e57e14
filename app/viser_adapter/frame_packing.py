"""Frames of messages as viser sends them, from templates of earlier frames.

Most frames differ from an earlier one only in the numbers of their arrays.
"""

from __future__ import annotations

import struct
import time
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from itertools import chain
from typing import Any, TypeVar

import msgspec
import numpy as np
from viser import _messages
from viser.infra import Message, _infra
from viser.infra._messages import wire_field_names

from onpath.app.viser_adapter.compression import compress, stored_head

Kept = TypeVar("Kept")
UPDATES = {
    kind: wire_field_names(kind)
    for kind in (_messages.SceneNodeUpdateMessage, _messages.GuiUpdateMessage)
}
MOST_TEMPLATES = 32  # for one browser; some five are in use
SMALL = 2048  # [B] of a frame without its arrays, up to which it is not compressed
_DTYPES = {np.dtype(kind): np.dtype(kind).str for kind in (np.float32, np.float64)}  # .str is slow


@dataclass(frozen=True, slots=True, eq=False)
class GroupForm:
    """Float32 properties of nodes that are always updated together, from one array.

    Attributes:
        properties: node, property, and its place in the array; a node's properties in succession.
        owner: of the nodes.
    """

    properties: list[tuple[str, str, slice]]
    owner: str


@dataclass(slots=True)
class Templates:
    """What the frames to one browser have in common.

    Attributes:
        frames: earlier frames up to the time, by the forms of their messages.
        messages: encoded messages by their form and the number of arrays before them in the frame.
    """

    frames: dict[tuple[object, ...], bytes] = field(default_factory=dict)
    messages: dict[tuple[object, int], list[Any]] = field(default_factory=dict)


@dataclass(frozen=True, slots=True, eq=False)
class GroupUpdate:
    """The update of a group; stands for `messages`."""

    group: GroupForm
    numbers: np.ndarray
    excluded_self_client: None = None

    def messages(self) -> list[Message]:
        """The same as viser's messages, one for each node."""
        updates = dict[str, dict[str, Any]]()
        for node, name, own in self.group.properties:
            updates.setdefault(node, {})[name] = self.numbers[own]
        owner = self.group.owner
        return [_messages.SceneNodeUpdateMessage(*each, owner=owner) for each in updates.items()]


def _wire(message: Message, arrays: list[memoryview]) -> dict[str, Any]:
    """A message as viser serialises it, but faster for those of `update_node` and `update_gui`."""
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
    """A value as it is serialised; arrays are appended to `arrays`.

    Raises:
        TypeError: the value needs viser's own serialisation.
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


def expanded(messages: Iterable[Message | GroupUpdate]) -> list[Message]:
    """The messages, each group replaced by viser's messages for its nodes."""
    ways = (m.messages() if isinstance(m, GroupUpdate) else [m] for m in messages)
    return [message for some in ways for message in some]


def _form(message: Any) -> object:
    """Everything but the numbers in an update of arrays; None for other messages."""
    kind = type(message)
    if kind is GroupUpdate:
        return message.group
    if kind not in UPDATES:
        return None
    form: list[object] = [getattr(message, name) for name in UPDATES[kind] if name != "updates"]
    for name, value in message.updates.items():
        form += name, type(value)
        for array in value if type(value) is tuple else (value,):
            if type(array) is not np.ndarray or not array.flags.c_contiguous:
                return None
            form += array.dtype, array.nbytes
    return tuple(form)


def _arrays(message: Any) -> Iterable[np.ndarray]:
    """The arrays in the update of a node or a group."""
    if isinstance(message, GroupUpdate):
        numbers = message.numbers
        return [numbers[own] for _, _, own in message.group.properties]
    values = message.updates.values()
    return chain.from_iterable(each if type(each) is tuple else (each,) for each in values)


def _encoded(message: Any, form: object, arrays: list[Any], templates: Templates) -> list[Any]:
    """A message, or those of a group, to be put into a frame; arrays are appended to `arrays`."""
    key = form, len(arrays)
    known = templates.messages.get(key)
    if known is not None:
        arrays += _arrays(message)
        return known
    wire = [_wire(each, arrays) for each in expanded([message])]
    if form is None:
        return wire
    return _keep(templates.messages, key, [msgspec.Raw(msgspec.msgpack.encode(w)) for w in wire])


def packed(messages: Sequence[Message | GroupUpdate], templates: Templates) -> bytes:
    """Messages as viser sends them: lengths, msgpack in a zstd frame, then the raw arrays.

    Most frames differ from an earlier one only in the arrays and in the time, which stands last.

    Args:
        templates: of earlier frames to this browser.
    """
    arrays: list[Any] = []
    forms = tuple(map(_form, messages))
    head, time_sent = templates.frames.get(forms), struct.pack(">d", time.perf_counter())
    if head is not None:
        arrays += chain.from_iterable(map(_arrays, messages))
    else:
        ways = zip(messages, forms, strict=True)
        wire = [each for m, form in ways for each in _encoded(m, form, arrays, templates)]
        lengths = [array.nbytes for array in arrays]
        window = {"messages": wire, "binaryBufferLengths": lengths, "timestampSec": 0.0}
        inner = msgspec.msgpack.encode(window)[: -len(time_sent)]
        size = len(inner) + len(time_sent)
        if size > SMALL:
            head, time_sent = _started(size, compress(inner + time_sent)), b""
        else:
            head = _started(size, stored_head(size) + inner, len(time_sent))
            if None not in forms:
                _keep(templates.frames, forms, head)
    parts: list[Any] = [head, time_sent]
    _infra._append_aligned_buffers(parts, arrays, len(head) + len(time_sent))
    return b"".join(parts)


def _keep(store: dict[Any, Kept], key: object, value: Kept) -> Kept:
    """Keep a template; all are forgotten when there are too many, because nodes come and go."""
    if len(store) >= MOST_TEMPLATES:
        store.clear()
    store[key] = value
    return value


def _started(size: int, outer: bytes, missing: int = 0) -> bytes:
    """The beginning of a frame: both lengths, and the compressed msgpack but its last bytes."""
    return size.to_bytes(8, "little") + (len(outer) + missing).to_bytes(8, "little") + outer
