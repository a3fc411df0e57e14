"""Lengths, transforms, viewports and shapes of SVG drawings, as matrices and points.

A matrix has the shape (3, 3), a line the shape (n, 2); lengths are in pixels of 1/96 inch or in the
units of a viewport. Whatever cannot be read raises ValueError.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from onpath.models.arrays import Array

if TYPE_CHECKING:
    from svgpathtools import Arc, Line

TURN = 0.05  # [rad], mean turn between two points of a curve
FEWEST, MOST = 4, 64  # straight pieces of a curve
PIXELS: Mapping[str, float] = {
    "": 1.0,
    "px": 1.0,
    "in": 96.0,
    "cm": 96 / 2.54,
    "mm": 96 / 25.4,
    "q": 24 / 25.4,
    "pt": 96 / 72,
    "pc": 16.0,
    "em": 16.0,
    "rem": 16.0,
    "ex": 8.0,
    "m": 96 / 0.0254,
}
"""Units of length, [px]."""
ANGLES: Mapping[str, float] = {
    "": np.pi / 180,
    "deg": np.pi / 180,
    "grad": np.pi / 200,
    "rad": 1.0,
    "turn": 2 * np.pi,
}
SIDES: Mapping[str, float] = {"left": 0, "top": 0, "center": 0.5, "right": 1, "bottom": 1}
_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
_LENGTH = re.compile(rf"\s*({_NUMBER})\s*(%|[a-zA-Z]*)\s*", re.ASCII)
_FUNCTION = re.compile(r"[\s,]*([a-zA-Z]+)\s*\(([^()]*)\)[\s,]*")
_GAP = r"[\s,]*"
_ARC = re.compile(
    _GAP.join([_NUMBER, _NUMBER, _NUMBER, "[01]", "[01]", f"({_NUMBER})", f"({_NUMBER})"]) + _GAP
)
_ALIGNED = re.compile(r"\s*x(Min|Mid|Max)Y(Min|Mid|Max)(?:\s+(meet|slice))?\s*")
_SHARES = {"Min": 0.0, "Mid": 0.5, "Max": 1.0}
Box = tuple[float, float, float, float]
Size = tuple[float, float]


def length(text: str | None, whole: float) -> float | None:
    """A length, [px]; None if there is none, or it is automatic.

    Args:
        whole: what 100 % is.
    """
    if text is None or text.strip() in ("", "auto"):
        return None
    found = _LENGTH.fullmatch(text)
    if found is None or found[2].lower() not in (*PIXELS, "%"):
        raise ValueError(f"{text[:20]!r} is not a length")
    value = float(found[1])
    return value * whole / 100 if found[2] == "%" else value * PIXELS[found[2].lower()]


def view_box(text: str | None) -> Box | None:
    """The part of a drawing's plane that is shown; None if it is not stated."""
    numbers = [float(each) for each in re.findall(_NUMBER, text or "", re.ASCII)]
    if len(numbers) != 4 or min(numbers[2:]) <= 0 or not np.isfinite(numbers).all():
        return None
    x, y, width, height = numbers
    return x, y, width, height


def viewport(box: Box, size: Size, aspect: str | None) -> Array:
    """The matrix that shows a box in a viewport of a size.

    Args:
        aspect: attribute `preserveAspectRatio`.
    """
    x, y, width, height = box
    scales = size[0] / width, size[1] / height
    shares = 0.0, 0.0
    if (aspect or "").strip() != "none":
        found = _ALIGNED.fullmatch(aspect or "")
        shares = (_SHARES[found[1]], _SHARES[found[2]]) if found else (0.5, 0.5)
        slices = found is not None and found[3] == "slice"
        scales = ((max if slices else min)(scales),) * 2
    return matrix(
        *(scales[0], 0, 0, scales[1]),
        shares[0] * (size[0] - scales[0] * width) - scales[0] * x,
        shares[1] * (size[1] - scales[1] * height) - scales[1] * y,
    )


def matrix(a: float, b: float, c: float, d: float, e: float, f: float) -> Array:
    """The matrix that SVG calls matrix(a, b, c, d, e, f)."""
    return np.array([[a, c, e], [b, d, f], [0.0, 0.0, 1.0]])


def shift(x: float, y: float) -> Array:
    """The matrix of a translation."""
    return matrix(1, 0, 0, 1, x, y)


def transform(text: str | None, origin: str | None, size: Size) -> Array:
    """The matrix of the attribute or property `transform`, about its origin.

    Args:
        size: of the viewport, for shares of it.
    """
    if text is None or text.strip() in ("", "none"):
        return np.identity(3)
    product, at = np.identity(3), 0
    while at < len(text):
        found = _FUNCTION.match(text, at)
        if found is None:
            raise ValueError(f"{text[at : at + 30]!r} is no transform")
        product = product @ _function(found[1].lower(), found[2], size)
        at = found.end()
    if origin is not None and (words := origin.split()):
        at = _origin(words, size)
        return shift(*at) @ product @ shift(-at[0], -at[1])
    return product


def _origin(words: list[str], size: Size) -> tuple[float, float]:
    if words[0] in ("top", "bottom") or (len(words) > 1 and words[1] in ("left", "right")):
        words = [*words[1:2], words[0]] if len(words) > 1 else ["center", words[0]]
    at = list[float]()
    for word, whole in zip([*words, "center"], size, strict=False):
        at.append(SIDES[word] * whole if word in SIDES else length(word, whole) or 0.0)
    return at[0], at[1]


def _function(name: str, text: str, size: Size) -> Array:
    words = text.replace(",", " ").split()
    if name in ("rotate", "skewx", "skewy", "skew"):
        angle = _angle(words[0]) if words else np.nan
        if name == "rotate" and len(words) in (1, 3):
            turn = matrix(np.cos(angle), np.sin(angle), -np.sin(angle), np.cos(angle), 0, 0)
            x, y = (length(word, 0) or 0.0 for word in words[1:] or "00")
            return shift(x, y) @ turn @ shift(-x, -y)
        if name == "skewy" and len(words) == 1:
            return matrix(1, np.tan(angle), 0, 1, 0, 0)
        if name in ("skewx", "skew") and len(words) <= (2 if name == "skew" else 1):
            other = _angle(words[1]) if len(words) > 1 else 0.0
            return matrix(1, np.tan(other), np.tan(angle), 1, 0, 0)
        raise ValueError(f"{name}({text[:20]}) is no transform")
    whole = {"translatex": size[:1], "translatey": size[1:]}.get(name, size)
    if name.startswith("translate") and len(words) <= len(whole):
        moved = [length(word, each) or 0.0 for word, each in zip(words, whole, strict=False)]
        if name == "translatey":
            return shift(0, *moved)
        return shift(moved[0], moved[1] if len(moved) > 1 else 0.0)
    numbers = [length(word, 1.0) or 0.0 for word in words]
    match name, numbers:
        case "matrix", [a, b, c, d, e, f]:
            return matrix(a, b, c, d, e, f)
        case "scale", [x]:
            return matrix(x, 0, 0, x, 0, 0)
        case "scale", [x, y]:
            return matrix(x, 0, 0, y, 0, 0)
        case "scalex", [x]:
            return matrix(x, 0, 0, 1, 0, 0)
        case "scaley", [y]:
            return matrix(1, 0, 0, y, 0, 0)
        case _:
            raise ValueError(f"{name}({text[:20]}) is no transform")


def _angle(word: str) -> float:
    found = _LENGTH.fullmatch(word)
    if found is None or found[2].lower() not in ANGLES:
        raise ValueError(f"{word[:20]!r} is not an angle")
    return float(found[1]) * ANGLES[found[2].lower()]


# Shapes


def lines_of(
    tag: str, given: Callable[[str], str | None], size: Size, counted: Callable[[int], object]
) -> Iterator[Array]:
    """The lines of a shape, each without gaps.

    Args:
        tag: of the element, one of `DRAWN`.
        given: its attribute or property by name.
        size: of the viewport, for shares of it.
        counted: takes the number of points of each piece; may refuse more.
    """
    diagonal = float(np.hypot(*size) / np.sqrt(2))

    def get(name: str) -> float | None:
        whole = {"x": size[0], "y": size[1]}.get(name.strip("12cr"), diagonal)
        whole = {"width": size[0], "height": size[1], "r": diagonal}.get(name, whole)
        return length(given(name), whole)

    if tag == "path":
        yield from _path(given, counted)
        return
    for line in SHAPES[tag](given, get):
        counted(len(line))
        yield line


Given = Callable[[str], str | None]
Get = Callable[[str], float | None]


def _path(given: Given, counted: Callable[[int], object]) -> Iterator[Array]:
    from svgpathtools import parse_path

    part, end, text = list[Array](), None, given("d") or ""
    try:
        path = parse_path(text)
    except AssertionError:  # of an arc that ends where it begins, which is none
        path = parse_path(re.sub(r"a([^A-DF-Za-df-z]*)", _without_points, text))
    for piece in path:
        points = _points(piece)
        counted(len(points) - 1)
        if end is None or abs(piece.start - end) > 1e-9 * max(1.0, abs(end)):
            if part:
                yield np.vstack(part)
            part = [points[:1]]
        part.append(points[1:])
        end = piece.end
    if part:
        yield np.vstack(part)


def _without_points(arcs: re.Match[str]) -> str:
    """Relative arcs without those that end where they begin."""
    kept = _ARC.sub(lambda each: each[0] if float(each[1]) or float(each[2]) else " ", arcs[1])
    return f"a{kept}" if kept.strip(" ,") else " "


def _points(piece: Line | Arc) -> Array:
    """Points of a straight line, a Bézier curve or an arc."""
    from svgpathtools import Arc

    if isinstance(piece, Arc):
        turned = np.deg2rad(abs(float(piece.delta)))
        angle = np.deg2rad(piece.theta + piece.delta * np.linspace(0, 1, _count(turned) + 1))
        radius, turn = piece.radius, np.exp(1j * np.deg2rad(piece.rotation))
        z = piece.center + turn * (radius.real * np.cos(angle) + 1j * radius.imag * np.sin(angle))
        z[0], z[-1] = piece.start, piece.end
    else:
        knots = np.array(piece.bpoints(), dtype=complex)
        sides = np.diff(knots)
        sides = sides[np.abs(sides) > 0]
        turned = sum(abs(float(np.angle(b / a))) for a, b in pairwise(sides))
        z, t = knots[:, None], np.linspace(0, 1, _count(turned) + 1 if len(knots) > 2 else 2)
        while len(z) > 1:  # de Casteljau
            z = (1 - t) * z[:-1] + t * z[1:]
        z = z[0]
    return np.column_stack([z.real, z.imag])


def _count(turned: float) -> int:
    return int(np.clip(np.ceil(turned / TURN), FEWEST, MOST)) if np.isfinite(turned) else FEWEST


def _oval(_: Given, get: Get) -> Iterator[Array]:
    rx, ry = get("rx"), get("ry")
    rx, ry = (rx if rx is not None else ry), (ry if ry is not None else rx)
    yield from _ring(get("cx") or 0.0, get("cy") or 0.0, rx or 0.0, ry or 0.0)


def _circle(_: Given, get: Get) -> Iterator[Array]:
    radius = get("r") or 0.0
    yield from _ring(get("cx") or 0.0, get("cy") or 0.0, radius, radius)


def _ring(x: float, y: float, rx: float, ry: float) -> Iterator[Array]:
    if rx > 0 and ry > 0:
        angle = np.linspace(0, 2 * np.pi, int(2 * np.pi / TURN) + 1)
        ring = np.column_stack([x + rx * np.cos(angle), y + ry * np.sin(angle)])
        ring[-1] = ring[0]
        yield ring


def _rectangle(_: Given, get: Get) -> Iterator[Array]:
    x, y, width, height = (get(name) or 0.0 for name in ("x", "y", "width", "height"))
    if width <= 0 or height <= 0:
        return
    rx, ry = get("rx"), get("ry")
    rx, ry = (rx if rx is not None else ry) or 0.0, (ry if ry is not None else rx) or 0.0
    rx, ry = min(rx, width / 2), min(ry, height / 2)
    quarter = np.linspace(0, np.pi / 2, int(np.pi / 2 / TURN) if rx > 0 and ry > 0 else 1)
    centres = (
        (x + width - rx, y + height - ry),
        (x + rx, y + height - ry),
        (x + rx, y + ry),
        (x + width - rx, y + ry),
    )
    if rx <= 0 or ry <= 0:
        corners = np.array([[0.0, 0], [1, 0], [1, 1], [0, 1], [0, 0]])
        yield np.array([x, y]) + corners * (width, height)
        return
    arcs = [
        np.column_stack(
            [cx + rx * np.cos(quarter + i * np.pi / 2), cy + ry * np.sin(quarter + i * np.pi / 2)]
        )
        for i, (cx, cy) in enumerate(centres)
    ]
    yield np.vstack([*arcs, arcs[0][:1]])


def _line(_: Given, get: Get) -> Iterator[Array]:
    x1, y1, x2, y2 = (get(name) or 0.0 for name in ("x1", "y1", "x2", "y2"))
    yield np.array([[x1, y1], [x2, y2]])


def _polyline(given: Given, _: Get) -> Iterator[Array]:
    text = given("points") or ""
    if re.sub(_NUMBER, "", text, flags=re.ASCII).strip(", \t\r\n"):
        raise ValueError(f"{text[:20]!r} are not points")
    numbers = [float(each) for each in re.findall(_NUMBER, text, re.ASCII)]
    points = np.array(numbers[: len(numbers) // 2 * 2]).reshape(-1, 2)
    if len(points) > 1:
        yield points


def _polygon(given: Given, get: Get) -> Iterator[Array]:
    for points in _polyline(given, get):
        yield np.vstack([points, points[:1]])


SHAPES: Mapping[str, Callable[[Given, Get], Iterator[Array]]] = {
    "circle": _circle,
    "ellipse": _oval,
    "rect": _rectangle,
    "line": _line,
    "polyline": _polyline,
    "polygon": _polygon,
}
DRAWN = ("path", *SHAPES)
"""Tags of elements with lines."""
