"""Lesson 7 asks which normalisation of the modes makes (20)-(21) the equations of Lagrange."""

from __future__ import annotations

import re

import pytest

from tests.support.checkout import ROOT


@pytest.mark.parametrize("language", ["en", "de"])
def test_only_the_mass_normalised_modes_are_the_right_answer(language: str) -> None:
    """The answers are tested in test_flexible_five_bar: the integral 1, l / 4 and 1 / ρ."""
    text = (ROOT / "lessons/course/07-flexible-link" / f"{language}.md").read_text("utf-8")
    options = re.findall(r'\{ text = "(.*?)",( right = true,)? answer', text)
    asked = {option: bool(right) for option, right in options if "varphi" in option}
    assert {option.split("$")[1]: right for option, right in asked.items()} == {
        r"\\int\\varphi^2\\,ds = 1": False,
        r"\\varphi(\\ell) = 1": False,
        r"\\rho\\int\\varphi^2\\,ds = 1": True,
    }
