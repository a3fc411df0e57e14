"""Reads the points of a path from a table, as programs and spreadsheets write it.

Two columns, or those that a line of names calls x and y, z1 and z2, or y1 and y2; other columns may
be there. A name may state the unit: `x_mm`, `x [mm]`, `x (mm)`, `x in mm`. The columns may also be
separated by spaces. See `models/studies/table_file.py` for the rest.
"""

from __future__ import annotations

import io
import re
from collections.abc import Iterator, Sequence
from itertools import chain

import numpy as np

from onpath.models.errors import CodedError
from onpath.models.path_files.stroke import UNITS, Stroke, check_count
from onpath.models.studies.table_file import (
    DECLARED,
    NUMBER,
    SEPARATORS,
    NumberReader,
    cells_of,
    encoding_of,
    lines_of,
)

PAIRS = (("x", "y"), ("z1", "z2"), ("y1", "y2"), ("y2", "y3"))
"""Names of the columns of a point, the first ones that a table has."""
_U = "(mm|cm|m|in)"
_NAME = re.compile(rf"([a-z]+\d?)(?:_{_U}|\s+in\s+{_U}|\s*/\s*{_U}|\s*[\[(]\s*{_U}\s*[\])])?")
Row = tuple[int, list[str]]


def stroke_of_table(data: bytes, unit: str | None) -> Stroke:
    """The points of a table.

    Args:
        unit: of its numbers; None: the one that the columns' names state, else metres.

    Raises:
        CodedError: the data are not such a table; the message names line and column.
    """
    with io.TextIOWrapper(
        io.BytesIO(data), encoding_of(data[:4]), errors="replace", newline=None
    ) as file:
        rows = _rows(file)
        first = next(rows, (1, list[str]()))
        names = [] if _numeric(first[1]) else first[1]
        places, stated = _columns(names, first) if names else ((0, 1), None)
        points = _points(rows if names else chain([first], rows), places, names)
    if not len(points):
        raise CodedError("error.table_empty", line=str(first[0]))
    return Stroke(UNITS[unit or stated or "m"] * points, closed=None, straight=False)


def _rows(file: io.TextIOWrapper) -> Iterator[Row]:
    """Number and cells of the lines that have any."""
    separator = ""
    for number, line in lines_of(file):
        if not separator:
            if declared := DECLARED.fullmatch(line):
                separator = declared["separator"]
                if separator not in SEPARATORS:
                    text = repr(separator)
                    raise CodedError("error.table_separator", line=str(number), text=text)
                continue
            separator = _separator(line)
        cells = line.split() if separator == " " else cells_of(line, separator, number)
        while cells and not cells[-1]:
            cells.pop()
        if cells:
            yield number, cells


def _separator(line: str) -> str:
    """The separator of a table with this first line; a space only if nothing else is."""
    unquoted = re.sub('"[^"]*"', "", line)
    words = unquoted.split()
    if len(words) > 1 and all(NUMBER.fullmatch(word) for word in words):
        return " "  # of two numbers with decimal commas
    if any(each in unquoted for each in SEPARATORS):
        return next(each for each in SEPARATORS if each in unquoted)
    return " "


def _numeric(cells: Sequence[str]) -> bool:
    return bool(cells) and all(NUMBER.fullmatch(cell) for cell in cells)


def _columns(names: list[str], first: Row) -> tuple[tuple[int, int], str | None]:
    """The columns of a point, and the unit that their names state.

    Raises:
        CodedError: none or several columns have such names, or their units differ.
    """
    line = str(first[0])
    read = [_name_and_unit(name.lower()) for name in names]
    plain = [name for name, _ in read]
    for pair in PAIRS:
        if not all(name in plain for name in pair):
            continue
        for name in pair:
            if plain.count(name) > 1:
                raise CodedError("error.table_column_twice", line=line, name=name)
        places = plain.index(pair[0]), plain.index(pair[1])
        unit, other = (read[i][1] for i in places)
        if unit != other:
            raise CodedError("error.points_units", line=line)
        return places, unit
    if len(names) == 2:
        return (0, 1), None
    raise CodedError("error.points_columns", line=line, count=len(names))


def _name_and_unit(text: str) -> tuple[str, str | None]:
    found = _NAME.fullmatch(text)
    if found is None:
        return text, None
    name, *units = found.groups()
    return name, next((unit for unit in units if unit), None)


def _points(rows: Iterator[Row], places: tuple[int, int], names: list[str]) -> np.ndarray:
    reader, points, width = NumberReader(), list[tuple[float, float]](), len(names)
    for number, cells in rows:
        if not width:
            width = len(cells)
            if width != 2:
                raise CodedError("error.points_columns", line=str(number), count=width)
        if len(cells) != width:
            wanted, got = str(width), str(len(cells))
            raise CodedError("error.table_cells", line=str(number), wanted=wanted, count=got)
        first, second = (
            reader.number(cells[i], number, names[i] if names else str(i + 1)) for i in places
        )
        points.append((first, second))
        check_count(len(points), number)
    return np.array(points, dtype=float).reshape(-1, 2)
