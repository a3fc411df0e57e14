"""Paths as users type them: a preset, a circle, an ellipse, a segment, or points.

    circle 0.05                    radius, and optionally the centre, [m]
    ellipse 0.07 0.04 0 0.01       half axes, and optionally the centre, [m]
    segment -0.05 0 0.05 0.02      begin and end, [m]
    closed 0.05 0 0 0.04 -0.05 0   points of a smooth closed path: z1 z2 z1 z2 ..., [m]
    open 0.05 0 0 0.04 -0.05 0     the same for an open path
    implicit z1**2/0.0036 + z2**2/0.0016 - 1   the closed line on which this is 0, z1 and z2 in [m]
    {"closed": true, "points": [[0.05, 0], [0, 0.04], [-0.05, 0]]}
    ellipse                        any preset by its name

Commas count as spaces; a decimal number has a point.
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any, cast

import numpy as np

from onpath.models.arrays import Array
from onpath.models.control.implicit_level import level_function
from onpath.models.errors import CodedError
from onpath.models.paths import curves
from onpath.models.paths.curve_fit import fitted
from onpath.models.paths.curves import Curve
from onpath.models.paths.implicit_curves import implicit_curve
from onpath.models.paths.path_design import USUAL_RADIUS, presets
from onpath.models.systems.parameter_specs import MINUS, unknown_name

LONGEST_TEXT = 50_000  # [characters]
IMPLICIT = "implicit"
LARGEST = 1.0  # [m], of any coordinate or length
FORMS: Mapping[str, tuple[tuple[int, ...], str]] = {
    "circle": ((1, 3), "circle RADIUS [Z1 Z2]"),
    "ellipse": ((2, 4), "ellipse A B [Z1 Z2]"),
    "segment": ((4,), "segment Z1 Z2 Z1 Z2"),
    "closed": (tuple(range(6, 402, 2)), "closed Z1 Z2 Z1 Z2 ..., 3 to 200 points"),
    "open": (tuple(range(4, 402, 2)), "open Z1 Z2 Z1 Z2 ..., 2 to 200 points"),
}


def curve_from_text(text: str, radius: float = USUAL_RADIUS) -> Curve:
    """The curve that a text describes, in coordinates of the path's plane.

    Args:
        radius: of the predefined circle, see `presets`.

    Raises:
        ValueError: the text is too long, names no path, or its numbers do not make one.
    """
    if len(text) > LONGEST_TEXT:
        raise ValueError(f"path: the text has more than {LONGEST_TEXT} characters")
    if text.strip() in presets():
        return presets(radius)[text.strip()].curve
    if text.lstrip().startswith(("{", "[")):
        return _from_json(text)
    if text.lstrip().startswith(IMPLICIT):
        return _implicit(text.lstrip())
    form, *words = text.replace(MINUS, "-").replace(",", " ").split() or [""]
    if "." not in text and (comma := re.search(r"\d+,\d+", text)):  # no path has whole metres
        value = comma[0][:20]
        point = value.replace(",", ".")
        raise CodedError("error.decimal_comma", name="path", value=value, point=point)
    if form not in FORMS:
        known = list(dict.fromkeys([*presets(), *FORMS, IMPLICIT]))
        raise unknown_name(text.strip()[:60], known, "path")
    counts, shape = FORMS[form]
    if len(words) not in counts:
        raise ValueError(f"path: expected {shape}, [m], got {len(words)} numbers")
    return _MAKERS[form](_numbers(words, shape))


def is_described(text: str) -> bool:
    """Whether a text seems to be for `curve_from_text`, by how it begins."""
    begin = text.lstrip("\ufeff \t\r\n")
    return begin.startswith(("{", "[", IMPLICIT, *FORMS, *presets()))


def _implicit(text: str) -> Curve:
    """The path on which an expression of z1 and z2 is 0."""
    equation = text.replace(IMPLICIT, "s".ljust(len(IMPLICIT) - 1) + "=", 1)  # columns stay
    return replace(implicit_curve(level_function(equation)), equation=equation)


def _from_json(text: str) -> Curve:
    """A path from points, or from an object with "points" and perhaps "closed"."""
    shape = 'JSON such as {"closed": true, "points": [[0.05, 0], [0, 0.04], [-0.05, 0]]}, [m]'
    try:
        data: Any = json.loads(text)
    except (ValueError, RecursionError):
        raise ValueError(f"path: expected {shape}") from None
    is_list = isinstance(data, list)
    given = cast("dict[str, Any]", {"points": data} if is_list else data)
    closed = given.get("closed", True)
    if given.keys() - {"points", "closed"} or "points" not in given or not isinstance(closed, bool):
        raise ValueError(f"path: expected {shape}")
    points: Any = given["points"]
    try:
        flat = [number for point in points for number in _pair(point)]
    except (TypeError, ValueError):
        raise ValueError(f"path: expected {shape}") from None
    form = "closed" if closed else "open"
    counts, words = FORMS[form]
    if len(flat) not in counts:
        raise ValueError(f"path: expected {words}, got {len(flat) // 2} points")
    return _MAKERS[form](_numbers(flat, shape))


def _pair(point: Any) -> tuple[float, float]:
    first, second = point
    if not all(isinstance(one, int | float) for one in (first, second)):
        raise TypeError
    return first, second


def _numbers(values: list[Any], shape: str) -> Array:
    """Finite numbers of a reasonable size.

    Raises:
        ValueError: there are others.
    """
    try:
        numbers = np.array([float(value) for value in values])
    except (ValueError, OverflowError):
        raise ValueError(f"path: expected {shape}, [m]") from None
    if not np.all(np.abs(numbers) <= LARGEST):  # NaN fails too
        expected = f"path: expected numbers between -{LARGEST:g} and {LARGEST:g} m"
        largest = float(np.abs(numbers).max())
        asked = f", got {largest:g} m: did you mean {largest / 1000:g}?"
        raise ValueError(expected + (asked if LARGEST < largest < np.inf else ""))
    return numbers


def _circle(numbers: Array) -> Curve:
    return _ellipse(np.array([numbers[0], *numbers]))


def _ellipse(numbers: Array) -> Curve:
    a, b, *centre = numbers.tolist()
    if min(a, b) <= 0:
        raise ValueError("path: radius and half axes must be positive")
    first, second = centre or (0.0, 0.0)
    return curves.ellipse((a, b), (first, second))


def _open(numbers: Array) -> Curve:
    return fitted(numbers.reshape(-1, 2), closed=False)


def _closed(numbers: Array) -> Curve:
    return fitted(numbers.reshape(-1, 2), closed=True)


_MAKERS: Mapping[str, Callable[[Array], Curve]] = {
    "circle": _circle,
    "ellipse": _ellipse,
    "segment": _open,
    "closed": _closed,
    "open": _open,
}
