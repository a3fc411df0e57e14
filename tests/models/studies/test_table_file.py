"""A table is read as it was written, whatever a spreadsheet made of it; all else names its line."""

from __future__ import annotations

import csv
import io
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from onpath.models.arrays import Array
from onpath.models.closed_loop.trajectory import header
from onpath.models.errors import CodedError
from onpath.models.studies.record_file import read_records
from onpath.models.studies.table_file import LARGEST, LONGEST_LINE, Table, read_table
from onpath.models.systems.five_bar_robot import RIGID_FIVE_BAR

ROBOT = RIGID_FIVE_BAR
NAMES = header(ROBOT)
LAWS = ("trajectory_tracking", "across = -min(K1, 9)*xi; along = 0", "path_following")
ENCODINGS = ("utf-8", "utf-8-sig", "utf-16", "utf-16-le", "utf-16-be")
ANY_NUMBER = st.floats(-LARGEST, LARGEST).map(lambda x: float(f"{x:.9g}"))


def read(data: bytes | str, *columns: str, texts: tuple[str, ...] = ()) -> Table:
    with TemporaryDirectory() as folder:
        path = Path(folder, "table.csv")
        path.write_bytes(data.encode() if isinstance(data, str) else data)
        return read_table(path, columns, texts)


def records(data: bytes | str) -> list[tuple[str, Array]]:
    """The laws of a file, and the columns that identification needs."""
    with TemporaryDirectory() as folder:
        path = Path(folder, "record.csv")
        path.write_bytes(data.encode() if isinstance(data, str) else data)
        found = read_records(path, ROBOT)
    return [(law, np.hstack([r.q, r.v, r.u, r.force])) for law, r in found]


def cells(rows: int = 40, start: float = 0.0, seed: int = 0) -> list[list[str]]:
    """A record as `onpath experiment --csv` writes it, 1 ms a row."""
    rng, table = np.random.default_rng(seed), [NAMES]
    for law in LAWS[:2]:
        for k in range(rows):
            numbers = rng.normal(size=len(NAMES) - 2) * 10.0 ** rng.integers(-9, 3, len(NAMES) - 2)
            table.append([f"{start + 1e-3 * k:.9g}", law, *(f"{x:.9g}" for x in numbers)])
    return table


@dataclass(frozen=True)
class Spreadsheet:
    """How a program saves a table."""

    encoding: str = "utf-8"
    separator: str = ","
    decimal: str = "."
    declares: bool = False
    end: str = "\n"
    blanks: bool = False
    quotes: bool = False
    empty_cells: int = 0
    empty_lines: bool = False
    comment: bool = False
    numbered: bool = False
    without_last_end: bool = False

    def save(self, table: list[list[str]]) -> bytes:
        rows = [[self._cell(cell) for cell in row] + [""] * self.empty_cells for row in table]
        if self.numbered:
            rows = [[str(i) if i else "", *row] for i, row in enumerate(rows)]
        file = io.StringIO()
        quoting = csv.QUOTE_ALL if self.quotes else csv.QUOTE_MINIMAL
        writer = csv.writer(file, delimiter=self.separator, quoting=quoting, lineterminator="\n")
        writer.writerows(rows)
        lines = file.getvalue().splitlines()
        if self.empty_lines:
            lines[3:3] = ["", self.separator * 4, "   "]
            lines.append("")
        if self.comment:
            lines.insert(5, "# the arm was oiled; 1,5 ml")
            lines.insert(0, "# Messung")
        if self.declares:
            lines.insert(0, f"sep={self.separator}")
        text = self.end.join(lines) + ("" if self.without_last_end else self.end)
        return text.encode(self.encoding)

    def _cell(self, cell: str) -> str:
        try:
            float(cell)
        except ValueError:
            return cell
        shown = cell.replace(".", self.decimal)
        return f" {shown} " if self.blanks else shown


SPREADSHEETS = st.builds(
    Spreadsheet,
    encoding=st.sampled_from(ENCODINGS),
    separator=st.sampled_from(",;\t"),
    decimal=st.sampled_from(".,"),
    declares=st.booleans(),
    end=st.sampled_from(["\n", "\r\n", "\r"]),
    blanks=st.booleans(),
    quotes=st.booleans(),
    empty_cells=st.integers(0, 3),
    empty_lines=st.booleans(),
    comment=st.booleans(),
    numbered=st.booleans(),
    without_last_end=st.booleans(),
)


@pytest.mark.thorough
@given(SPREADSHEETS, st.floats(0, 1e5), st.integers(0, 99))
@example(Spreadsheet(encoding="utf-8-sig", separator=";", decimal=",", end="\r\n"), 0.0, 0)
@example(Spreadsheet(encoding="utf-16", separator="\t", decimal=","), 0.0, 0)
@example(Spreadsheet(declares=True), 0.0, 0)
def test_a_record_is_read_as_it_was_written(sheet: Spreadsheet, start: float, seed: int) -> None:
    table = cells(start=start, seed=seed)
    plain, mangled = records(Spreadsheet().save(table)), records(sheet.save(table))
    assert [law for law, _ in mangled] == [law for law, _ in plain] == list(LAWS[:2])
    for (_, found), (_, written) in zip(mangled, plain, strict=True):
        assert np.array_equal(found, written)
    wanted = [NAMES.index(name) for name in ("q1_rad", "q2_rad")]
    for (_, found), begin in zip(plain, (1, 41), strict=True):
        numbers = [[float(row[i]) for i in wanted] for row in table[begin : begin + 40]]
        assert np.array_equal(found[:, :2], numbers)


@given(SPREADSHEETS, st.lists(st.tuples(ANY_NUMBER, ANY_NUMBER), min_size=1, max_size=9))
def test_any_numbers_are_read_as_they_were_written(
    sheet: Spreadsheet, points: list[tuple[float, float]]
) -> None:
    written = [["x", "note", "y"], *([f"{x:.9g}", "a, b; c", f"{y:.9g}"] for x, y in points)]
    table = read(sheet.save(written), "y", "x", texts=("note", "other"))
    assert np.array_equal(table.numbers, [(y, x) for x, y in points])
    assert table.texts == {"note": ["a, b; c"] * len(points)}


@given(SPREADSHEETS, st.lists(st.tuples(st.integers(0, 10**6), st.binary(max_size=4)), max_size=5))
def test_whatever_else_is_in_a_file_is_refused_with_its_line(
    sheet: Spreadsheet, changes: list[tuple[int, bytes]]
) -> None:
    data = bytearray(sheet.save(cells(8)))
    for at, new in changes:
        at %= len(data)
        data[at : at + len(new)] = new
    try:
        assert records(bytes(data))
    except CodedError as error:
        assert "line " in str(error)


@given(st.binary(max_size=400) | st.text(max_size=400).map(str.encode))
@example(b"sep=")
@example(b"sep=\n")
@example(b"x\n1_000")
@example("x\n٣".encode())
@example(b"x\n.")
def test_noise_is_refused_with_its_line(data: bytes) -> None:
    with pytest.raises(CodedError, match="line "):
        read(data, "x")
    with pytest.raises(CodedError, match="line "):
        read(b"x,y\n1,1\n1,a" + data, "x", "y")


TEXT = "\n".join(",".join(row) for row in cells()[:41])


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "line 1: there is no column x"),
        ("\n\n# nothing\n", "line 1: there is no column x"),
        ("a;b\n1;2\n", "line 1: there is no column x"),
        ("x,x,y\n1,2,3\n", "line 1: there are several columns x"),
        ("x,y\n", "line 1: no rows follow"),
        ("sep=|\nx|y\n1|2\n", "line 1: '|' separates no columns"),
        ("# a\nx,y\n\n1,2\n3\n", "line 5: expected 2 cells, got 1"),
        ("x,y\n1,2,,3\n", "line 2: expected 2 cells, got 4"),
        ("x;y\n1,5;2\n1.5;2\n", "line 3, column x: '1.5' differs .* decimal comma"),
        ("x;y\n1.5;2\n2;1,5\n", "line 3, column y: '1,5' differs .* decimal point"),
        ("x;y\n1.234,5;2\n", "line 2, column x: '1.234,5' is not a number"),
        ('x,y\n"1,234.5",2\n', "line 2, column x: '1,234.5' is not a number"),
        ("x,y\n1,#DIV/0!\n", "line 2, column y: '#DIV/0!' is not a number"),
        ("x,y\n1,2\n#DIV/0!,1\n", "line 3, column x: '#DIV/0!' is not a number"),
        ("x;y\n1;2\n#WERT!;1\n", "line 3, column x: '#WERT!' is not a number"),
        ("x,y\n1,2\n###,1\n", "line 3, column x: '###' is not a number"),
        ("x,y\nnan,1\n", "line 2, column x: 'nan' is not a number"),
        ("x,y\n1e400,1\n", "line 2, column x: '1e400' is out of range"),
        ("x,y\n1,\n", "line 2, column y: '' is not a number"),
        ('x,y\n1,"2\n3,4\n', "line 2: a quotation mark"),
        ("x,y\n" + "7" * LONGEST_LINE, "line 2 is longer than"),
    ],
)
def test_an_error_says_where(text: str, said: str) -> None:
    with pytest.raises(CodedError, match=rf"^{said.replace('|', '[|]')}") as caught:
        read(text, "x", "y")
    assert caught.value.message.text("de").startswith("Zeile ")


def test_a_minus_sign_of_a_typesetter_is_one() -> None:
    assert read("x\n\N{MINUS SIGN}1.5e\N{MINUS SIGN}3\n", "x").numbers[0, 0] == -1.5e-3


def test_comments_are_left_out_and_a_column_may_be_called_number() -> None:
    text = "#made by hand\n#;x\n1;2\n# Pause\n#Pause\n2;3\n"
    assert read(text, "x").numbers[:, 0].tolist() == [2, 3]


def test_a_file_need_not_name_the_law_nor_keep_the_order_of_columns() -> None:
    table = cells()[:41]
    order = [i for i in reversed(range(len(NAMES))) if NAMES[i] != "law"]
    text = "\n".join(",".join(row[i] for i in order) for row in table)
    ((law, numbers),) = records(text)
    assert law == "" and np.array_equal(numbers, records(TEXT)[0][1])


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda rows: rows.insert(9, rows[9]), "line 11, column t_s: the times do not grow"),
        (lambda rows: rows.insert(9, rows[14]), "line 11, column t_s: the times do not grow"),
        (
            lambda rows: [r.__setitem__(0, f"{float(r[0]):.2f}") for r in rows[1:]],
            "do not grow from row to row",
        ),
    ],
)
def test_times_that_do_not_grow_are_refused_with_their_line(change, said: str) -> None:
    rows = [list(row) for row in cells()[:41]]
    change(rows)
    with pytest.raises(CodedError, match=said):
        records("\n".join(",".join(row) for row in rows))


def test_a_file_of_another_robot_says_so() -> None:
    with pytest.raises(CodedError, match=r"not a record of the robot five_bar: line 1: .* tau2_Nm"):
        records(TEXT.replace("tau2_Nm", "tau9_Nm"))


def test_a_single_row_is_no_motion() -> None:
    with pytest.raises(CodedError, match="line 2: a single row"):
        records("\n".join(TEXT.split("\n")[:2]))
