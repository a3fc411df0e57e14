"""Decodes messages of a browser into viser's dataclasses, if they are valid."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterable
from typing import Annotated, Any, Literal, Union, get_args, get_origin, get_type_hints

import msgspec

UNREADABLE = (ValueError, RecursionError, MemoryError)
"""What msgspec raises for malformed or malicious bytes, for instance deeply nested ones."""


class InvalidMessage(ValueError):
    """A message that a browser may not send; the text says why and never quotes the message."""


class MessageSchemas:
    """The messages that a browser may send.

    Args:
        kinds: their dataclasses. A valid message is a msgpack map with the class name as "type".
        max_magnitude: of any number.
    """

    def __init__(self, kinds: Iterable[type[Any]], max_magnitude: float) -> None:
        self._limit = msgspec.Meta(ge=-max_magnitude, le=max_magnitude)  # NaN is neither
        whole = int(max_magnitude)
        self._whole_limit = msgspec.Meta(ge=-whole, le=whole)
        structs = {self._struct(kind): kind for kind in kinds}
        self._decoder = msgspec.msgpack.Decoder(Union[tuple(structs)])  # noqa: UP007
        self._names = frozenset(struct.__name__ for struct in structs)
        self._kinds: dict[type[Any], type[Any]] = structs

    def decoded(self, raw: bytes | str) -> Any:
        """The message in the bytes of a websocket message.

        Raises:
            InvalidMessage: the message is not valid.
        """
        if isinstance(raw, str):
            raise InvalidMessage("a text frame")
        try:
            found = self._decoder.decode(raw)
        except msgspec.ValidationError as error:
            name = _name(raw)
            known = name in self._names
            fault = f"{name} with wrong fields" if known else "a message that no browser may send"
            raise InvalidMessage(fault) from error
        except UNREADABLE as error:
            raise InvalidMessage("bytes that are no message") from error
        if not _is_coherent(found):
            raise InvalidMessage(f"{type(found).__name__} with incoherent values")
        return self._kinds[type(found)](**msgspec.structs.asdict(found))

    def _struct(self, kind: type[Any]) -> type[msgspec.Struct]:
        hints, fields = get_type_hints(kind), list[Any]()
        for field in dataclasses.fields(kind):
            known = field.default is not dataclasses.MISSING
            hint = self._bounded(hints[field.name])
            fields.append((field.name, hint, field.default) if known else (field.name, hint))
        return msgspec.defstruct(
            kind.__name__, fields, tag=True, forbid_unknown_fields=True, kw_only=True
        )

    def _bounded(self, hint: Any) -> Any:
        """The type with finite and bounded numbers."""
        if hint is float:
            return Annotated[float, self._limit]
        if hint is int:
            return Annotated[int, self._whole_limit]
        origin, kinds = get_origin(hint), get_args(hint)
        if origin is None or origin is Literal:
            return hint
        bounded = tuple(each if each is ... else self._bounded(each) for each in kinds)
        return Union[bounded] if origin is Union else origin[bounded]  # noqa: UP007


class _Named(msgspec.Struct):
    type: str


def _name(raw: bytes) -> str:
    """The type that a message claims to have."""
    try:
        return msgspec.msgpack.decode(raw, type=_Named).type
    except UNREADABLE:
        return ""


def _is_coherent(message: Any) -> bool:
    """Whether constraints beyond types hold: unit quaternions, indices >= 0, a field of view."""
    norm_squared = sum(x * x for x in getattr(message, "wxyz", (1.0,)))
    index = getattr(message, "instance_index", None)
    is_seen = 0 < getattr(message, "fov", 1.0) < math.pi
    return abs(norm_squared - 1.0) < 0.01 and (index or 0) >= 0 and is_seen
