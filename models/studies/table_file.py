"""Reads tables of numbers as programs and spreadsheets of any country write them.

A table has a line with the names of its columns, or none, and then a line for each row. A name that
is a whole number, and that no column has, is a column's place, counted from 1. A first line of
numbers only is a row, unless it counts the columns, 0, 1, 2 and so on, as pandas does. The
conventions in which programs differ are recognised from the file:

- encoding: UTF-8 or UTF-16, with a byte order mark or without one
- separator of the cells: that of a line `sep=;`, else the tab, semicolon or comma in the line with
  the names; blanks in a table without names
- decimal sign: point or comma, the same in the whole table; digits in groups are refused, because
  `1.000` would be one thousand in one country and one in another

Cells may be quoted and have blanks around them. Empty cells at the end of a line do not count, nor
do empty lines and those that begin with #.

The files are untrusted: anything else is refused.
"""

from __future__ import annotations

import codecs
import csv
import io
import re
from array import array
from collections.abc import Generator, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from itertools import chain
from math import isfinite
from pathlib import Path

import numpy as np

from onpath.models.arrays import Array
from onpath.models.closed_loop.trajectory import without_mark
from onpath.models.errors import CodedError
from onpath.models.studies.array_file import array_columns, is_array_file
from onpath.models.systems.parameter_specs import MINUS

LONGEST_LINE = 10_000  # [characters]
MOST_LINES = 1_000_000
MOST_QUOTED = 20  # of a cell, in a message, [characters]
LARGEST = 1e9  # of any number, in absolute value
LATEST = 1e20  # of a time, which may be in nanoseconds since 1970
SEPARATORS = "\t;,"
NUMBER = re.compile(
    rf"[-+{MINUS}]?(?=[.,]?\d)\d*(?P<sign>[.,]?)\d*(?:[eE][-+{MINUS}]?\d+)?", re.ASCII
)
_COMMENT = re.compile(rf'[ "]*#(?![A-ZÄÖÜ][A-ZÄÖÜ/]|#*"?[{SEPARATORS}])')  # not a cell, as #N/A
DECLARED = re.compile(r'"?sep=(?P<separator>.)"?[\t;,]*\s*', re.IGNORECASE)


@dataclass(frozen=True, slots=True, eq=False)
class Table:
    """Columns of a table.

    Attributes:
        numbers: the requested columns of numbers, shape (rows, columns).
        texts: the requested columns of texts that exist, by name.
        lines: number of each row's line in the file, from 1.
    """

    numbers: Array
    texts: Mapping[str, Sequence[str]]
    lines: Sequence[int]


def read_table(
    path: Path, numbers: Sequence[str], texts: Sequence[str] = (), time: str = ""
) -> Table:
    """Read some columns of a table; the others may contain anything.

    Args:
        path: a text, or arrays of NumPy or MATLAB, see `array_file.py`.
        numbers: names or places of columns of finite numbers, which the table must have.
        texts: names of columns of texts, which it may have.
        time: which of the numbers may be as large as `LATEST`.

    Raises:
        CodedError: it is no such table; the message names the line, and the column of a bad number.
        OSError: the file cannot be read.
    """
    if is_array_file(path):
        return _of_arrays(array_columns(path), numbers, time)
    with _opened(path) as file:
        return _read(lines_of(file), numbers, texts, time)


def column_names(path: Path) -> tuple[str, ...]:
    """The names of a table's columns; their places, from 1 on, where they have none.

    Raises:
        CodedError, OSError: see `read_table`.
    """
    if is_array_file(path):
        return tuple(array_columns(path))
    with _opened(path) as file:
        return tuple(_begun(lines_of(file)).names)


@contextmanager
def _opened(path: Path) -> Generator[io.TextIOWrapper, None, None]:
    """The text of a file; undecodable bytes are replaced, and refused if they matter."""
    with path.open("rb") as raw:
        encoding = encoding_of(raw.peek(1))
        with io.TextIOWrapper(raw, encoding, errors="replace", newline=None) as file:
            yield file


def encoding_of(head: bytes) -> str:
    """The encoding of a text that begins with ASCII characters or a mark."""
    if head.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        return "utf-16"
    if b"\0" in head[:2]:
        return "utf-16-be" if head[:1] == b"\0" else "utf-16-le"
    return "utf-8-sig"


def lines_of(file: io.TextIOWrapper, *, empty: bool = False) -> Iterator[tuple[int, str]]:
    """Number and text of the lines that are neither empty nor a comment.

    Args:
        empty: whether empty lines are there, too.
    """
    for number, line in enumerate(iter(lambda: file.readline(LONGEST_LINE), ""), start=1):
        if len(line) >= LONGEST_LINE:
            raise CodedError("error.table_long_line", line=str(number), most=str(LONGEST_LINE))
        if number > MOST_LINES:
            raise CodedError("error.table_long", most=str(MOST_LINES))
        if line.strip(f'{SEPARATORS}" \r\n') and not _COMMENT.match(line):
            yield number, line.rstrip("\n")
        elif empty and not _COMMENT.match(line):
            yield number, ""


@dataclass(frozen=True, slots=True)
class _Begun:
    """A table of which the names have been read.

    Attributes:
        names: of its columns.
        separator: of its cells.
        number: of the line with the names, or of the first row.
        lines: the rows.
    """

    names: list[str]
    separator: str
    number: int
    lines: Iterator[tuple[int, str]]


def _begun(lines: Iterator[tuple[int, str]]) -> _Begun:
    number, line = next(lines, (1, ""))
    if declared := DECLARED.fullmatch(line):
        separator = declared["separator"]
        if separator not in SEPARATORS:
            raise CodedError("error.table_separator", line=str(number), text=repr(separator))
        number, line = next(lines, (number + 1, ""))
    else:
        unquoted = re.sub('"[^"]*"', "", line)
        separator = next((each for each in SEPARATORS if each in unquoted), ",")
        separator = " " if _in_blanks(line) else separator
    names = [without_mark(cell) for cell in cells_of(line, separator, number)]
    while names and not names[-1]:
        names.pop()
    if _is_row(names):
        names, lines = [str(i) for i in range(1, len(names) + 1)], chain([(number, line)], lines)
    return _Begun(names, separator, number, lines)


def _read(
    lines: Iterator[tuple[int, str]], numbers: Sequence[str], texts: Sequence[str], time: str
) -> Table:
    begun = _begun(lines)
    names, separator, number = begun.names, begun.separator, begun.number
    wanted = [_place(name, names, number) for name in numbers]
    most = {i: LATEST if names[i] == time else LARGEST for i in wanted}
    others = {name: names.index(name) for name in texts if name in names}
    reader, flat, rows = NumberReader(), array("d"), list[int]()
    found = {name: list[str]() for name in others}
    for number, line in begun.lines:
        cells = cells_of(line, separator, number)
        if len(cells) < len(names) or any(cells[len(names) :]):
            expected, got = str(len(names)), str(len(cells))
            raise CodedError("error.table_cells", line=str(number), wanted=expected, count=got)
        flat.extend(reader.number(cells[i], number, names[i], most[i]) for i in wanted)
        for name, i in others.items():
            found[name].append(cells[i])
        rows.append(number)
    if not rows:
        raise CodedError("error.table_empty", line=str(number))
    return Table(np.array(flat).reshape(len(rows), len(wanted)), found, rows)


def _in_blanks(line: str) -> bool:
    """Whether a line consists of several numbers between blanks."""
    words = line.split(" ")
    found = [word for word in words if word]
    return len(found) > 1 and all(NUMBER.fullmatch(each) and each[-1].isdigit() for each in found)


def _is_row(cells: Sequence[str]) -> bool:
    """Whether the cells of a first line are numbers, which do not count the columns."""
    counts = [[str(i + first) for i in range(len(cells))] for first in (0, 1)]
    return (
        bool(cells)
        and all(map(NUMBER.fullmatch, cells))
        and (len(cells) < 3 or cells not in counts)
    )


def _of_arrays(columns: Mapping[str, Array], numbers: Sequence[str], time: str) -> Table:
    """Some columns of arrays; the lines are their rows, from 1."""
    names = [*columns]
    found = [names[_place(name, names, 1)] for name in numbers]
    for name in found:
        bad = np.flatnonzero(~(np.abs(columns[name]) <= (LATEST if name == time else LARGEST)))
        if bad.size:
            text, line = f"{columns[name][bad[0]]:g}", str(bad[0] + 1)
            raise CodedError("error.table_large_number", line=line, column=name, text=text)
    return Table(
        np.stack([columns[name] for name in found], axis=1),
        {},
        range(1, 1 + len(columns[names[0]])),
    )


def cells_of(line: str, separator: str, number: int) -> list[str]:
    """The cells of a line.

    Args:
        number: of the line, for the message.

    Raises:
        CodedError: a quotation mark is out of place.
    """
    if separator == " ":
        return line.split()
    reader = csv.reader([line], delimiter=separator, skipinitialspace=True, strict=True)
    try:
        return [cell.strip() for cell in next(reader, list[str]())]
    except csv.Error:
        raise CodedError("error.table_quotes", line=str(number)) from None


def _place(name: str, names: Sequence[str], line: int) -> int:
    """The index of the column with this name, or at this place."""
    if names.count(name) != 1:
        if re.fullmatch("[0-9]{1,4}", name) and 1 <= int(name) <= len(names) and name not in names:
            return int(name) - 1
        if names[:1] == ["1"]:
            last = str(len(names))
            raise CodedError("error.table_no_names", line=str(line), name=name, last=last)
        if name in names:
            raise CodedError("error.table_column_twice", line=str(line), name=name)
        raise CodedError("error.table_no_column", line=str(line), name=name)
    return names.index(name)


@dataclass(slots=True)
class NumberReader:
    """Reads numbers with one decimal sign: that of the first number that has any."""

    _sign: str = field(default="", init=False)

    def number(self, cell: str, line: int, column: str, most: float = LARGEST) -> float:
        """The number in a cell.

        Args:
            most: its largest absolute value.

        Raises:
            CodedError: it is not a number, or has another decimal sign than those before.
        """
        at, column, text = str(line), column[:MOST_QUOTED], repr(cell[:MOST_QUOTED])
        match = NUMBER.fullmatch(cell)
        if match is None:
            raise CodedError("error.table_not_a_number", line=at, column=column, text=text)
        value, sign = float(cell.replace(",", ".").replace(MINUS, "-")), match["sign"]
        if sign and sign != self._sign:
            if self._sign:
                other = "comma" if self._sign == "," else "point"
                raise CodedError(
                    "error.table_decimal_sign", line=at, column=column, text=text, other=other
                )
            self._sign = sign
        if not isfinite(value) or abs(value) > most:
            raise CodedError("error.table_large_number", line=at, column=column, text=text)
        return value
