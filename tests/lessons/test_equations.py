"""The table of the paper's equations, and the parts of it that lessons show."""

from __future__ import annotations

import ast
import re
import tempfile
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.lessons.course import BUILT_IN, read_course
from onpath.lessons.equations import FILE, Equation, read_equations
from onpath.lessons.parse import read_lesson
from onpath.lessons.problems import LessonError
from onpath.lessons.schema import Text
from tests.support.built_in import built_in_course
from tests.support.catalogues import COMPLETE
from tests.support.checkout import ROOT
from tests.support.lesson_texts import LESSON, write_lesson

PAPER = 23
BUILT = read_equations(BUILT_IN / FILE)
DEFINED = ast.FunctionDef, ast.ClassDef
RANGE = re.compile(r"\((\d+)\)(?:-| to )\((\d+)\)")
CELL = re.compile(r"<td>\((\d+)\)</td>")


def test_every_equation_of_the_paper_is_said_once_in_all_languages() -> None:
    assert [each.number for each in BUILT] == list(range(1, PAPER + 1))
    assert all(set(each.here) == set(COMPLETE) for each in BUILT)


@pytest.mark.parametrize("each", BUILT, ids=lambda each: str(each.number))
def test_an_equation_is_where_the_table_says(each: Equation) -> None:
    """In a lesson that speaks of it by its number, and in a file that defines the name."""
    file, _, defined = each.code.partition(": ")
    tree = ast.parse((ROOT / file).read_text("utf-8"))
    assert defined in {part.name for part in ast.walk(tree) if isinstance(part, DEFINED)}
    text = (BUILT_IN / each.lesson / "en.md").read_text("utf-8")
    ranges = [(int(first), int(last)) for first, last in RANGE.findall(text)]
    within = any(first <= each.number <= last for first, last in ranges)
    assert within or f"({each.number})" in text


@given(st.integers(0, PAPER + 2), st.integers(0, PAPER + 2))
@settings(max_examples=12)
def test_a_lesson_shows_the_part_that_it_names(first: int, last: int) -> None:
    block = f"```equations\nfirst = {first}\nlast = {last}\n```\n"
    expected = [n for n in range(1, PAPER + 1) if first <= n <= last]
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / FILE).write_text((BUILT_IN / FILE).read_text("utf-8"), "utf-8")
        file = write_lesson(Path(folder), f"{LESSON}\n{block}")
        if not expected:
            with pytest.raises(LessonError, match="no equation"):
                read_lesson(file)
            return
        shown = read_lesson(file).steps[-1].blocks[-1]
    assert isinstance(shown, Text) and "<details>" in shown.html
    assert [int(number) for number in CELL.findall(shown.html)] == expected


@pytest.mark.parametrize("content", [None, "", "[[equation]]\nnumber = 1\n", "equation = 3"])
def test_a_table_that_cannot_be_read_is_a_fault(tmp_path: Path, content: str | None) -> None:
    if content is not None:
        (tmp_path / FILE).write_text(content)
    write_lesson(tmp_path, f"{LESSON}\n```equations\nfirst = 1\nlast = 2\n```\n")
    _, problems = read_course([tmp_path])
    assert any(FILE in each.text for each in problems)


def test_the_whole_paper_is_shown() -> None:
    course, _ = built_in_course()
    sittings = [course.lesson(name, "en") for name in course.lessons if name.startswith("09")]
    steps = [step for lesson in sittings for step in lesson.steps]
    html = "".join(b.html for step in steps for b in step.blocks if isinstance(b, Text))
    assert sorted(int(number) for number in CELL.findall(html)) == list(range(1, 24))
