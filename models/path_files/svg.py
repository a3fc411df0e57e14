"""Reads the lines of an SVG drawing: paths, lines, polygons, circles, ellipses and rectangles.

Lengths and places are those that a browser gives them: transforms, styles, viewports, symbols and
`use` count. Where nothing states a size, a unit of the drawing is 1/96 of an inch. The y axis
points up, as in the plane of a path. Clips, dashes and animations have no effect.

Outlines of filled shapes are lines, too; beside strokes, small ones are left out, which are
letters, dots and heads of arrows. What paints nothing, or white on white, is drawn only if nothing
else is there; hidden layers and definitions are not. Text and pictures have no lines, and are said
to be left out.

Paths are read by svgpathtools and style sheets by tinycss2, an extra of OnPath. The file is
untrusted: what multiplies it, such as entities and `use`, is bounded.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from enum import IntEnum
from importlib.util import find_spec
from typing import Any
from xml.etree.ElementTree import Element

import numpy as np

from onpath.models.arrays import Array
from onpath.models.errors import CodedError, Message
from onpath.models.path_files.stroke import UNITS, Stroke, check_count, drawn_stroke
from onpath.models.path_files.svg_document import (
    DEEPEST,
    LAYER,
    LINE,
    LINK,
    MOST_ELEMENTS,
    read_document,
    too_large,
)
from onpath.models.path_files.svg_geometry import (
    DRAWN,
    Size,
    length,
    lines_of,
    shift,
    transform,
    view_box,
    viewport,
)
from onpath.models.path_files.svg_styles import (
    Style,
    StyledElement,
    StyleSheets,
    is_drawn,
    is_painted,
    is_zero,
)

LONGEST_NAME = 40  # of a line, as far as a message quotes it
GROUPS = ("g", "a", "svg", "symbol", "switch")
LEFT_OUT = ("text", "image", "foreignObject")
USUAL = 300.0, 150.0  # [px], size of a drawing that states none
SMALL = 0.1  # of the drawing's size, of letters, dots and heads of arrows
FONT = "glyph"


class Paint(IntEnum):
    """How the outline of a shape can be seen."""

    LINE, FILLED, UNSEEN = range(3)


@dataclass(frozen=True, slots=True, eq=False)
class _Outline:
    stroke: Stroke
    paint: Paint


@dataclass(frozen=True, slots=True)
class _Context:
    """What the elements around an element give it.

    Attributes:
        matrix: from its coordinates to pixels.
        size: of its viewport.
        style: of the element around it.
        place: the element around it, None for the root.
        depth: number of elements around it, uses counted.
        inside: whether it is in the wanted layer.
        used: size that a `use` gives a symbol or a drawing.
    """

    matrix: Array
    size: Size
    style: Style
    place: StyledElement | None
    depth: int
    inside: bool
    used: tuple[str | None, str | None] = (None, None)


def strokes_of_svg(data: bytes, layer: str | None = None) -> tuple[list[Stroke], list[Message]]:
    """The lines of a drawing, in the order of the file, and what was left out.

    Args:
        layer: name of the layer to draw; None: all that are shown.

    Raises:
        CodedError: a library is not installed, the file is not a drawing that can be read, or has
            no lines; the message names the line, or says what to do.
    """
    if find_spec("svgpathtools") is None or find_spec("tinycss2") is None:
        raise CodedError("error.svg_not_installed")
    root = read_document(data)
    reader = _DrawingReader(root, layer)
    with np.errstate(all="ignore"):  # what overflows is refused
        outlines = reader.outlines()
    if not outlines:
        if layer is not None:
            names = ", ".join(dict.fromkeys(reader.layers)) or "–"
            raise CodedError("error.file_layer", layer=layer[:LONGEST_NAME], names=names[:200])
        if any(each.tag == FONT for each in root.iter()):
            raise CodedError("error.svg_only", what="font")
        for tag in LEFT_OUT:
            if tag in reader.left_out:
                raise CodedError("error.svg_only", what="image" if tag == "image" else "text")
        raise CodedError("error.file_no_line")
    return _shown(outlines, reader)


def _shown(outlines: list[_Outline], reader: _DrawingReader) -> tuple[list[Stroke], list[Message]]:
    """The lines that a reader of the drawing would call its lines."""
    seen = [each for each in outlines if each.paint < Paint.UNSEEN and not reader.is_ground(each)]
    seen = seen or [each for each in outlines if each.paint < Paint.UNSEEN] or outlines
    remarks = list[Message]()
    if any(each.paint == Paint.LINE for each in seen):
        size = SMALL * _size(seen)
        lines = [each for each in seen if each.paint == Paint.LINE or _size([each]) >= size]
        if len(lines) < len(seen):
            remarks.append(Message("say.svg_filled", {"count": len(seen) - len(lines)}))
        seen = lines
    if reader.left_out:
        only = "image" if reader.left_out == {"image"} else "text"
        remarks.append(Message("say.svg_left_out", {"what": only}))
    return [each.stroke for each in seen], remarks


def _size(outlines: Sequence[_Outline]) -> float:
    """The larger side of the box around them."""
    low = np.min([each.stroke.points.min(0) for each in outlines], axis=0)
    high = np.max([each.stroke.points.max(0) for each in outlines], axis=0)
    with np.errstate(all="ignore"):
        return float((high - low).max())


class _DrawingReader:
    """Walks through a drawing.

    Attributes:
        layers: names of its layers.
        left_out: tags of elements that are shown but have no lines.
    """

    def __init__(self, root: Element, layer: str | None) -> None:
        self._root, self._layer = root, layer
        self._sheets = StyleSheets(root)
        self._named = dict[str, Element]()
        for element in root.iter():
            if name := element.get("id"):
                self._named.setdefault(name, element)
        self._drawn, self._points, self._shapes = 0, 0, 0
        self._page = (0.0, 0.0)
        self.layers, self.left_out = list[str](), set[str]()

    def outlines(self) -> list[_Outline]:
        """All lines that are not hidden."""
        around = _Context(
            matrix=np.identity(3),
            size=USUAL,
            style={},
            place=None,
            depth=0,
            inside=self._layer is None,
        )
        return list(self._visit(self._root, around))

    def is_ground(self, outline: _Outline) -> bool:
        """Whether it is the sheet behind the drawing: only filled, and as large as the page."""
        if outline.paint == Paint.LINE or not all(self._page):
            return False
        px = outline.stroke.points / UNITS["px"]
        return bool((np.ptp(px, axis=0) >= 0.99 * np.array(self._page)).all())

    def _visit(self, element: Element, around: _Context) -> Iterator[_Outline]:
        """The lines of an element and those in it."""
        tag = element.tag
        if tag not in GROUPS and tag not in DRAWN and tag not in LEFT_OUT and tag != "use":
            return
        self._drawn += 1
        if around.depth > 2 * DEEPEST or self._drawn > 2 * MOST_ELEMENTS:
            raise too_large(element.get(LINE, "0"))
        place = self._sheets.place(element, around.place)
        style = self._sheets.style(element, place, around.style)
        inside = around.inside or self._is_layer(element)
        if not is_drawn(style) and inside == around.inside:  # a hidden layer may be asked for
            return
        context = replace(
            around,
            matrix=around.matrix @ self._transform(element, style, around.size),
            style=style,
            place=place,
            depth=around.depth + 1,
            inside=inside,
        )
        if tag in LEFT_OUT:
            if inside and _is_visible(style):
                self.left_out.add(tag)
        elif tag == "use":
            yield from self._use(element, context)
        elif tag in DRAWN:
            if inside:
                yield from self._shape(element, context)
        else:
            if tag in ("svg", "symbol"):
                context = self._framed(element, context)
            for child in _children(element):
                if child.tag != "symbol":
                    yield from self._visit(child, replace(context, used=(None, None)))

    def _is_layer(self, element: Element) -> bool:
        names = [element.get(LAYER), element.get("id")] if element.tag == "g" else []
        if names and names[0]:
            self.layers.append(names[0])
        return self._layer is not None and self._layer in names

    def _transform(self, element: Element, style: Style, size: Size) -> Array:
        origin = style.get("transform-origin")
        return _read(element, lambda: transform(style.get("transform"), origin, size))

    def _use(self, element: Element, context: _Context) -> Iterator[_Outline]:
        target = self._named.get(element.get(LINK, "").strip().removeprefix("#"))
        if target is None:
            return
        style, size = context.style, context.size
        x, y = (
            _read(element, lambda i=i, n=n: length(style.get(n), size[i])) or 0.0
            for i, n in enumerate("xy")
        )
        used = style.get("width"), style.get("height")
        moved = replace(context, matrix=context.matrix @ shift(x, y), used=used)
        yield from self._visit(target, moved)

    def _framed(self, element: Element, context: _Context) -> _Context:
        """The context in a viewport."""
        style, size, box = context.style, context.size, view_box(element.get("viewBox"))
        outer = context.place is not None and context.place.parent is None

        def get(name: str, i: int) -> float | None:
            text = style.get(name)
            if name == "width" or name == "height":
                text = context.used[i] or text
                if outer and (text or "").strip().endswith("%"):
                    return None
            return _read(element, lambda: length(text, size[i]))

        width, height = get("width", 0), get("height", 1)
        if outer:
            shown = box[2:] if box else USUAL
            if width is None:
                width = shown[0] * (height / shown[1] if height is not None else 1.0)
            if height is None:
                height = shown[1] * width / shown[0]
            if width <= 0 or height <= 0:
                width, height = shown
            self._page, at = (width, height), (0.0, 0.0)
        else:
            width = size[0] if width is None else width
            height = size[1] if height is None else height
            at = get("x", 0) or 0.0, get("y", 1) or 0.0
        matrix = context.matrix @ shift(*at)
        if box is None:
            return replace(context, matrix=matrix, size=(width, height))
        framed = viewport(box, (width, height), element.get("preserveAspectRatio"))
        return replace(context, matrix=matrix @ framed, size=box[2:])

    def _shape(self, element: Element, context: _Context) -> Iterator[_Outline]:
        style, line = context.style, int(element.get(LINE, "0"))
        if not _is_visible(style):
            return
        paint = _paint(style)
        self._shapes += 1
        name = element.get("id", "")[:LONGEST_NAME] or f"{element.tag} {self._shapes}"

        def counted(points: int) -> None:
            self._points += points
            check_count(self._points, line)

        def given(name: str) -> str | None:
            return style.get(name, element.get(name))

        parts = lines_of(element.tag, given, context.size, counted)
        for points in _read(element, lambda: list(parts)):
            z = points @ context.matrix[:2, :2].T + context.matrix[:2, 2]
            if not np.isfinite(z).all():
                raise CodedError(
                    "error.svg_shape", line=str(line), tag=element.tag, reason="not finite"
                )
            yield _Outline(drawn_stroke(UNITS["px"] * z * (1, -1), name), paint)


def _children(element: Element) -> Sequence[Element]:
    """The children that are drawn: of a switch the first."""
    if element.tag != "switch":
        return list(element)
    known = (each for each in element if not each.get("requiredExtensions"))
    return [each for each in known if each.tag in (*GROUPS, *DRAWN, "use", "text")][:1]


def _is_visible(style: Style) -> bool:
    return style.get("visibility", "visible").strip() not in ("hidden", "collapse")


def _paint(style: Style) -> Paint:
    if is_painted(style, "stroke", "none") and not is_zero(style.get("stroke-width", "1")):
        return Paint.LINE
    return Paint.FILLED if is_painted(style, "fill", "black") else Paint.UNSEEN


def _read(element: Element, reader: Any) -> Any:
    """What is read of an element; whatever a library raises is an error of the file."""
    try:
        with np.errstate(all="ignore"), warnings.catch_warnings():
            warnings.simplefilter("ignore")
            return reader()
    except CodedError:
        raise
    except Exception as error:  # svgpathtools raises many kinds, also AssertionError
        reason = str(error).partition("\n")[0][:80] or type(error).__name__
        line = element.get(LINE, "")
        raise CodedError("error.svg_shape", line=line, tag=element.tag, reason=reason) from None
