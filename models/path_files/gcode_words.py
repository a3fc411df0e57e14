"""The words of G-code: letters with numbers, and what its lines have besides."""

from __future__ import annotations

import re
from math import isfinite

from onpath.models.errors import CodedError

LONGEST_LINE = 1000  # [characters]
LETTERS = frozenset("XYZIJKREFSTHPDLQ")
"""Letters of words besides codes, N and O; those of other axes are refused."""
FIRST_OWN = 20  # from this number on, M codes differ from machine to machine, and may have texts
_COMMENT = re.compile(r"\([^()]*\)|\*\d+\s*$")  # and a checksum
_MACRO = re.compile(r"\s*(\$\S{0,10}|[A-Z][A-Z_]{2}[A-Z_0-9]{0,20})")
_WORD = re.compile(r"\s*([A-Z])\s*([-+]?(?:\d+\.?\d*|\.\d+))", re.ASCII)
Words = dict[str, float]


def bare_lines(text: str) -> list[str]:
    """The lines in capitals and with blanks in the place of comments, so that columns stay.

    Raises:
        CodedError: a line is too long.
    """
    lines = list[str]()
    for number, line in enumerate(text.splitlines(), start=1):
        code = line.partition(";")[0].upper()
        if len(code) > LONGEST_LINE:
            raise CodedError("error.table_long_line", line=str(number), most=str(LONGEST_LINE))
        bare = _COMMENT.sub(lambda found: " " * len(found[0]), code)
        lines.append(re.sub(r"^\s*[/%]", lambda found: " " * len(found[0]), bare))
    return lines


def words_of(bare: str, line: int) -> Words:
    """The words of a line by letter; codes of G and M, and macros, by their own name.

    Raises:
        CodedError: a word that is not read, or is repeated.
    """
    if macro := _MACRO.match(bare):
        return {macro[1]: 0.0}
    words, at, end = Words(), 0, len(bare.rstrip())
    while at < end:
        found = _WORD.match(bare, at)
        if found is None:
            raise _refusal(bare, at, line)
        letter, number = found[1], found[2]
        name = letter
        if letter in "GM":
            whole, _, rest = number.partition(".")
            name += whole.lstrip("0") or "0" if not rest.strip("0") else number.lstrip("0")
        elif letter not in LETTERS and letter not in "NO":
            raise _refusal(bare, at, line)
        value = float(number)
        if not isfinite(value):
            raise _refusal(bare, at, line)
        if name in words:
            raise _refusal(bare, at, line, repeats=True)
        words[name] = value
        at = found.end()
        if letter == "M" and value >= FIRST_OWN and name not in ("M280", "M300", "M98", "M99"):
            break  # temperatures, texts for a display
    return words


def column_of(bare: str, name: str) -> str:
    """The column of a code in a line, for a message."""
    for found in _WORD.finditer(bare):
        if found[1] == name[0] and float(found[2]) == float(name[1:]):
            return str(found.start(1) + 1)
    return "1"


def _refusal(bare: str, at: int, line: int, repeats: bool = False) -> CodedError:
    begin = at + len(bare[at:]) - len(bare[at:].lstrip())
    word = re.match(r"\S[^A-Z\s]*", bare[begin:])
    text = repr((word[0] if word else bare[begin:])[:20])
    column = str(begin + 1)
    return CodedError(
        "error.gcode_twice" if repeats else "error.gcode_word",
        line=str(line),
        column=column,
        text=text,
    )
