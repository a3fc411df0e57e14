"""Whether a message from a browser has the form that its dataclass declares, before it is built."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from functools import cache
from typing import Any, Literal, Union, get_args, get_origin, get_type_hints

import msgspec


def fault(raw: bytes | str, forms: Mapping[str, type[Any]], max_magnitude: float) -> str | None:
    """What is wrong with a message, in our own words only; None when nothing is.

    Args:
        raw: one websocket message; a good one is a msgpack map with its form's name as "type".
        forms: the dataclasses that may come, by name.
        max_magnitude: of any number.
    """
    if isinstance(raw, str):
        return "a text frame"
    try:
        fields = msgspec.msgpack.decode(raw, type=dict[str, Any])
    except (ValueError, RecursionError, MemoryError):
        return "what is no message"
    name = fields.pop("type", None)
    form = forms.get(name) if isinstance(name, str) else None
    if form is None:
        return "a message that no browser may send"
    hints, required = _declared(form)
    if not required <= fields.keys() <= hints.keys():
        return f"{name} with wrong fields"
    for key, value in fields.items():
        if not _conforms(value, hints[key], max_magnitude):
            return f"{name} with a wrong {key}"
    return None if _coherent(fields) else f"{name} that makes no sense"


@cache
def _declared(form: type[Any]) -> tuple[dict[str, Any], frozenset[str]]:
    hints, fields = get_type_hints(form), dataclasses.fields(form)
    required = frozenset(field.name for field in fields if field.default is dataclasses.MISSING)
    return {field.name: hints[field.name] for field in fields}, required


def _conforms(value: Any, hint: Any, max_magnitude: float) -> bool:
    """Whether a decoded value is what the annotation says, its numbers finite (NaN is not <=)."""
    if hint is float or hint is int:
        is_number = isinstance(value, int if hint is int else (int, float))
        return is_number and not isinstance(value, bool) and abs(value) <= max_magnitude
    origin, kinds = _parts(hint)
    if origin is Literal:
        return isinstance(value, str) and value in kinds
    if origin is Union:
        return any(_conforms(value, kind, max_magnitude) for kind in kinds)
    if origin is tuple:
        if not isinstance(value, list):
            return False
        kinds = kinds[:1] * len(value) if kinds[-1] is ... else kinds
        return len(value) == len(kinds) and all(
            _conforms(item, kind, max_magnitude) for item, kind in zip(value, kinds, strict=True)
        )
    return isinstance(value, origin or hint)


@cache
def _parts(hint: Any) -> tuple[Any, tuple[Any, ...]]:
    return get_origin(hint), get_args(hint)


def _coherent(fields: Mapping[str, Any]) -> bool:
    """What no annotation says: a quaternion has length 1, a click a ray, no index is negative."""
    if "event_type" in fields:
        is_click = fields["event_type"] == "click"
        has_ray = None not in (fields["ray_origin"], fields["ray_direction"])
        return len(fields["screen_pos"]) == (1 if is_click else 2) and has_ray >= is_click
    norm_squared = sum(x * x for x in fields.get("wxyz", (1.0,)))
    return abs(norm_squared - 1.0) < 0.01 and (fields.get("instance_index") or 0) >= 0
