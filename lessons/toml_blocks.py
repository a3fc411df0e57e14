"""Converts a block of TOML in a lesson's file to a value, or reports errors with their lines."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Callable, Iterable
from typing import Any, TypeVar

import msgspec

from onpath.lessons.problems import line_of

T = TypeVar("T")
Complain = Callable[[int, str], None]
"""Callback for an error: the line of the file, and a description."""


def read_toml(content: str, line: int, kind: type[T], complain: Complain) -> T | None:
    """Convert TOML that begins at a line to a value of a type; None if errors were reported."""
    try:
        return msgspec.convert(tomllib.loads(content), kind)
    except tomllib.TOMLDecodeError as error:
        place = re.search(r"at line (\d+)", str(error))
        complain(line + (int(place[1]) - 1 if place else 0), f"TOML: {error}")
    except msgspec.ValidationError as error:
        complain(line_of(str(error), content, line), str(error))
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
