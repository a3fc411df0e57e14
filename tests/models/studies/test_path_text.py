"""Paths as typed text: what each form means, and that nothing else is taken for a path."""

from __future__ import annotations

import json

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from onpath.models.paths.curves import Curve
from onpath.models.paths.path_design import presets
from onpath.models.studies.path_text import LONGEST_TEXT, curve_from_text, is_described

CORNERS = np.array([[0.05, 0.0], [0.0, 0.04], [-0.05, 0.0], [0.0, -0.04]])


@pytest.mark.parametrize("name", presets())
def test_a_preset_is_meant_by_its_name(name: str) -> None:
    assert np.array_equal(
        curve_from_text(f" {name} ").coefficients, presets()[name].curve.coefficients
    )


def test_circle_ellipse_and_segment_are_exact() -> None:
    angle = np.linspace(-3, 3, 7)
    round_ = curve_from_text("circle 0.04, 0.01 -0.02").at(angle)
    assert np.hypot(*(round_ - (0.01, -0.02)).T) == pytest.approx(0.04)
    oval = curve_from_text("ellipse 0.07 0.04").at(angle)
    assert ((oval / (0.07, 0.04)) ** 2).sum(-1) == pytest.approx(1.0)
    ends = curve_from_text("segment -0.05 0 0.05 0.02").at(np.array([-np.pi, np.pi]))
    assert ends == pytest.approx(np.array([[-0.05, 0.0], [0.05, 0.02]]))


@pytest.mark.parametrize("closed", [True, False])
def test_points_mean_the_same_as_text_and_as_json(closed: bool) -> None:
    words = " ".join(map(str, CORNERS.ravel()))
    typed = curve_from_text(f"{'closed' if closed else 'open'} {words}")
    read = curve_from_text(json.dumps({"closed": closed, "points": CORNERS.tolist()}))
    assert (
        np.array_equal(typed.coefficients, read.coefficients)
        and typed.closed is read.closed is closed
    )
    assert typed.nearest(CORNERS)[1].max() < 2e-3
    if closed:
        assert np.array_equal(
            curve_from_text(json.dumps(CORNERS.tolist())).coefficients, typed.coefficients
        )


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "did you mean|there are"),
        ("elipse 1 2", "did you mean ellipse"),
        ("circle", ""),  # the preset
        ("circle 0", "positive"),
        ("circle 1 2", r"circle RADIUS \[Z1 Z2\], \[m\], got 2 numbers"),
        ("circle 0,05", "^path: write 0.05 instead of 0,05$"),
        ("ellipse 0,07 0,04", "^path: write 0.07 instead of 0,07$"),
        ("closed 0,05 0,01 0,01 0,04 -0,05 0,01", "^path: write 0.05 instead of 0,05$"),
        ("circle nan", "between -1 and 1 m"),
        ("circle 1e999", "between -1 and 1 m"),
        ("ellipse a b", "ellipse A B"),
        ("segment 0 0 0 0", "at least 2"),
        ("closed 0 0 1 1", "3 to 200 points"),
        ("closed " + "0 " * 500, "3 to 200 points"),
        ("[[0, 0], [1]]", "JSON such as"),
        ('[[0, 0], [1, "1"], [0, 1]]', "JSON such as"),
        ('{"points": 3}', "JSON such as"),
        ('{"points": [[0, 0]], "holes": 1}', "JSON such as"),
        ("[" * 30_000, "JSON such as"),
        ("[" + "1" * 10_000 + "]", "JSON such as"),
        ("0" * (LONGEST_TEXT + 1), "more than"),
    ],
)
def test_an_invalid_path_is_refused_with_the_expected_form(text: str, words: str) -> None:
    if not words:
        assert curve_from_text(text).closed
        return
    with pytest.raises(ValueError, match=words):
        curve_from_text(text)


@given(st.text(max_size=60) | st.from_regex(r"(closed|open|circle) [-0-9. ]{0,60}", fullmatch=True))
def test_any_text_is_a_curve_or_a_complaint(text: str) -> None:
    try:
        curve = curve_from_text(text)
    except ValueError:
        return
    assert isinstance(curve, Curve) and np.isfinite(curve.coefficients).all()


def test_an_equation_means_its_closed_line() -> None:
    """The ellipse agrees with the one in closed form, a squircle with its equation."""
    angle = np.linspace(-np.pi, np.pi, 200)
    oval = curve_from_text("implicit z1**2/0.0036 + z2**2/0.0016 - 1")
    assert (
        oval.closed and oval.nearest(curve_from_text("ellipse 0.06 0.04").at(angle))[1].max() < 1e-5
    )
    square = curve_from_text("implicit (z1/0.05)**4 + ((z2 - 0.01)/0.04)**4 - 1")
    z1, z2 = square.at(angle).T
    value = (z1 / 0.05) ** 4 + ((z2 - 0.01) / 0.04) ** 4
    assert np.abs(value - 1).max() < 0.02  # some 0.2 mm


@pytest.mark.parametrize(
    ("expression", "words"),
    [
        ("z1**2 + z2**2 + 1", "no solution"),
        ("z1", "an open line"),
        ("(z1**2 + z2**2 - 0.0009)*(z1**2 + z2**2 - 0.0016)", "2 lines"),
        ("max(abs(z1), abs(z2)) - 0.05", "cannot follow"),
        ("z1**2 + z3**2 - 1", "column 18: there is no .z3"),
        ("sqrt(-1 - z1**2)", "no solution"),
        ("1/0", "no solution|finite"),
        ("().__class__", "line 1, column"),
        ("", "line 1, column"),
    ],
)
def test_an_equation_without_one_smooth_closed_line_is_refused(expression: str, words: str) -> None:
    with pytest.raises(ValueError, match=words):
        curve_from_text(f"implicit {expression}")


def test_a_minus_of_a_typesetter_and_commas_between_numbers_are_read() -> None:
    plain = curve_from_text("segment -0.05 0 0.05 -0.02")
    assert np.array_equal(
        curve_from_text("segment −0.05,0 0.05,−0.02").coefficients, plain.coefficients
    )


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("x,y\n0.05,0\n0,0.04\n", False),
        ("0.05\t0\n", False),
        ("circle 0.05", True),
        ("\ufeff\n figure of eight", True),
        ("closed 0.05 0 0 0.04 -0.05 0", True),
        ('{"points": []}', True),
        ("", False),
    ],
)
def test_a_description_is_told_from_the_content_of_other_files(text: str, expected: bool) -> None:
    assert is_described(text) is expected
