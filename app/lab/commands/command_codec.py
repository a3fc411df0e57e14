"""Commands as JSON, as a page's scripts send them: {"do": "Hold", "on": true}.

Every command of a page has this form; a teacher's do not. Types, names of fields, lengths of texts
and magnitudes are checked here; whether a command is possible is checked when it is applied.
"""

from __future__ import annotations

import dataclasses
import types
from typing import Annotated, Any, Union, get_args, get_origin, get_type_hints

import msgspec
import numpy as np

from onpath.app.lab import commands
from onpath.app.lab.commands.path import MOST_STROKE_POINTS
from onpath.app.lab.lab import Command

MOST_TEXT = 2000  # [characters], as in a text field
LARGEST = 1e9  # magnitude of a number
LONGEST = 250_000  # [characters] of a message: a stroke of `MOST_STROKE_POINTS`, with all digits
MOST_WHY = 200  # [characters] of the reason of a refusal

_AT_NAME = "at `$.do`"

Number = Annotated[float, msgspec.Meta(ge=-LARGEST, le=LARGEST)]
Whole = Annotated[int, msgspec.Meta(ge=-int(LARGEST), le=int(LARGEST))]
Text = Annotated[str, msgspec.Meta(max_length=MOST_TEXT)]
_CHECKED: dict[Any, Any] = {
    float: Number,
    int: Whole,
    str: Text,
    Any: Union[bool, Whole, Number, Text, None],  # noqa: UP007
}


class NoCommand(ValueError):
    """A message that is no command of a page; the text says why."""


def page_commands() -> dict[str, type[Command]]:
    """The commands that a page may send, by name."""
    found = [getattr(commands, name) for name in commands.__all__]
    return {
        each.__name__: each
        for each in found
        if isinstance(each, type)
        and issubclass(each, Command)
        and each is not Command
        and not each.from_teacher
    }


def command_structs() -> list[type[msgspec.Struct]]:
    """The commands that a page may send, as they are read."""
    return list(_STRUCTS)


def command_from(message: str) -> Command:
    """The command in a message.

    Raises:
        NoCommand: the message is not one.
    """
    if len(message) > LONGEST:
        raise NoCommand(f"expected at most {LONGEST} characters, got {len(message)}")
    try:
        fields = _decoder.decode(message)
    except (ValueError, RecursionError, MemoryError) as error:
        why = str(error)
        unknown = why.startswith("Invalid value") and why.endswith(_AT_NAME)
        raise NoCommand("there is no such command" if unknown else why[:MOST_WHY]) from None
    given = {name: getattr(fields, name) for name in fields.__struct_fields__}
    return _COMMANDS[type(fields).__name__](**given)


def message_of(command: Command) -> dict[str, Any]:
    """The message from which `command_from` makes a command: its name, and fields without defaults.

    Its fields are numbers, texts, switches or nothing; no key, for instance, sends a stroke.
    """
    assert dataclasses.is_dataclass(command)
    given = {
        field.name: getattr(command, field.name)
        for field in dataclasses.fields(command)
        if getattr(command, field.name) != field.default
    }
    return {"do": type(command).__name__, **given}


def _checked(hint: Any) -> Any:
    """The type of a field with bounded numbers and texts, unless it states its own bounds."""
    if hint in _CHECKED:
        return _CHECKED[hint]
    origin, kinds = get_origin(hint), get_args(hint)
    if origin is np.ndarray:
        return np.ndarray
    if origin in (Union, types.UnionType):
        return Union[tuple(map(_checked, kinds))]  # noqa: UP007
    if origin is tuple:
        return types.GenericAlias(tuple, tuple(k if k is ... else _checked(k) for k in kinds))
    return hint


def _struct(command: type[Any]) -> type[msgspec.Struct]:
    hints, fields = get_type_hints(command, include_extras=True), list[Any]()
    for field in dataclasses.fields(command):
        known = field.default is not dataclasses.MISSING
        kind = _checked(hints[field.name])
        fields.append((field.name, kind, field.default) if known else (field.name, kind))
    return msgspec.defstruct(
        command.__name__,
        fields,
        tag_field="do",
        tag=True,
        forbid_unknown_fields=True,
        kw_only=True,
    )


def _array(kind: type, value: Any) -> Any:
    """A point, or a list of points."""
    assert kind is np.ndarray
    if isinstance(value, list) and len(value) > MOST_STROKE_POINTS:
        raise ValueError(f"expected at most {MOST_STROKE_POINTS} points, got {len(value)}")
    nested = isinstance(value, list) and bool(value) and isinstance(value[0], list)
    return np.array(msgspec.convert(value, list[tuple[Number, Number]] if nested else list[Number]))


_COMMANDS = page_commands()
_STRUCTS = tuple(map(_struct, _COMMANDS.values()))
_decoder = msgspec.json.Decoder(Union[_STRUCTS], dec_hook=_array)  # noqa: UP007
