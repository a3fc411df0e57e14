"""Reads the strokes of a signature as signature_pad's `toData()` gives it: JSON.

A list of strokes, each a list of points or an object with "points"; a point has "x" and "y", in
pixels of 1/96 inch. The y axis points up, as in the plane of a path.
"""

from __future__ import annotations

import json
import re
from typing import Any, cast

import numpy as np

from onpath.models.errors import CodedError
from onpath.models.path_files.stroke import UNITS, Stroke, check_count

LARGEST = 1e6  # [px]
_BEGIN = re.compile(r"[\ufeff\s]*\[\s*(?:\[\s*)?\{")


def is_signature(head: str) -> bool:
    """Whether a text is for `strokes_of_signature`, by how it begins."""
    return _BEGIN.match(head) is not None


def strokes_of_signature(text: str) -> list[Stroke]:
    """The strokes, in the order in which they were drawn.

    Raises:
        CodedError: the text is no such list.
    """
    try:
        data: Any = json.loads(text)
    except json.JSONDecodeError as error:
        line, column = str(error.lineno), str(error.colno)
        raise CodedError("error.signature_json", line=line, column=column) from None
    except (RecursionError, ValueError):
        raise CodedError("error.signature", stroke="1") from None
    strokes, count = list[Stroke](), 0
    for number, group in enumerate(cast("list[Any]", data), start=1):
        given: Any = (
            cast("dict[str, Any]", group).get("points") if isinstance(group, dict) else group
        )
        try:
            flat = [(_number(point["x"]), -_number(point["y"])) for point in given]
        except (TypeError, KeyError, ValueError):
            raise CodedError("error.signature", stroke=str(number)) from None
        count += len(flat)
        check_count(count, 1)
        if flat:
            points = UNITS["px"] * np.array(flat)
            strokes.append(Stroke(points, closed=False, straight=False, name=f"stroke {number}"))
    return strokes


def _number(value: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float) or not abs(value) <= LARGEST:
        raise ValueError
    return float(value)
