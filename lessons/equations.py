"""The table of a paper's equations that a course treats, of which a lesson shows a part.

It is `equations.toml` beside the lessons' folders, for all languages: what each symbol is here, and
the lesson and the code where it is found.
"""

from __future__ import annotations

from pathlib import Path

import msgspec

from onpath.lessons.action_schema import Data
from onpath.lessons.text_files import load_toml, read_text
from onpath.lessons.words import DEFAULT, Words

FILE = "equations.toml"


class Equation(Data, frozen=True):
    """One equation of the paper.

    Attributes:
        number: in the paper.
        formula: LaTeX, shortened where it is long.
        here: language -> what its symbols are in this course, in Markdown.
        lesson: folder of the lesson that treats it.
        code: file and name, as "models/paths/curves.py: Curve".
        figure: numbers of the paper's figures, if any.
    """

    number: int
    formula: str
    here: dict[str, str]
    lesson: str
    code: str
    figure: str = ""


class Part(Data, frozen=True):
    """The contents of a block ```equations: the numbers of the first and the last one."""

    first: int
    last: int


def read_equations(file: Path) -> list[Equation]:
    """The equations in a file.

    Raises:
        FileError: there is no such file.
        ValueError: it has a fault.
    """
    return msgspec.convert(load_toml(read_text(file))["equation"], list[Equation])


def equations_table(equations: list[Equation], language: str) -> tuple[str, str]:
    """Title and Markdown of a table of some equations."""
    words = Words(language)
    heads = [words("equations.formula"), words("equations.here"), words("equations.place")]
    rows = [["", *heads], ["---"] * 4]
    for each in equations:
        number = each.lesson.partition("-")[0].lstrip("0")
        places = [words("equations.lesson", number=number), f"`{each.code}`"]
        if each.figure:
            places.insert(1, words("equations.figure", number=each.figure))
        here = each.here.get(language) or each.here[DEFAULT]
        rows.append([f"({each.number})", f"${each.formula}$", here, ", ".join(places)])
    numbers = [each.number for each in equations]
    title = words("equations.title", first=numbers[0], last=numbers[-1], count=len(numbers))
    return title, "\n".join(f"| {' | '.join(row)} |" for row in rows)
