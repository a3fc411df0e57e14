"""Reads a path from a file of any of these kinds, with remarks on what was done to it.

@points.csv                      a path in a file
@logo.svg fit=0.1 corners=round  with options, see `Placing`
@plate.nc scale=0.5 centre=0,0.01 part=2,3 turn=90 open
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from onpath.models.arrays import Array
from onpath.models.errors import CodedError, Message
from onpath.models.path_files.gcode import strokes_of_gcode
from onpath.models.path_files.joining import joined
from onpath.models.path_files.placing import (
    LARGEST,
    RADIUS,
    ROUND,
    SMOOTH,
    Placing,
    curve_of,
    least_radius,
    placed,
)
from onpath.models.path_files.signature import is_signature, strokes_of_signature
from onpath.models.path_files.stroke import UNITS, LineDrawing, Stroke, text_of
from onpath.models.path_files.svg import strokes_of_svg
from onpath.models.path_files.table import strokes_of_table
from onpath.models.paths.curve_fit import deviation_remark, distinct
from onpath.models.paths.curves import Curve
from onpath.models.paths.spline_curves import SplineCurve
from onpath.models.paths.spline_fit import raised_share
from onpath.models.studies.path_text import LONGEST_TEXT, curve_from_text, is_described
from onpath.models.studies.table_file import encoding_of
from onpath.models.systems.parameter_specs import unknown_name

MOST_BYTES = 20_000_000
GCODE = (".nc", ".gcode", ".ngc", ".gc", ".tap", ".cnc", ".g")
NUMBERS = ("scale", "fit", "radius")
MOST_PARTS = 1000
WORDS = ("open", "closed")
_GCODE = re.compile(r"\s*(%|[NO]\d+|[GMT]\s*\d|[;(])", re.IGNORECASE)


@dataclass(frozen=True, slots=True, eq=False)
class ImportedPath:
    """What was read.

    Attributes:
        curve: the path.
        remarks: what the user should know about it: links with the pen raised, how far the path is
            from the lines, the smallest radius of its bends.
    """

    curve: Curve
    remarks: tuple[Message, ...] = ()


def path_in(file: Path, placing: Placing = Placing()) -> ImportedPath:  # noqa: B008, it is frozen
    """The path in a file.

    Raises:
        CodedError: there is no such path; the message names the line.
        OSError: the file cannot be read.
    """
    with file.open("rb") as opened:
        data = opened.read(MOST_BYTES + 1)
    return path_of(data, file.name, placing)


def path_of(data: bytes, name: str, placing: Placing, most: int = MOST_BYTES) -> ImportedPath:
    """The path in the content of a file.

    Args:
        name: of the file; its ending tells G-code.
        most: largest size, [B].

    Raises:
        CodedError: there is no such path; the message names the line.
    """
    check_placing(placing)
    head = _head(data, most)
    if _is_described(data, head):
        if placing != Placing():
            raise CodedError("error.file_described")
        return _remarked(curve_from_text(text_of(data, encoding_of(data[:4]))), [])
    drawing = drawing_of(data, name, unit=placing.unit, layer=placing.layer, most=most)
    return path_of_drawing(drawing, placing)


def path_of_drawing(drawing: LineDrawing, placing: Placing) -> ImportedPath:
    """The path of the wanted lines of a drawing.

    Raises:
        CodedError: there is no such path.
    """
    check_placing(placing)
    return _path(_chosen(drawing.strokes, placing.part), placing, [*drawing.remarks])


def drawing_of(
    data: bytes,
    name: str,
    *,
    unit: str | None = None,
    layer: str | None = None,
    most: int = MOST_BYTES,
) -> LineDrawing:
    """The lines in the content of a file, in the order in which they are drawn.

    Args:
        name: of the file; its ending tells G-code.
        unit: of the numbers in the file, see `Placing`.
        layer: wanted layer, see `Placing`.
        most: largest size, [B].

    Raises:
        CodedError: there are none, or the file describes a path in words; the message names the
            line.
    """
    head = _head(data, most)
    if _is_described(data, head):
        raise CodedError("error.file_described")
    strokes, remarks = _strokes(data, name, head, unit, layer)
    return LineDrawing(tuple(strokes), tuple(remarks))


def _head(data: bytes, most: int) -> str:
    """The beginning of a file.

    Raises:
        CodedError: the file is too large or empty.
    """
    if len(data) > most:
        raise CodedError("error.file_size", most=f"{most / 1e6:g}")
    if not data.strip():
        raise CodedError("error.file_empty")
    return data[:400].decode(encoding_of(data[:4]), errors="replace")


def _is_described(data: bytes, head: str) -> bool:
    return len(data) <= 4 * LONGEST_TEXT and is_described(head) and not is_signature(head)


def path_through(points: Array, placing: Placing) -> ImportedPath:
    """The path through an array of points, shape (n, 2), [m].

    Raises:
        ValueError: there is no such path.
    """
    check_placing(placing)
    distinct(points, least=2)
    return _path([Stroke(points, placing.closed, straight=False)], placing, [])


def _path(strokes: Sequence[Stroke], placing: Placing, remarks: list[Message]) -> ImportedPath:
    """The path of lines, with the remarks on them and some more."""
    lines = placed(strokes, placing)
    curve = curve_of(lines, placing)
    if curve.raised:
        count, share = len(curve.raised), f"{100 * raised_share(curve):.0f}"
        remarks.append(Message("say.raised", {"count": count, "share": share}))
        if not _keeps_order(curve, lines):
            remarks.append(Message("say.reordered"))
    if placing.corners == ROUND:
        radius = f"{1e3 * least_radius(curve):.1f}"
        remarks.append(Message("say.rounded", {"radius": radius}))
    return _remarked(curve, remarks)


def _keeps_order(curve: SplineCurve, strokes: Sequence[Stroke]) -> bool:
    """Whether the pen comes down on the beginnings of strokes, in their order."""
    down = [curve.begin, *(end for _, end in curve.raised if end < np.pi)]
    ends = np.array([stroke.points[k] for k in (0, -1) for stroke in strokes])
    apart = np.linalg.norm(curve.at(np.array(down))[:, None] - ends, axis=-1)
    nearest = apart.argmin(axis=1)
    return nearest[-1] < len(strokes) and bool((np.diff(nearest) > 0).all())


def read_reference(text: str) -> tuple[Path, Placing]:
    """File and options of a text such as `logo.svg fit=0.1 open`; the name may contain spaces.

    Raises:
        CodedError: an option is unknown or has an impossible value.
    """
    words, placing = text.split(" "), Placing()
    while len(words) > 1 and (found := _option(words[-1])) is not None:
        placing = replace(placing, **found)
        words.pop()
    return Path(" ".join(words).strip()), placing


def _option(word: str) -> dict[str, object] | None:
    """An option by the name of its field; None if the word is not one."""
    if not word or word in WORDS:
        return {"closed": word == "closed"} if word else {}
    name, equals, value = word.partition("=")
    if not equals:
        return None
    try:
        if name in (*NUMBERS, "turn"):
            return {name: float(value)}
        if name == "part":
            return {name: tuple(int(each) for each in value.split(","))}
        if name == "centre":
            first, second = value.split(",")
            return {name: (float(first), float(second))}
    except ValueError:
        raise CodedError("error.file_option", name=name, value=repr(value[:20])) from None
    if name in ("unit", "corners", "layer"):
        return {name: value}
    known = [*NUMBERS, "turn", "part", "layer", "centre", "unit", "corners", *WORDS]
    raise unknown_name(name, known, "option")


def check_placing(placing: Placing) -> None:
    """Refuse impossible options."""
    for name in NUMBERS:
        value = getattr(placing, name)
        if value is not None and not 1e-6 <= value <= 1e6:
            raise CodedError("error.file_option", name=name, value=f"{value:g}")
    for value in placing.centre or ():
        if not abs(value) <= LARGEST:
            raise CodedError("error.file_option", name="centre", value=f"{value:g}")
    if not abs(placing.turn) <= 360:
        raise CodedError("error.file_option", name="turn", value=f"{placing.turn:g}")
    parts = placing.part
    if parts is not None and not (0 < len(parts) <= MOST_PARTS and len({*parts}) == len(parts)):
        raise CodedError("error.file_option", name="part", value=repr(parts)[:40])
    if placing.unit is not None and placing.unit not in UNITS:
        raise unknown_name(placing.unit, list(UNITS), "unit")
    if placing.corners not in (SMOOTH, ROUND):
        raise unknown_name(placing.corners, [SMOOTH, ROUND], "corners")
    if placing.corners == SMOOTH and placing.radius != RADIUS:
        raise CodedError("error.file_radius")


def _strokes(
    data: bytes, name: str, head: str, unit: str | None, layer: str | None
) -> tuple[Sequence[Stroke], list[Message]]:
    """The lines of a file, and remarks on what was left out."""
    if is_signature(head):
        strokes = strokes_of_signature(text_of(data, encoding_of(data[:4])))
        if not strokes:
            raise CodedError("error.file_no_line")
        return _in_units(strokes, unit, UNITS["px"]), []
    if name.lower().endswith(".svg") or head.lstrip("\ufeff \t\r\n").startswith("<"):
        strokes, remarks = strokes_of_svg(data, layer)
        usual = UNITS["px"]
    elif name.lower().endswith(GCODE) or _GCODE.match(head):
        text = text_of(data, encoding_of(data[:4]))
        strokes, remarks = strokes_of_gcode(text, layer)
        usual = UNITS["mm"]
    else:
        return strokes_of_table(data, unit), []
    if not strokes:
        raise CodedError("error.file_no_line")
    lines = joined(_in_units(strokes, unit, usual))
    if lines.repeats:
        remarks.append(Message("say.repeats", {"count": lines.repeats}))
    if lines.specks:
        remarks.append(Message("say.specks", {"count": lines.specks}))
    return lines.strokes, remarks


def _in_units(strokes: list[Stroke], unit: str | None, usual: float) -> list[Stroke]:
    """The strokes in the unit that the user gives, instead of the usual one, [m]."""
    if unit is None:
        return strokes
    factor = UNITS[unit] / usual
    return [replace(stroke, points=factor * stroke.points) for stroke in strokes]


def _chosen(strokes: Sequence[Stroke], parts: tuple[int, ...] | None) -> Sequence[Stroke]:
    """The lines to follow.

    Raises:
        CodedError: there is no such line.
    """
    for part in parts or ():
        if not 1 <= part <= len(strokes):
            raise CodedError("error.file_part", part=str(part), count=len(strokes))
    return strokes if parts is None else [strokes[part - 1] for part in parts]


def _remarked(curve: Curve, remarks: list[Message]) -> ImportedPath:
    far = deviation_remark(curve)
    return ImportedPath(curve, (*remarks, far) if far else tuple(remarks))
