"""From a block of TOML in a lesson's file to a value, or to complaints about its lines."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Callable, Iterable
from typing import Any, TypeVar

import msgspec

from onpath.lessons.problems import line_of

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
    """The same, for a value that may have faults of its own; None after a complaint.

    Args:
        faults: what is wrong with a value.
    """
    read = read_toml(content, line, kind, complain)
    if read is None:
        return None
    found = list(faults(read))
    for fault in found:
        complain(line_of(fault, content, line), fault)
    return None if found else read
