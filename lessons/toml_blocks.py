"""From a block of TOML in a lesson's file to a value, or to complaints about its lines."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Callable, Iterable
from typing import Any, TypeVar

import msgspec

T = TypeVar("T")
Complain = Callable[[int, str], None]
"""Told the line of the file and what is wrong there."""


def read_toml(content: str, line: int, kind: type[T], complain: Complain) -> T | None:
    """TOML that begins at a line, as a value of some type; None after a complaint."""
    try:
        return msgspec.convert(tomllib.loads(content), kind)
    except tomllib.TOMLDecodeError as error:
        place = re.search(r"at line (\d+)", str(error))
        complain(line + (int(place[1]) - 1 if place else 0), f"TOML: {error}")
    except msgspec.ValidationError as error:
        complain(_line_of(str(error), content, line), str(error))
    except RecursionError:
        complain(line, "nested too deeply")
    return None


def read_checked(
    content: str,
    line: int,
    kind: Any,
    faults: Callable[[Any], Iterable[str]],
    complain: Complain,
) -> Any:
    """The same, for a value that may have faults of its own; None after a complaint.

    Args:
        faults: what is wrong with a value.
    """
    read = read_toml(content, line, kind, complain)
    if read is None:
        return None
    found = list(faults(read))
    for fault in found:
        complain(_line_of(fault, content, line), fault)
    return None if found else read


def _line_of(fault: str, content: str, first: int) -> int:
    """Where in a block of TOML a fault is.

    It names a place such as `$.check[1].below`, or a word: a field, a value, a parameter.
    """
    lines = content.split("\n")
    _, _, place = fault.partition("`$")
    here = 0
    for name, index in re.findall(r"\.(\w+)(?:\[(\d+)\])?", place):
        found = _lines_with(name, lines, here)
        if found:
            here = found[min(int(index or 0), len(found) - 1)]
    for word in re.findall(r"field `(\w+)`|'([^']+)'|^(\w+)", fault):
        found = _lines_with("".join(word), lines, here)
        if found:
            return first + found[0]
    return first + here


def _lines_with(word: str, lines: list[str], begin: int) -> list[int]:
    """Which lines from `begin` on give a name a value; if none does, which have the word."""
    name = rf"(?<!\w){re.escape(word)}(?!\w)"
    for pattern in (name + r"\s*=", name):
        found = [i for i in range(begin, len(lines)) if re.search(pattern, lines[i])]
        if found:
            return found
    return []
