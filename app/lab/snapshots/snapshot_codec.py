"""Encodes snapshots as bytes, to show a lab in another process."""

from __future__ import annotations

from typing import Any, get_origin

import msgspec
import numpy as np

from onpath.app.lab.snapshots.page_snapshot import PageSnapshot
from onpath.app.lab.snapshots.snapshot import Motion


def to_bytes(snapshot: PageSnapshot | Motion) -> bytes:
    """Encode a snapshot as MessagePack; an array is its type, shape and numbers."""
    return _encoder.encode((isinstance(snapshot, PageSnapshot), snapshot))


def from_bytes(data: bytes) -> PageSnapshot | Motion:
    """Inverse of `to_bytes`.

    Raises:
        ValueError: the data is not a snapshot.
    """
    is_whole, content = _head.decode(data)
    return (_whole if is_whole else _motion).decode(content)


def _encode(value: Any) -> Any:
    if isinstance(value, np.generic):
        return value.item()
    if isinstance(value, np.ndarray):
        return value.dtype.str, value.shape, np.ascontiguousarray(value).tobytes()
    raise NotImplementedError(f"a snapshot holds data only, not {type(value).__name__}")


def _decode(kind: type, data: Any) -> Any:
    if (get_origin(kind) or kind) is not np.ndarray:
        raise NotImplementedError(kind.__name__)
    dtype, shape, numbers = msgspec.convert(data, tuple[str, tuple[int, ...], bytes])
    return np.frombuffer(numbers, np.dtype(dtype)).reshape(shape)


_encoder = msgspec.msgpack.Encoder(enc_hook=_encode)
_head = msgspec.msgpack.Decoder(tuple[bool, msgspec.Raw])
_motion = msgspec.msgpack.Decoder(Motion, dec_hook=_decode)
_whole = msgspec.msgpack.Decoder(PageSnapshot, dec_hook=_decode)
