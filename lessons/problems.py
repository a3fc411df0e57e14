"""Problems of lesson files: what is wrong, in which file, on which line."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from difflib import get_close_matches


@dataclass(frozen=True, slots=True, order=True)
class Problem:
    """A problem in a file, and its place; line 0: in a file or folder as a whole."""

    path: str
    line: int
    text: str

    def __str__(self) -> str:
        place = f"{self.path}:{self.line}" if self.line else self.path
        return f"{place}: {self.text}"


class LessonError(ValueError):
    """A lesson cannot be used; lists all its problems."""

    def __init__(self, problems: Iterable[Problem]) -> None:
        self.problems = sorted(set(problems))
        super().__init__("\n".join(map(str, self.problems)))


def near(name: str, known: Iterable[str]) -> str:
    """The known name that is nearest to an unknown one, as a hint; empty if none is near."""
    found = get_close_matches(name, sorted(known), 1)
    return f"; did you mean {found[0]}?" if found else ""


def line_of(fault: str, content: str, first: int) -> int:
    """The line of the file to which a fault refers.

    A fault names a place such as `$.check[1].below`, or a word: a field, a value or a parameter.

    Args:
        fault: the message.
        content: the block of TOML.
        first: line of the file at which the block begins.
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
    """Indices of the lines from `begin` on that assign to a name, or else contain it."""
    name = rf"(?<!\w){re.escape(word)}(?!\w)"
    for pattern in (name + r"\s*=", name):
        found = [i for i in range(begin, len(lines)) if re.search(pattern, lines[i])]
        if found:
            return found
    return []
