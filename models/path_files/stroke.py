"""The lines of a file before they become a path, units of length, and limits of files."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from onpath.models.arrays import Array
from onpath.models.errors import CodedError, Message

UNITS: Mapping[str, float] = MappingProxyType(
    {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "in": 0.0254, "pt": 0.0254 / 72, "px": 0.0254 / 96}
)
"""Name of a unit of length -> [m]."""
MOST_POINTS = 100_000  # of all lines of a file
MEETS = 1e-5  # [m], largest distance of the ends of a closed line


@dataclass(frozen=True, slots=True, eq=False)
class Stroke:
    """One line of a file.

    Attributes:
        points: shape (n, 2), [m].
        closed: whether its end is joined to its beginning; None: the file does not say.
        straight: whether it is straight between the points, as a drawing is; otherwise the points
            are all that is known of it.
        name: that in its file; "" if it is the only one.
    """

    points: Array
    closed: bool | None
    straight: bool
    name: str = ""

    @property
    def length(self) -> float:
        """The sum of the distances of its points, [m]."""
        with np.errstate(over="ignore"):
            return float(np.linalg.norm(np.diff(self.points, axis=0), axis=1).sum())


@dataclass(frozen=True, slots=True, eq=False)
class LineDrawing:
    """The lines of a file.

    Attributes:
        strokes: the lines in the order in which they are drawn, at least one, [m]; between them
            the pen is raised.
        remarks: what the user should know about them.
    """

    strokes: tuple[Stroke, ...]
    remarks: tuple[Message, ...] = ()


def drawn_stroke(points: list[tuple[float, float]] | Array, name: str) -> Stroke:
    """A line of a drawing or a tool; it is closed if its ends meet."""
    z = np.asarray(points, dtype=float)
    closed = len(z) > 2 and bool(np.linalg.norm(z[0] - z[-1]) < MEETS)
    return Stroke(points=z, closed=closed, straight=True, name=name)


def check_count(count: int, line: int) -> None:
    """Refuse a file with too many points.

    Args:
        line: where in the file.

    Raises:
        CodedError: there are too many.
    """
    if count > MOST_POINTS:
        raise CodedError("error.file_points", line=str(line), most=MOST_POINTS)


def text_of(data: bytes, encoding: str) -> str:
    """The text of a file.

    Raises:
        CodedError: it is not a text.
    """
    try:
        return data.decode(encoding)
    except UnicodeError:
        raise CodedError("error.file_no_text") from None
