"""Reads the lines of an SVG drawing: paths, lines, polygons, circles, ellipses and rectangles.

Groups and their transforms count, text, pictures, symbols and styles do not. A length is that on
paper: `width` and `viewBox` of the drawing give the size of its unit, else it is 1/96 of an inch.
The y axis points up, as in the plane of a path.

The shapes are read by svgpathtools, an extra of OnPath. The file is untrusted: DOCTYPE, entities,
deep nesting and too many elements are refused before.
"""

from __future__ import annotations

import re
import warnings
from collections.abc import Callable, Iterator
from functools import partial
from importlib.util import find_spec
from typing import Any
from xml.etree.ElementTree import Element
from xml.parsers import expat

import numpy as np

from onpath.models.arrays import Array
from onpath.models.errors import CodedError
from onpath.models.path_files.stroke import UNITS, Stroke, check_count, drawn_stroke

DEEPEST, MOST_ELEMENTS = 50, 20_000
LONGEST_NAME = 40  # of a line, as far as a message quotes it
CURVED = 48  # straight pieces of a Bézier curve or an arc
GROUPS = ("svg", "g", "a", "switch")
LINE = "line-in-file"
PICA = UNITS["in"] / 6
_LENGTH = re.compile(r"\s*(\d+\.?\d*|\.\d+)\s*(mm|cm|m|in|pt|pc|px|)\s*", re.ASCII)
_SIZES = {**UNITS, "pc": PICA, "": UNITS["px"]}


def strokes_of_svg(data: bytes) -> list[Stroke]:
    """The lines of a drawing, in the order of the file.

    Raises:
        CodedError: svgpathtools is not installed, or the file is not a drawing that can be read;
            the message names the line.
    """
    if find_spec("svgpathtools") is None:
        raise CodedError("error.svg_not_installed")
    root = _DrawingReader().read(data)
    if root.tag != "svg":
        raise CodedError("error.svg_no_drawing")
    unit, strokes, count = _unit(root), list[Stroke](), 0
    for element, path, name in _shapes(root):
        for part in _read(element, list, _continuous(path, int(element.get(LINE, "0")))):
            z = unit * np.column_stack([part.real, -part.imag])
            count += len(z)
            check_count(count, int(element.get(LINE, "0")))
            strokes.append(drawn_stroke(z, name))
    return strokes


class _DrawingReader:
    """Reads XML to elements that know their line; see the module."""

    def __init__(self) -> None:
        self._open, self._count = [Element("file")], 0
        self._parser = expat.ParserCreate(namespace_separator=" ")
        self._parser.StartDoctypeDeclHandler = self._refuse
        self._parser.EntityDeclHandler = self._refuse
        self._parser.StartElementHandler = self._begin
        self._parser.EndElementHandler = self._end

    def read(self, data: bytes) -> Element:
        """The root element."""
        try:
            self._parser.Parse(data, True)
        except expat.ExpatError as error:
            reason = expat.errors.messages[error.code]
            place = str(error.lineno), str(error.offset + 1)
            raise CodedError(
                "error.svg_no_xml", line=place[0], column=place[1], reason=reason
            ) from None
        except CodedError:
            raise
        except (LookupError, ValueError):  # an encoding that does not exist
            raise CodedError("error.file_no_text") from None
        return self._open[0][0]

    def _refuse(self, *_: Any) -> None:
        raise CodedError("error.svg_doctype", line=str(self._parser.CurrentLineNumber))

    def _begin(self, tag: str, attributes: dict[str, str]) -> None:
        self._count += 1
        line = str(self._parser.CurrentLineNumber)
        if len(self._open) > DEEPEST or self._count > MOST_ELEMENTS:
            raise CodedError("error.svg_large", line=line, deepest=DEEPEST, most=MOST_ELEMENTS)
        element = Element(tag.rpartition(" ")[2], attributes | {LINE: line})
        self._open[-1].append(element)
        self._open.append(element)

    def _end(self, _: str) -> None:
        self._open.pop()


def _unit(root: Element) -> float:
    """The size of the drawing's unit, [m]."""
    width, box = _LENGTH.fullmatch(root.get("width", "")), root.get("viewBox", "")
    numbers = [float(each) for each in re.findall(r"[-+]?(?:\d+\.?\d*|\.\d+)", box)[:4]]
    if width is None or len(numbers) != 4 or numbers[2] <= 0:
        return _SIZES[""]
    size = float(width[1]) * _SIZES[width[2]] / numbers[2]
    return size if 0 < size < np.inf else _SIZES[""]


def _shapes(root: Element) -> Iterator[tuple[Element, Any, str]]:
    """Element, path and name of all shapes, in the coordinates of the drawing."""
    from svgpathtools import parse_path
    from svgpathtools.document import CONVERSIONS
    from svgpathtools.parser import parse_transform
    from svgpathtools.path import transform

    waiting, number = [(root, np.identity(3))], 0
    while waiting:
        element, before = waiting.pop()
        tag = element.tag
        if tag not in GROUPS and tag not in CONVERSIONS:
            continue
        own = _read(element, partial(parse_transform, strict=True), element.get("transform"))
        if tag in GROUPS:
            waiting += [(each, before @ own) for each in reversed(element)]
            continue
        number += 1
        described = _read(element, CONVERSIONS[tag], element)
        path = _read(element, transform, _read(element, parse_path, described), before @ own)
        if len(path):
            yield element, path, element.get("id", "")[:LONGEST_NAME] or f"{tag} {number}"


def _read(element: Element, reader: Callable[..., Any], *arguments: Any) -> Any:
    """What svgpathtools reads of an element; whatever it raises is an error of the file."""
    try:
        with np.errstate(all="ignore"), warnings.catch_warnings():
            warnings.simplefilter("ignore")
            return reader(*arguments)
    except CodedError:
        raise
    except Exception as error:  # it raises many kinds, also AssertionError
        reason = str(error).partition("\n")[0][:80] or type(error).__name__
        line = element.get(LINE, "")
        raise CodedError("error.svg_shape", line=line, tag=element.tag, reason=reason) from None


def _continuous(path: Any, line: int) -> Iterator[Array]:
    """The parts of a path without gaps, as complex points."""
    from svgpathtools import Line

    part, count = list[complex](), 0
    steps = np.arange(1, CURVED + 1) / CURVED
    for segment in path:
        if part and abs(segment.start - part[-1]) > 1e-9 * max(1.0, abs(part[-1])):
            yield np.array(part)
            part = []
        if not part:
            part.append(complex(segment.start))
        between = (1.0,) if isinstance(segment, Line) else steps
        count += len(between)
        check_count(count, line)
        with np.errstate(all="ignore"):
            part += [complex(segment.point(float(t))) for t in between]
        if not np.isfinite(part[-1]):
            raise CodedError("error.svg_shape", line=str(line), tag="path", reason="not finite")
    if part:
        yield np.array(part)
