"""viser's wire format on the browser's side, for simulated browsers. Pure functions."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import msgspec
import numpy as np
import viser
import zstandard

from onpath.app.channel.messages import Seen, encoded
from onpath.app.common.per_thread import per_thread

SEEN = encoded(Seen()).decode()
"""Tells that a page is drawn."""
SUBPROTOCOL = f"viser-v{viser.__version__}"
CAMERA = {
    "wxyz": [1.0, 0.0, 0.0, 0.0],
    "position": [0.0, -2.0, 1.0],
    "fov": 0.8,
    "near": 0.01,
    "far": 1000.0,
    "image_height": 600,
    "image_width": 800,
    "look_at": [0.0, 0.0, 0.0],
    "up_direction": [0.0, 0.0, 1.0],
}
"""Fields of a camera message; the first such message announces a browser."""


def packed(kind: str, **fields: Any) -> bytes:
    """A message to the server."""
    return msgspec.msgpack.encode({"type": kind, **fields})


def answer(message: dict[str, Any], stored: Mapping[str, str] | None = None) -> bytes | None:
    """The immediate answer of a visible page to a message, or None.

    Args:
        stored: the browser's local storage.
    """
    match message:
        case {"type": "LocalStorageGetItemRequestMessage", "request_uuid": number, "key": key}:
            value = (stored or {}).get(key)
            kind = "LocalStorageGetItemResponseMessage"
            return packed(kind, request_uuid=number, value=value, error=None)
        case {"type": "SetCameraUpDirectionMessage", "initial": False, "position": up}:
            return packed("ViewerCameraMessage", **{**CAMERA, "up_direction": up})
    return None


def hello(page: str, **kept: str) -> str:
    """The first message of a page's own websocket.

    Args:
        page: its number, which viser's websocket shows as well.
        kept: what the browser keeps; see `Hello`.
    """
    return msgspec.json.encode({"is": "hello", "page": page, **kept}).decode()


class MessageHeader(msgspec.Struct):
    """Type of a message, and name of its node if it has one."""

    type: str
    name: Any = ""


class _Window(msgspec.Struct):
    messages: list[MessageHeader]


@per_thread
def _decompressor() -> zstandard.ZstdDecompressor:
    return zstandard.ZstdDecompressor()


_window = msgspec.msgpack.Decoder(_Window)


def message_headers(raw: bytes) -> list[MessageHeader]:
    """The headers of the messages in a frame; faster than `unpacked`."""
    end = 16 + int.from_bytes(raw[8:16], "little")
    return _window.decode(_decompressor().decompress(raw[16:end])).messages


def unpacked(raw: bytes) -> list[dict[str, Any]]:
    """The messages in a frame, with their arrays.

    A frame is two lengths, compressed msgpack, then the arrays, each aligned to 8 bytes.
    """
    end = 16 + int.from_bytes(raw[8:16], "little")
    window = msgspec.msgpack.decode(_decompressor().decompress(raw[16:end]))
    buffers: list[bytes] = []
    for length in window.get("binaryBufferLengths", ()):
        start = end + -end % 8
        end = start + length
        buffers.append(raw[start:end])
    return [_with_arrays(message, buffers) for message in window["messages"]]


def _with_arrays(value: Any, buffers: list[bytes]) -> Any:
    if isinstance(value, list):
        return [_with_arrays(each, buffers) for each in value]
    if not isinstance(value, dict):
        return value
    if "__binary_index" in value:
        return np.frombuffer(buffers[value["__binary_index"]], dtype=value["dtype"])
    return {key: _with_arrays(each, buffers) for key, each in value.items()}
