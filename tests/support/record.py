"""Reads the record of a class as a spreadsheet does."""

from __future__ import annotations

import io
import re
import zipfile
from collections import defaultdict
from collections.abc import Iterable, Sequence
from datetime import UTC, datetime
from xml.etree import ElementTree

from onpath.app.classroom.class_record import Sheet, class_record
from onpath.app.classroom.classroom import Member
from onpath.lessons.course import Course
from onpath.lessons.votes import Vote

MADE = datetime(2026, 1, 1, 12, 30, tzinfo=UTC)
MAIN = "{http://schemas.openxmlformats.org/spreadsheetml/2006/main}"
Cell = str | float


class Row(defaultdict[str, Cell]):
    """A row of a sheet; what is empty is ""."""

    def __init__(self, cells: dict[str, Cell]) -> None:
        super().__init__(str, cells)


def record(
    members: Iterable[Member],
    course: Course,
    more: Iterable[Sheet] = (),
    votes: Sequence[Vote] = (),
) -> dict[str, list[Row]]:
    """The sheets of a class's record."""
    return sheets(class_record(members, course, "en", MADE, more=more, votes=votes))


def sheets(data: bytes) -> dict[str, list[Row]]:
    """The rows of each sheet by their headings. There must be no formula and no link anywhere."""
    with zipfile.ZipFile(io.BytesIO(data)) as book:
        parts = {name: book.read(name) for name in book.namelist()}
    assert not any("external" in name.lower() or "vba" in name.lower() for name in parts)
    shared = ElementTree.fromstring(parts["xl/sharedStrings.xml"])
    texts = ["".join(t.text or "" for t in each.iter(f"{MAIN}t")) for each in shared]
    names = [
        each.attrib["name"]
        for each in ElementTree.fromstring(parts["xl/workbook.xml"]).iter(f"{MAIN}sheet")
    ]
    return {
        name: _rows(ElementTree.fromstring(parts[f"xl/worksheets/sheet{n}.xml"]), texts)
        for n, name in enumerate(names, 1)
    }


def _rows(page: ElementTree.Element, texts: list[str]) -> list[Row]:
    kinds = {each.tag.removeprefix(MAIN) for each in page.iter()}
    assert "f" not in kinds and "hyperlink" not in kinds
    rows = [_cells(each, texts) for each in page.iter(f"{MAIN}row")]
    head = rows[0]
    return [Row({str(head[column]): cell for column, cell in row.items()}) for row in rows[1:]]


def _cells(row: ElementTree.Element, texts: list[str]) -> dict[str, Cell]:
    found: dict[str, Cell] = {}
    for cell in row.iter(f"{MAIN}c"):
        value = cell.find(f"{MAIN}v")
        if value is not None:
            said, column = value.text or "", re.sub(r"\d", "", cell.attrib["r"])
            found[column] = _unescaped(texts[int(said)]) if cell.get("t") == "s" else float(said)
    return found


def _unescaped(text: str) -> str:
    """The text of a cell; control characters are written as _xHHHH_."""
    return re.sub("_x([0-9A-F]{4})_", lambda m: chr(int(m[1], 16)), text)
