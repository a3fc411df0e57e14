"""Validates the values that a browser sends for widgets: type, finiteness and range."""

from __future__ import annotations

import math
from typing import Any

import viser

Number = float | int
Bound = Number | None


class Refused(ValueError):
    """The widget cannot have this value; the message says what was expected."""


def accepted_value(handle: Any, value: object, max_text_length: int) -> Any:
    """The value that a widget takes when a browser sends `value`.

    Numbers outside the widget's limits are clamped and long texts are cut, because users may type
    them. Values that no widget sends are refused.

    Args:
        handle: the widget, any of viser's GUI input handles.
        value: as decoded from the wire.
        max_text_length: [characters].

    Raises:
        Refused: wrong type, not finite, not an option, or a widget that is disabled or
            takes no values.
    """
    if getattr(handle, "disabled", False):
        raise Refused("expected nothing, it is disabled")
    match handle:
        case viser.GuiButtonHandle() | viser.GuiCheckboxHandle():
            if isinstance(value, bool):
                return value
            raise Refused("expected true or false")
        case viser.GuiDropdownHandle() | viser.GuiButtonGroupHandle():
            if value in handle.options:
                return value
            raise Refused("expected one of the options")
        case viser.GuiTextHandle():
            if isinstance(value, str):
                return value[:max_text_length]
            raise Refused("expected a text")
        case viser.GuiSliderHandle() | viser.GuiNumberHandle():
            return _number(value, handle.value, handle.min, handle.max)
        case _:
            raise Refused("expected nothing, it takes no value")


def _number(value: object, like: Number, low: Bound, high: Bound) -> Number:
    """The value clamped, in the type of `like`: an integer slider keeps integers."""
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
        raise Refused("expected a finite number")
    clamped = max(value, -math.inf if low is None else low)
    return type(like)(min(clamped, math.inf if high is None else high))
