"""zstd as viser's browsers decode it. Compressors (0.3 MB each) are shared within a thread."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import zstandard
from viser.infra import _infra

from onpath.app.common.per_thread import per_thread

LEVEL = 1  # the level that viser uses
_MAGIC = (0xFD2FB528).to_bytes(4, "little")
QUICK = -5  # for frames: a third of the time of LEVEL, and 15 % more bytes


def compress(data: bytes) -> bytes:
    """Compress data so that viser's browsers can read it."""
    return _own_compressor(QUICK).compress(data)


def stored_head(size: int) -> bytes:
    """What makes `size` bytes behind it a zstd frame, uncompressed (RFC 8878, 3.1.1): a header with
    a content size of 4 bytes, and that of one last, raw block, which must be below 128 kB.
    """
    return _MAGIC + b"\xa0" + size.to_bytes(4, "little") + (size << 3 | 1).to_bytes(3, "little")


def decompress(data: bytes) -> bytes:
    """Decompress what `compress` or viser has compressed."""
    return _own_decompressor().decompress(data)


def share_compressors() -> None:
    """Let all connections of viser share one compressor; viser creates one for each.

    They all run in one thread, so that sharing is safe.
    """
    library: Any = _infra
    library.zstandard = SimpleNamespace(**{**vars(zstandard), "ZstdCompressor": _compressor})


def _compressor(level: int = 3, **options: Any) -> zstandard.ZstdCompressor:
    if level == LEVEL and not options:
        return _own_compressor(LEVEL)
    return zstandard.ZstdCompressor(level=level, **options)


@per_thread
def _own_compressor(level: int) -> zstandard.ZstdCompressor:
    return zstandard.ZstdCompressor(level=level)


@per_thread
def _own_decompressor() -> zstandard.ZstdDecompressor:
    return zstandard.ZstdDecompressor()
