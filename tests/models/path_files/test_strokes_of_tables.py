"""Several strokes in a table, and signatures as JSON."""

from __future__ import annotations

import json
import re

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.models.errors import CodedError
from onpath.models.path_files.reading import drawing_of

POINT = st.tuples(st.floats(-0.1, 0.1), st.floats(-0.1, 0.1))
STROKES = st.lists(st.lists(POINT, min_size=2, max_size=6), min_size=2, max_size=4)
Strokes = list[list[tuple[float, float]]]


def rows(strokes: Strokes, mark: str = "{}", between: str = "", up: bool = False) -> str:
    """Rows of a table: `mark` is a third cell, made of the stroke's number."""
    text = list[str]()
    for number, stroke in enumerate(strokes):
        for i, (x, y) in enumerate(stroke):
            third = mark.format(0 if up and i == 0 else 1 if up else number)
            text.append(f"{x!r},{y!r}" + (f",{third}" if third != "{}" and mark != "{}" else ""))
        text.append(between)
    return "\n".join(line for line in text if line or between == "")


WAYS = {
    "empty lines": lambda z: "x,y\n" + rows(z),
    "empty lines without names": lambda z: rows(z),
    "empty rows of a spreadsheet": lambda z: "x,y\n" + rows(z, between=",,"),
    "numbers of strokes": lambda z: "x,y,stroke\n" + rows(z, mark="{}.0", between="#"),
    "numbers of pens": lambda z: "x,y,pen\n" + rows([*z, *z], mark="{}1", between="#"),
    "a pen that is down": lambda z: "x,y,pen\n" + rows(z, mark="{}.", between="#", up=True),
    "a pen without a name": lambda z: rows(z, mark="{}.", between="#", up=True),
}


@pytest.mark.parametrize("way", WAYS)
@settings(max_examples=30)
@given(STROKES)
def test_strokes_of_a_table_are_the_same_however_they_are_told(way: str, strokes: Strokes) -> None:
    text = WAYS[way](strokes)
    for data in (text.encode(), b"\xef\xbb\xbf" + text.replace("\n", "\r\n").encode()):
        found = drawing_of(data, "a.csv").strokes[: len(strokes)]
        assert len(found) == len(strokes)
        for stroke, given_points in zip(found, strokes, strict=True):
            np.testing.assert_array_equal(stroke.points, given_points)
    german = text.replace(",", ";").replace(".", ",")
    if "e-" not in text:
        again = drawing_of(german.encode(), "a.csv").strokes
        np.testing.assert_array_equal(again[0].points, found[0].points)


@settings(max_examples=30)
@given(STROKES)
def test_a_signature_as_json_has_its_strokes(strokes: Strokes) -> None:
    old = [[{"x": 1e3 * x, "y": 1e3 * y, "time": 5} for x, y in stroke] for stroke in strokes]
    new = [{"penColor": "black", "dotSize": 0, "points": stroke} for stroke in old]
    for written in (json.dumps(old), json.dumps(new, indent=2)):
        found = drawing_of(written.encode(), "a.json")
        assert [each.closed for each in found.strokes] == [False] * len(strokes)
        for stroke, given_points in zip(found.strokes, strokes, strict=True):
            flipped = 1e3 * np.array(given_points) * (1, -1) * 0.0254 / 96
            np.testing.assert_allclose(stroke.points, flipped, atol=1e-15)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ('[{"points": [{"x": 1}]}]', "stroke 1 of the signature has no points"),
        ('[{"points": [{"x": 1, "y": 1}]}, {"x": 3}]', "stroke 2 of the signature"),
        ('[{"points": [{"x": 1, "y": NaN}]}]', "stroke 1 of the signature"),
        ('[{"points": [{"x": 1, "y": 1e400}]}]', "stroke 1 of the signature"),
        ('[{"points": [{"x": true, "y": 1}]}]', "stroke 1 of the signature"),
        ('[{"points": [\n{"x": 1, "y": }', "line 2, column 15: not JSON"),
        ('[{"points": []}]', "no line that could be a path"),
        ('[{"points": ' + "[" * 100_000, "signature"),
        ("1,2,3\n4,5,6\n", "3 columns"),
        ("0,0,0\n1,0,0.5\n1,1,0.5\n0,1,0.5\n", "3 columns"),
    ],
)
def test_anything_else_is_refused(text: str, words: str) -> None:
    with pytest.raises(CodedError, match=re.escape(words)):
        drawing_of(text.encode(), "a.json")
