"""Reads the points of a path from a table, as programs and spreadsheets write it.

Two columns, or those that a line of names calls x and y, z1 and z2, or y1 and y2; other columns may
be there. A name may state the unit: `x_mm`, `x [mm]`, `x (mm)`, `x in mm`. The columns may also be
separated by spaces. The names may stand in a comment, `# x_m, y_m, width_m`.

An empty row ends a line, unless each row has one after it, and so does another number in a column
called stroke, part, segment or pen, or in a third one without a name; of 0 and 1, a pen is down at
1. See `models/studies/table_file.py` for the rest.
"""

from __future__ import annotations

import io
import re
from collections.abc import Iterator, Sequence
from itertools import chain, groupby
from operator import itemgetter

import numpy as np

from onpath.models.errors import CodedError
from onpath.models.path_files.joining import TOUCHING
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
HEAD = 4000  # [B], in which a comment with names is looked for
PENS = ("stroke", "pen", "pen_down", "part", "segment")
"""Names of a column that numbers the lines, or is 1 where the pen is down and else 0."""
_U = "(mm|cm|m|in)"
_NAME = re.compile(rf"([a-z]+\d?)(?:_{_U}|\s+in\s+{_U}|\s*/\s*{_U}|\s*[\[(]\s*{_U}\s*[\])])?")
Row = tuple[int, list[str]]
Point = tuple[float, float]


def strokes_of_table(data: bytes, unit: str | None) -> list[Stroke]:
    """The points of a table, in lines.

    Args:
        unit: of its numbers; None: the one that the columns' names state, else metres.

    Raises:
        CodedError: the data are not such a table; the message names line and column.
    """
    encoding = encoding_of(data[:4])
    with io.TextIOWrapper(io.BytesIO(data), encoding, errors="replace", newline=None) as file:
        rows = _rows(file)
        first = next((row for row in rows if row[1]), (1, list[str]()))
        names = _noted(data[:HEAD].decode(encoding, "replace"), first)
        rows = chain([first], rows) if names else rows
        names = names or ([] if _numeric(first[1]) else first[1])
        places, stated = _columns(names, first) if names else ((0, 1), None)
        groups = _groups(rows if names else chain([first], rows), places, names)
    if not groups:
        raise CodedError("error.table_empty", line=str(first[0]))
    points = [UNITS[unit or stated or "m"] * np.array(group) for group in groups]
    if len(points) == 1:
        return [Stroke(points[0], closed=None, straight=False)]
    size = float(np.ptp(np.vstack(points), axis=0).max())
    return [
        Stroke(
            each,
            closed=len(each) > 3 and bool(np.linalg.norm(each[0] - each[-1]) <= TOUCHING * size),
            straight=False,
            name=f"stroke {number}",
        )
        for number, each in enumerate(points, start=1)
    ]


def _noted(head: str, first: Row) -> list[str]:
    """Names in a comment just before the numbers, as NumPy and others write them; else none."""
    lines = head.splitlines()[: first[0] - 1]
    if not lines or not lines[-1].startswith("#") or not _numeric(first[1]):
        return []
    text = lines[-1].lstrip("# ")
    separator = _separator(text)
    names = text.split() if separator == " " else [each.strip() for each in text.split(separator)]
    plain = [_name_and_unit(name.lower())[0] for name in names]
    known = any(all(name in plain for name in pair) for pair in PAIRS)
    return names if known and len(names) == len(first[1]) else []


def _rows(file: io.TextIOWrapper) -> Iterator[Row]:
    """Number and cells of the lines; none of an empty one."""
    separator = ""
    for number, line in lines_of(file, empty=True):
        if not line:
            yield number, []
            continue
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


def _groups(rows: Iterator[Row], places: tuple[int, int], names: list[str]) -> list[list[Point]]:
    """The points of each line."""
    reader, points, width = NumberReader(), list[Point](), len(names)
    pens, blocks, block = list[float](), list[int](), 0
    which = _pen(names)
    for number, cells in rows:
        if not cells:
            block += 1
            continue
        if not width:
            width = len(cells)
            if width not in (2, 3):
                raise CodedError("error.points_columns", line=str(number), count=width)
            which = 2 if width == 3 else None
        if len(cells) != width:
            wanted, got = str(width), str(len(cells))
            raise CodedError("error.table_cells", line=str(number), wanted=wanted, count=got)
        values = [
            reader.number(cells[i], number, names[i] if names else str(i + 1))
            for i in (*places, *([] if which is None else [which]))
        ]
        points.append((values[0], values[1]))
        pens += values[2:]
        blocks.append(block)
        check_count(len(points), number)
    if which is not None and not names and not _are_pens(pens):
        raise CodedError("error.points_columns", line="1", count=width)
    if which is not None and {*pens} == {0.0, 1.0} and (not names or "pen" in names[which].lower()):
        return _lowered(points, pens)
    marks = [*zip(pens or [0.0] * len(points), blocks, strict=True)]
    groups = [
        [point for _, point in part]
        for _, part in groupby(zip(marks, points, strict=True), key=itemgetter(0))
    ]
    if all(len(group) == 1 for group in groups):  # of lines in double spacing
        return [points] if points else []
    return [group for group in groups if len(group) > 1]


def _pen(names: list[str]) -> int | None:
    """The column that numbers the lines, or says whether the pen is down; None if there is none."""
    plain = [_name_and_unit(name.lower())[0] for name in names]
    return next((plain.index(name) for name in PENS if name in plain), None)


def _are_pens(values: list[float]) -> bool:
    """Whether numbers in a column without a name number lines: whole, and few."""
    return all(value.is_integer() for value in values) and 2 * len({*values}) <= len(values)


def _lowered(points: list[Point], pens: list[float]) -> list[list[Point]]:
    """The lines that are drawn to points where the pen is down, each from the point before."""
    groups, down = list[list[Point]](), False
    for i, (point, pen) in enumerate(zip(points, pens, strict=True)):
        if pen and not down:
            groups.append(points[i - 1 : i] if i else [])
        down = bool(pen)
        if down:
            groups[-1].append(point)
    return [group for group in groups if len(group) > 1]
