"""No text claims that the paper's equations (20)-(21) are wrong: they are not.

That they are those of Lagrange with mass-normalised modes is a law of test_flexible_five_bar.
"""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.support.checkout import ROOT

TOLD = sorted(
    file
    for pattern in ("*.md", "*.py", "*.toml", "*.svg", "*.ftl", "*.html", "*.js")
    for folder in ("app", "assets", "lessons", "models")
    for file in (ROOT / folder).rglob(pattern)
)
CHARGE = re.compile(
    r"\bas.printed|wie gedruckt|(factor|Faktor) (ρ|rho)|(ρ|rho) (= 0.2 )?(too|zu) (much|often|viel)"
    r"|(rho|ρ) once too",
    re.IGNORECASE,
)
FORMER = '{"as_printed": "unit_modes"}'  # still read


def charged(file: Path) -> str:
    """The first such claim in a file; empty if there is none."""
    text = " ".join(file.read_text(encoding="utf-8").replace(FORMER, "").split())
    found = CHARGE.search(text)
    return found[0] if found else ""


def test_no_file_says_so() -> None:
    assert len(TOLD) > 500
    found = {str(file): charged(file) for file in [*TOLD, ROOT / "README.md"]}
    assert {file: said for file, said in found.items() if said} == {}


@pytest.mark.parametrize(
    "charge",
    [
        "the derived model, or the paper's with a factor ρ too much",
        "das Modell des Artikels mit einem Faktor ρ zu viel",
        "where a factor ρ = 0.2 too much stands",
        "rho once too often",
        "the plant as printed",
    ],
)
def test_it_would_be_noticed(charge: str) -> None:
    assert CHARGE.search(charge)


@pytest.mark.parametrize("language", ["en", "de"])
def test_lesson_7_asks_which_normalisation_makes_them_those_of_lagrange(language: str) -> None:
    """The answers are tested in test_flexible_five_bar: the integral 1, l / 4 and 1 / ρ."""
    text = (ROOT / "lessons/course/07-flexible-link" / f"{language}.md").read_text("utf-8")
    options = re.findall(r'\{ text = "(.*?)",( right = true,)? answer', text)
    asked = {option: bool(right) for option, right in options if "varphi" in option}
    assert {option.split("$")[1]: right for option, right in asked.items()} == {
        r"\\int\\varphi^2\\,ds = 1": False,
        r"\\varphi(\\ell) = 1": False,
        r"\\rho\\int\\varphi^2\\,ds = 1": True,
    }
