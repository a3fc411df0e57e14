"""QR codes for a page and for a terminal."""

from __future__ import annotations

import io
from dataclasses import dataclass
from functools import lru_cache

import segno

BORDER = 4  # [modules] of white, without which not every camera finds the code


@dataclass(frozen=True, slots=True)
class QrCode:
    """A QR code, to be drawn in dark lines one unit thick on a light square.

    Attributes:
        size: of the square, with its border, [modules].
        lines: an SVG path of its horizontal lines.
    """

    size: int
    lines: str


@lru_cache(maxsize=256)
def qr_code(text: str) -> QrCode:
    """The QR code of an address; up to 15 % of it may be hidden."""
    made = segno.make_qr(text, error="m")
    rows = [bytes(row) for row in made.matrix]
    lines = "".join(
        f"M{BORDER + x} {BORDER + y + 0.5}h1" for y, row in enumerate(rows) for x in _dark(row)
    )
    return QrCode(len(rows) + 2 * BORDER, lines)


def _dark(row: bytes) -> list[int]:
    return [x for x, dark in enumerate(row) if dark]


def qr_text(text: str) -> str:
    """The QR code of an address in the block characters of a dark terminal."""
    written = io.StringIO()
    segno.make_qr(text, error="l").terminal(written, compact=True, border=2)
    return written.getvalue()
