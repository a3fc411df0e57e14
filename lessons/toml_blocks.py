"""Converts a block of TOML in a lesson's file to a value, or reports errors with their lines."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Callable, Iterable, Iterator
from typing import Any, TypeVar, get_args

import msgspec

from onpath.lessons.problems import line_of, near
from onpath.lessons.text_files import BACKSLASH, STRING, load_toml, toml_fault

T = TypeVar("T")
Complain = Callable[[int, str], None]
"""Callback for an error: the line of the file, and a description."""


ESCAPE = re.compile(r"\\(.)([A-Za-z]*)", re.DOTALL)


def escape_faults(content: str) -> Iterator[tuple[int, str]]:
    """LaTeX commands that TOML reads as a tab, a newline or another control character.

    Yields:
        The number of lines before it, and the fault.
    """
    for string in STRING.finditer(content):
        kind = string.lastgroup
        if kind is None:
            continue  # a text between single quotes, or a comment
        text, begin = string[kind], string.start(kind)
        for escape in ESCAPE.finditer(text):
            sign, rest = escape.groups()
            formula = text[: escape.start()].replace("\\\\$", "").count("$") % 2
            if sign in "bfe" or (sign in "tnr" and rest and formula):
                below = content.count("\n", 0, begin + escape.start())
                yield below, f"\\{sign}{rest}: {BACKSLASH}"


def read_toml(content: str, line: int, kind: type[T], complain: Complain) -> T | None:
    """Convert TOML that begins at a line to a value of a type; None if errors were reported."""
    if found := list(escape_faults(content)):
        for below, fault in found:
            complain(line + below, fault)
        return None
    try:
        return msgspec.convert(load_toml(content), kind)
    except tomllib.TOMLDecodeError as error:
        below, fault = toml_fault(error, content)
        complain(line + below, fault)
    except msgspec.ValidationError as error:
        complain(line_of(str(error), content, line), f"{error}{nearest(str(error), kind)}")
    return None


def nearest(error: str, kind: Any) -> str:
    """A hint: the field or value of a type nearest to the unknown one in an error."""
    field = re.search(r"unknown field `(.+?)`", error)
    if field:
        return near(field[1], _fields(kind))
    value = re.search(r"Invalid (?:enum )?value '(.+?)'", error)
    return near(value[1], _values(kind)) if value else ""


def _values(kind: Any) -> set[str]:
    """All strings that a type, or the types in it, allows as values."""
    parts = get_args(kind)
    values = {part for part in parts if isinstance(part, str)}
    values |= {value for part in parts for value in _values(part)}
    if isinstance(kind, type) and issubclass(kind, msgspec.Struct):
        tag = kind.__struct_config__.tag
        values |= {tag} if isinstance(tag, str) else set()
        for field in msgspec.structs.fields(kind):
            values |= _values(field.type)
    return values


def _fields(kind: Any) -> set[str]:
    """Names of all fields of a type, and of the types in it."""
    names = {name for part in get_args(kind) for name in _fields(part)}
    if isinstance(kind, type) and issubclass(kind, msgspec.Struct):
        for field in msgspec.structs.fields(kind):
            names |= {field.encode_name} | _fields(field.type)
    return names


def read_checked(
    content: str,
    line: int,
    kind: Any,
    faults: Callable[[Any], Iterable[str]],
    complain: Complain,
) -> Any:
    """Like `read_toml`, with further checks of the value.

    Args:
        faults: returns descriptions of the value's errors.
    """
    read = read_toml(content, line, kind, complain)
    if read is None:
        return None
    found = list(faults(read))
    for fault in found:
        complain(line_of(fault, content, line), fault)
    return None if found else read
