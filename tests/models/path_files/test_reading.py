"""Files of points, drawings and tool paths: one path, however they are written, or a refusal."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import event, example, given, settings
from hypothesis import strategies as st

from onpath.models.arrays import Array
from onpath.models.errors import CodedError
from onpath.models.path_files import svg
from onpath.models.path_files.gcode import strokes_of_gcode
from onpath.models.path_files.placing import CORNERED, LARGEST, Placing, least_radius
from onpath.models.path_files.reading import (
    ImportedPath,
    path_in,
    path_of,
    path_of_drawing,
    path_through,
    read_reference,
)
from onpath.models.path_files.stroke import MOST_POINTS, LineDrawing, Stroke
from onpath.models.paths.curves import circle, ellipse
from onpath.models.paths.spline_curves import SplineCurve

pytest.importorskip("svgpathtools")

CORNERS = np.array([[0.05, 0.0], [0.0, 0.04], [-0.05, 0.01], [0.0, -0.04]])
DRAWING = """<?xml version="1.0"?>
<svg xmlns="http://www.w3.org/2000/svg" width="120mm" height="80mm" viewBox="0 0 120 80">
  <!-- a leaf -->
  <g transform="translate(1 2)">
    <path id="leaf" d="M8 40 C8 10 60 2 88 14 S118 66 84 68 S8 70 8 40 Z"/>
  </g>
</svg>
"""
LEAF = (
    ((8, 40), (8, 10), (60, 2), (88, 14)),
    ((88, 14), (116, 26), (118, 66), (84, 68)),
    ((84, 68), (50, 70), (8, 70), (8, 40)),
)
"""The control points of that path, [mm]."""
TOOL = """(a slot)
N10 G21 G90 ; millimetres
G0 X-40 Y-20
G1 X30 Y-20 F300
G3 X30 Y20 I0 J20
G1 X-40 Y20
X-40 Y-20
"""
MILL = """T1 M6
G17 G21 G40 G49 G80 G90 G94 G54
S12000 M3
M8
G0 Z5
G0 X-40 Y-20
G4 P0.5
G1 Z-1 F100
G1 X30 Y-20 F300
G3 X30 Y20 I0 J20
G1 X-40 Y20
X-40 Y-20
G0 Z5
"""
TABLE = "x,y\n0.05,0\n0,0.04\n-0.05,0.01\n0,-0.04\n"


def read(text: str | bytes, name: str = "a.csv", **options: object) -> ImportedPath:
    data = text.encode() if isinstance(text, str) else text
    return path_of(data, name, Placing(**options))  # type: ignore[arg-type]


def same(one: ImportedPath, other: ImportedPath) -> bool:
    return one.curve.closed == other.curve.closed and np.array_equal(
        one.curve.coefficients, other.curve.coefficients
    )


# The same path, however it is written

PLAIN = read(TABLE)
WRITTEN = {
    "byte-order mark": b"\xef\xbb\xbf" + TABLE.encode(),
    "UTF-16": TABLE.encode("utf-16"),
    "semicolons, decimal commas": TABLE.replace(",", ";").replace(".", ",").encode(),
    "tabs": TABLE.replace(",", "\t").encode(),
    "declared separator": b"sep=,\n" + TABLE.encode(),
    "blanks": TABLE.replace(",", "  ").encode(),
    "NumPy's blanks": TABLE.replace(",", " ").replace("x y", "# x y").encode(),
    "no names": TABLE.partition("\n")[2].encode(),
    "blanks, decimal commas": TABLE.partition("\n")[2].replace(",", " ").replace(".", ",").encode(),
    "Windows": TABLE.replace("\n", "\r\n").encode(),
    "empty lines": TABLE.replace("\n", "\n\n  \n").encode(),
    "empty cells": TABLE.replace("\n", ",,\n").encode(),
    "quotes": re.sub(r"[^,\n]+", lambda cell: f'"{cell[0]}"', TABLE).encode(),
    "comment": b"# of 2026\n" + TABLE.encode(),
    "without a last end": TABLE.rstrip().encode(),
    "other columns": b"t,y,x\n0,0,0.05\n1,0.04,0\n2,0.01,-0.05\n3,-0.04,0\n",
    "names in a comment": b"# 3\n# t, y_m, x_m\n0,0,0.05\n1,0.04,0\n2,0.01,-0.05\n3,-0.04,0\n",
    "minus of a typesetter": TABLE.replace("-", "\u2212").encode(),
    "names of the plane": TABLE.replace("x,y", "z1,z2").encode(),
    "unit in a name": TABLE.replace("x,y", "x_m,y_m").encode(),
    "unit in brackets": TABLE.replace("x,y", "X [m],Y [m]").encode(),
}


@pytest.mark.parametrize("way", WRITTEN)
def test_a_table_means_the_same_whatever_a_spreadsheet_made_of_it(way: str) -> None:
    assert same(read(WRITTEN[way]), PLAIN)
    assert PLAIN.curve.closed and PLAIN.curve.nearest(CORNERS)[1].max() < 2e-3


@pytest.mark.parametrize("name", ["x [{}]", "x_{}", "x ({})", "x in {}", "x/{}"])
def test_a_unit_in_the_names_or_asked_for_scales_the_points(name: str) -> None:
    for unit, size in (("mm", 1e3), ("cm", 1e2), ("in", 1 / 0.0254)):
        x = name.format(unit)
        rows = [
            f"{x},{x.replace('x', 'y', 1)}",
            *(f"{a!r},{b!r}" for a, b in (size * CORNERS).tolist()),
        ]
        found = read("\n".join(rows))
        np.testing.assert_allclose(found.curve.coefficients, PLAIN.curve.coefficients, atol=1e-12)
        asked = read("\n".join(rows[1:]), unit=unit)
        assert same(found, asked)


@pytest.mark.parametrize("count", [12, 50, 5000, 60_000])
def test_a_circle_of_few_or_many_points_is_that_circle(count: int) -> None:
    angle = np.linspace(0, 2 * np.pi, count, endpoint=False)
    points = 0.05 * np.column_stack([np.cos(angle), np.sin(angle)])
    rows = "\n".join(f"{a!r};{b!r}" for a, b in points.tolist())
    for found in (read(rows), path_through(points, Placing())):
        radius = np.linalg.norm(found.curve.at(found.curve.sample(200)), axis=1)
        assert np.abs(radius - 0.05).max() < 1e-4
        sagitta = 0.05 * (1 - np.cos(np.pi / count))
        assert found.curve.deviation == pytest.approx(sagitta, abs=1.1e-4)


TOOLS = {
    "small letters": TOOL.lower(),
    "no line numbers": TOOL.replace("N10 ", ""),
    "blanks in words": TOOL.replace("X", "X ").replace("Y", "  Y"),
    "no blanks": "\n".join(re.sub(r" (?=[A-Z])", "", line) for line in TOOL.splitlines()),
    "inches": re.sub(
        r"([XYIJ])(-?\d+)", lambda w: f"{w[1]}{float(w[2]) / 25.4:.15f}", TOOL
    ).replace("G21", "G20"),
    "relative": "G91 G21\nG0 X-40 Y-20\nG1 X70\nG3 Y40 J20 X0\nG1 X-70\nY-40\n",
    "radius": TOOL.replace("I0 J20", "R20"),
    "leading zeros": TOOL.replace("G0 ", "G00 ").replace("G1 ", "G01 ").replace("G3", "G03"),
    "framed": f"%\n{TOOL}%\n",
    "Windows": TOOL.replace("\n", "\r\n"),
    "a mill's": f"O1000\n{MILL}M5 M9\nM30\nno longer G-code\n",
}


def test_words_without_effect_are_told_once() -> None:
    found = read(TOOLS["a mill's"], "a.nc")
    told = [str(remark) for remark in found.remarks if remark.code == "say.gcode_words"]
    words = "M6, G40, G49, G80, G94, G54, M8, G4, M9"
    assert told == [f"These codes of the file have no effect on the path: {words}."]
    assert "say.gcode_words" not in [remark.code for remark in read(TOOL, "a.nc").remarks]


def test_a_raised_tool_ends_a_line() -> None:
    """Both lines are drawn with G1, and so is the way between them, above the plate."""
    text = "G21\nG0 X0 Y0 Z5\n" + "".join(
        f"G1 X{x} Y0\nG1 Z-1\nX{x + 30}\nY40\nG1 Z5\n" for x in (0, 100)
    )
    for part, x in ((1, 0.0), (2, 0.1)):
        points = strokes_of_gcode(text)[0][part - 1].points
        np.testing.assert_allclose(points, [[x, 0], [x + 0.03, 0], [x + 0.03, 0.04]], atol=1e-12)


@pytest.mark.parametrize("way", TOOLS)
def test_a_tool_path_means_the_same_however_it_is_written(way: str) -> None:
    plain, other = read(TOOL, "a.nc").curve, read(TOOLS[way], "a.nc").curve
    np.testing.assert_allclose(other.coefficients, plain.coefficients, atol=1e-9)
    assert plain.closed and plain.length() == pytest.approx(0.14 + 0.04 + np.pi * 0.02, rel=0.02)


@pytest.mark.thorough
@pytest.mark.parametrize("clockwise", [True, False])
@given(st.floats(-3, 3), st.floats(0.3, 6.0), st.floats(75, 120))
def test_an_arc_by_its_radius_is_the_one_by_its_centre(
    clockwise: bool, begin: float, sweep: float, radius: float
) -> None:
    end = begin - sweep if clockwise else begin + sweep
    (x0, y0), (x1, y1) = ((radius * np.cos(a), radius * np.sin(a)) for a in (begin, end))
    g, r = ("G2" if clockwise else "G3"), (radius if sweep <= np.pi else -radius)
    start = f"G0 X{x0:.9f} Y{y0:.9f}\n{g} X{x1:.9f} Y{y1:.9f}"
    one = read(f"{start} I{-x0:.9f} J{-y0:.9f}", "a.nc", closed=False).curve
    assert one.length() == pytest.approx(1e-3 * radius * sweep, rel=5e-3)
    if abs(sweep - np.pi) > 0.05:
        other = read(f"{start} R{r:.9f}", "a.nc", closed=False).curve
        assert np.abs(one.at(one.sample(50)) - other.at(other.sample(50))).max() < 1e-5


DRAWINGS = {
    "in points": DRAWING.replace("120mm", f"{120 / 25.4 * 72}pt"),
    "in pixels": DRAWING.replace("120mm", f"{120 / 25.4 * 96}"),
    "relative": DRAWING.replace(
        "M8 40 C8 10 60 2 88 14 S118 66 84 68 S8 70 8 40 Z",
        "m8 40 c0 -30 52 -38 80 -26 s30 52 -4 54 s-76 2 -76 -28 z",
    ),
    "nested": DRAWING.replace(
        '<g transform="translate(1 2)">', '<g transform="scale(1)"><g transform="translate(1,2)">'
    ).replace("</g>", "</g></g>"),
    "other things": DRAWING.replace("</svg>", "<text>a</text><style>b</style><defs/></svg>"),
    "UTF-16": DRAWING.replace("?>", ' encoding="utf-16"?>').encode("utf-16"),
    "without a namespace": DRAWING.replace(' xmlns="http://www.w3.org/2000/svg"', ""),
}


@pytest.mark.parametrize("way", DRAWINGS)
def test_a_drawing_means_the_same_however_it_is_written(way: str) -> None:
    plain, other = read(DRAWING, "a.svg").curve, read(DRAWINGS[way], "a.svg").curve
    np.testing.assert_allclose(other.coefficients, plain.coefficients, atol=1e-9)
    t = np.linspace(0, 1, 50)[:, None]
    for points in LEAF:  # Bézier curves on paper; there y points down, in the plane of a path up
        a, b, c, d = np.array(points) * (1e-3, -1e-3) + (1e-3, -2e-3)
        z = (1 - t) ** 3 * a + 3 * (1 - t) ** 2 * t * b + 3 * (1 - t) * t**2 * c + t**3 * d
        assert plain.nearest(z)[1].max() < 1e-3


def test_shapes_of_a_drawing_are_those_curves() -> None:
    head = '<svg xmlns="http://www.w3.org/2000/svg" width="100mm" viewBox="0 0 100 100">'
    round_ = read(f'{head}<circle cx="50" cy="50" r="40"/></svg>', centre=(0, 0)).curve
    radius = np.linalg.norm(round_.at(round_.sample(100)), axis=1)
    assert np.abs(radius - 0.04).max() < 1e-4
    oval = read(f'{head}<ellipse rx="40" ry="30"/></svg>', "a.svg").curve
    assert oval.length() == pytest.approx(ellipse((0.04, 0.03)).length(), rel=1e-3)
    line = read(f'{head}<polyline points="0,0 40,0 80,0"/></svg>', "a.svg").curve
    assert not line.closed and line.length() == pytest.approx(0.08, rel=1e-3)


# Place, size, corners, and which line


def test_a_path_is_placed_and_scaled_on_request() -> None:
    cases: list[tuple[dict[str, Any], float, tuple[float, float] | None]] = [
        ({"scale": 0.5}, 0.05, None),
        ({"fit": 0.08}, 0.08, (0.0, 0.0)),
        ({"fit": 0.08, "centre": (0.01, -0.02)}, 0.08, (0.01, -0.02)),
        ({"centre": (0.01, -0.02)}, 0.1, (0.01, -0.02)),
    ]
    for options, size, centre in cases:
        placed = read(TABLE, **options).curve.given
        assert placed is not None
        low, high = placed.min(0), placed.max(0)
        assert (high - low).max() == pytest.approx(size)
        if centre:
            assert (low + high) / 2 == pytest.approx(centre)


@pytest.mark.thorough
@settings(max_examples=20)
@given(st.floats(-360, 360))
def test_a_turn_turns_the_lines_about_the_centre_of_their_box(turn: float) -> None:
    before = path_through(CORNERS, Placing(centre=(0, 0), closed=True)).curve.given
    after = path_through(CORNERS, Placing(centre=(0.01, 0), closed=True, turn=turn)).curve.given
    assert before is not None and after is not None
    angle = np.deg2rad(turn)
    turned = before @ np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    moved = after - turned
    assert np.abs(moved - moved[0]).max() < 1e-12
    assert (after.min(0) + after.max(0)) / 2 == pytest.approx((0.01, 0))


SQUARE = np.array([[0.05, 0.05], [-0.05, 0.05], [-0.05, -0.05], [0.05, -0.05]])


@pytest.mark.parametrize("dense", [1, 100])
def test_corners_are_rounded_with_a_radius_that_is_told(dense: int) -> None:
    ring = np.vstack([SQUARE, SQUARE[:1]])
    at = np.linspace(0, 4, 4 * dense + 1)[:-1]
    points = np.stack([np.interp(at, range(5), ring[:, i]) for i in (0, 1)], axis=1)
    for radius in (0.01, 0.02, 0.03):
        found = path_through(points, Placing(corners="round", radius=radius))
        cut = radius * (np.sqrt(2) - 1)  # from the corner to the middle of its arc
        assert found.curve.deviation == pytest.approx(cut, abs=2e-3)
        told = next(str(each) for each in found.remarks if each.code == "say.rounded")
        assert f"{1e3 * least_radius(found.curve):.1f} mm" in told
        assert least_radius(found.curve) > 0.7 * radius
    wide = path_through(points, Placing(corners="round", radius=0.05)).curve
    assert np.abs(np.linalg.norm(wide.at(wide.sample(90)), axis=1) - 0.05).max() < 1e-3


def test_ends_of_an_open_path_are_kept() -> None:
    bent = np.array([[-0.05, -0.05], [0.05, -0.05], [0.05, 0.05]])
    for corners in ("smooth", "round"):
        curve = path_through(bent, Placing(corners=corners, closed=False)).curve
        ends = curve.at(np.array([-np.pi, np.pi]))
        assert not curve.closed and np.abs(ends - bent[[0, 2]]).max() < 2e-3


@pytest.mark.thorough
def test_all_lines_are_drawn_in_their_order_or_those_that_are_wanted_in_theirs() -> None:
    two = TOOL + "G0 X0 Y0\nG2 X0 Y0 I10 J0\n"
    alone = {part: read(two, "a.nc", part=(part,)).curve for part in (1, 2)}
    for part, order in ((None, (1, 2)), ((1, 2), (1, 2)), ((2, 1), (2, 1))):
        found = read(two, "a.nc", part=part)
        curve = found.curve
        assert isinstance(curve, SplineCurve) and curve.closed and len(curve.raised) == 2
        (begin, end), (last, back) = curve.raised
        theta = curve.sample(4000)
        share = f"{100 * (end - begin + back - last) / (2 * np.pi):.0f}"
        assert f"raised twice: {share} % of the time" in str(found.remarks[0])
        second = (theta >= end) & (theta <= last)
        for times, line in ((theta <= begin, order[0]), (second, order[1])):
            assert alone[line].nearest(curve.at(theta[times]))[1].max() < 5e-4
    small = read(two, "a.nc", part=(2,)).curve
    assert small.length() == pytest.approx(circle(0.01).length(), rel=1e-3)
    with pytest.raises(CodedError, match="part 3: the file has 2 lines"):
        read(two, "a.nc", part=(3,))


def test_options_follow_the_name_of_a_file_that_may_have_blanks() -> None:
    file, placing = read_reference(
        "my logo.svg fit=0.1 centre=0,-0.01 corners=round open part=2,1 turn=-45 layer=3"
    )
    assert file == Path("my logo.svg")
    assert placing == Placing(
        fit=0.1, centre=(0, -0.01), corners="round", closed=False, part=(2, 1), turn=-45, layer="3"
    )
    assert read_reference("a b = c.csv")[0] == Path("a b = c.csv")
    for wrong in (
        "a.csv fit=big",
        "a.csv siz=3",
        "a.csv part=x",
        "a.csv part=1,",
        "a.csv centre=1",
    ):
        with pytest.raises(ValueError, match=r"fit|scale|part|centre|option"):
            read_reference(wrong)


# What is refused, by its line


REFUSED: dict[str, tuple[str | bytes, str, str]] = {
    "empty": ("", "a.csv", "is empty"),
    "no rows": ("x,y\n", "a.csv", "line 1"),
    "three columns": ("1,2,3\n", "a.csv", "line 1: 3 columns"),
    "a word": ("x,y\n0.05,0\n0,four\n", "a.csv", "line 3, column y: 'four' is not a number"),
    "a word without names": ("0.05,0\n0,four\n", "a.csv", "line 2, column 2: 'four'"),
    "a cell too many": ("x,y\n0.05,0\n0,0.04,1\n", "a.csv", "line 3: expected 2 cells, got 3"),
    "both signs": ("x;y\n0.05;0,1\n", "a.csv", "line 2, column y: '0,1'"),
    "not a number": ("x,y\n0.05,nan\n", "a.csv", "line 2, column y"),
    "infinite": ("x,y\n0.05,1e999\n", "a.csv", "line 2, column y"),
    "x twice": ("x,x,y\n1,2,3\n", "a.csv", "line 1: there are several columns x"),
    "two units": ("x_mm,y_m\n1,2\n", "a.csv", "line 1: x and y have different units"),
    "large": ("50,0\n0,40\n-50,0\n", "a.csv", "reaches 50 m from the origin"),
    "two points": ("0.05,0\n0.05,0\n", "a.csv", "at least 3 points"),
    "a subprogram": ("G21\nM98 P2\n", "a.nc", "line 2, column 1: M98 runs another program"),
    "another offset": ("G21\nX0 G10 L2 Y3\n", "a.nc", "line 2, column 4: G10 moves the origin"),
    "another origin": ("G1 X3\nG55\n", "a.nc", "line 2, column 1: G55 moves the origin"),
    "a turned program": ("G68 R30\n", "a.nc", "line 1, column 1: G68 scales, turns"),
    "an unknown code": ("G1 X3\n G77.5 X3", "a.nc", "line 2, column 2: G77.5 is not known"),
    "an arc upwards": ("G18\nG1 X3\nG2 X5 R3", "a.nc", "line 3: an arc in another plane"),
    "a rotary axis": ("G1 X3 A30\n", "a.nc", "line 1, column 7: 'A30' is not read"),
    "a variable": ("#1=3\nG1 X#1", "a.nc", "line 1, column 1: '#1=3' is not read"),
    "compensated": ("G21\nG41 X3\n", "a.nc", "line 2, column 1: G41 moves the path aside"),
    "a bare letter": ("G1 X\n", "a.nc", "line 1, column 4: 'X'"),
    "no motion": ("X3 Y4\n", "a.nc", "no line that could be a path"),
    "two motions": ("G0 G1 X3\n", "a.nc", "line 1: G0, G1"),
    "X twice": ("G1 X3 X4\n", "a.nc", "line 1, column 7: 'X4'"),
    "arc without centre": ("G2 X3 Y4\n", "a.nc", "line 1: an arc needs"),
    "arc with both": ("G2 X3 Y4 I1 R3\n", "a.nc", "line 1: an arc needs"),
    "arc that misses its end": ("G2 X30 Y4 I10\n", "a.nc", "line 1: the arc's ends"),
    "small radius": ("G2 X30 R3\n", "a.nc", "line 1: no arc with the radius 3 mm"),
    "centre of a line": ("G1 X3 I4\n", "a.nc", "line 1: I, J and R"),
    "nothing drawn": ("G21\nG0 X3\n", "a.nc", "no line that could be a path"),
    "not XML": ("<svg><path</svg>", "a.svg", "line 1, column"),
    "not a drawing": ("<html/>", "a.svg", "not an SVG drawing"),
    "an empty drawing": ("<svg/>", "a.svg", "no line that could be a path"),
    "a bad path": ('<svg>\n<path d="M 0 0 L 3 x"/></svg>', "a.svg", "line 2: this path"),
    "a bad number": ('<svg>\n<circle r="x"/></svg>', "a.svg", "line 2: this circle"),
    "a bad transform": ('<svg>\n<g transform="turn(3)"/></svg>', "a.svg", "line 2: this g"),
    "far away": ('<svg>\n<path d="M0 0 L1e300 1 1e308 3z"/></svg>', "a.svg", "from the origin"),
    "an unknown entity": ("<svg>\n&a;</svg>", "a.svg", "line 2, column"),
    "nested": ("<svg>\n" + "<g>" * 99 + "</g>" * 99 + "</svg>", "a.svg", "line 2: the drawing has"),
    "many elements": ("<svg>\n" + "<g/>" * 20_001 + "</svg>", "a.svg", "line 2: the drawing has"),
    "many points": ("0.01,0.02\n" * (MOST_POINTS + 1), "a.csv", f"line {MOST_POINTS + 1}: more"),
    "a long line": ("0" * 20_000, "a.csv", "line 1 is longer"),
    "a picture": (b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0", "a.png", "line 1"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_anything_else_is_refused_by_its_line(case: str) -> None:
    text, name, words = REFUSED[case]
    with pytest.raises(CodedError, match=re.escape(words)):
        read(text, name)


def test_without_the_library_a_drawing_says_how_to_install_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(svg, "find_spec", lambda _: None)
    with pytest.raises(CodedError, match=re.escape('pip install "onpath[svg]"')):
        read(DRAWING, "a.svg")
    assert read(TABLE).curve.closed and read(TOOL, "a.nc").curve.closed


def test_a_drawing_of_many_corners_is_not_rounded_one_by_one() -> None:
    angle = np.linspace(0, 6.2, 3 * CORNERED)
    radius = 0.04 + 0.004 * (np.arange(3 * CORNERED) % 2).astype(float)
    star = radius[:, None] * np.column_stack([np.cos(angle), np.sin(angle)])
    with pytest.raises(CodedError, match="corners"):
        path_through(star, Placing(corners="round"))


@pytest.mark.parametrize(
    "options",
    [
        {"scale": 0.0}, {"scale": np.nan}, {"fit": -1.0}, {"fit": np.inf}, {"unit": "parsec"},
        {"corners": "sharp"}, {"centre": (np.nan, 0.0)}, {"radius": 0.02}, {"part": (0,)},
        {"part": (1, 1)}, {"turn": np.nan},
    ],
)  # fmt: skip
def test_impossible_options_are_refused(options: dict[str, Any]) -> None:
    with pytest.raises(ValueError):
        read(TABLE, **options)


# Random files: the same path, a refusal, and never anything else

FILES = {
    "a.csv": TABLE,
    "b.csv": WRITTEN["semicolons, decimal commas"].decode(),
    "a.nc": TOOL,
    "a.svg": DRAWING,
}
PIECES = st.sampled_from(
    ["\x00", "\n", "\r", ",", ";", "\t", " ", '"', "'", "<", ">", "/", "&", "&a;", "<g>", "x"]
    + ["<!DOCTYPE x>", "nan", "inf", "1e999", "-", "+", ".", "e", "9" * 400, "sep=|", "%", "(", ")"]
    + ["M", "L 1 1", "A 0 0 0 0 0 1 1", "c", "G2", "G91", "X", "R0", "Z1", "M3", "G4", "M30", "O1"]
    + ["é", "\ufeff", "\u2212", "\u0663"]
)


@st.composite
def mangled(draw: st.DrawFn) -> tuple[str, bytes]:
    name = draw(st.sampled_from(sorted(FILES)))
    text = FILES[name]
    for _ in range(draw(st.integers(1, 4))):
        at = draw(st.integers(0, len(text)))
        what = draw(st.sampled_from(["insert", "delete", "replace", "repeat", "cut"]))
        length = draw(st.integers(0, 30))
        if what == "insert":
            text = text[:at] + draw(PIECES) + text[at:]
        elif what == "delete":
            text = text[:at] + text[at + length :]
        elif what == "replace":
            text = text[:at] + draw(PIECES) + text[at + length :]
        elif what == "repeat":
            text = text[:at] + text[at : at + length] * draw(st.integers(2, 30)) + text[at:]
        else:
            text = text[:at]
    return name, text.encode(draw(st.sampled_from(["utf-8", "utf-16", "utf-8-sig"])), "replace")


WHOLE = (
    *("error.file_empty", "error.file_no_text", "error.file_no_line", "error.file_too_large"),
    *("error.svg_no_drawing", "error.points_coincide", "error.path_too_short", "error.unknown"),
)
"""Refusals of a whole file, which no line explains."""


@pytest.mark.thorough
@settings(max_examples=400, deadline=2000)
@given(mangled(), st.sampled_from([{}, {"fit": 0.1}, {"corners": "round"}, {"closed": False}]))
@example(("a.svg", DRAWING.replace("C8", "A 0 0 0 0 0").encode()), {})
def test_a_mangled_file_is_a_path_or_a_refusal_with_a_line(
    file: tuple[str, bytes], options: dict[str, object]
) -> None:
    name, data = file
    try:
        found = read(data, name, **options)
    except CodedError as error:
        event(error.message.code)
        where = {"line", "count"} & set(error.message.arguments)
        assert where or error.message.code in WHOLE, str(error)
        return
    event("a path")
    assert np.isfinite(found.curve.coefficients).all() and np.isfinite(found.curve.deviation)
    given_points: Array | None = found.curve.given
    assert given_points is not None and np.abs(given_points).max() <= LARGEST


def test_a_file_of_another_size_or_place_is_read_from_disk(tmp_path: Path) -> None:
    file = tmp_path / "a b.csv"
    file.write_text(TABLE, "utf-8")
    assert same(path_in(file), PLAIN)
    with pytest.raises(CodedError, match=r"larger than 1e-05 MB"):
        path_of(TABLE.encode(), "a.csv", Placing(), most=10)
    with pytest.raises(OSError):
        path_in(tmp_path)


def test_what_a_message_quotes_of_a_file_is_short() -> None:
    long = "1" * 5000
    table = f"x_mm{long},y_mm\n5,a\n"
    texts = (table, f"x_mm,y_mm{long}\n5,a\n", f"circle 0,{long}")
    for text in texts:
        with pytest.raises(CodedError) as refused:
            read(text)
        assert len(str(refused.value)) < 300


def test_a_drawing_that_svgpathtools_fails_on_is_refused() -> None:
    with pytest.raises(CodedError, match="line 2"):
        read('<svg>\n<path d="L 5 40 C 5 15 36 4 55 18 Z"/></svg>', "a.svg", fit=0.1)


@settings(max_examples=8, deadline=None)
@given(order=st.permutations(range(5)), ways=st.lists(st.booleans(), min_size=5, max_size=5))
def test_another_order_or_direction_of_lines_is_told(order: list[int], ways: list[bool]) -> None:
    begins = np.array([[-0.04, 0.01 * row] for row in order])
    lines = [np.linspace(begin, begin + [0.03, 0.0], 9) for begin in begins]
    strokes = [
        Stroke(line[::-1] if way else line, closed=False, straight=False)
        for line, way in zip(lines, ways, strict=True)
    ]
    found = path_of_drawing(LineDrawing(tuple(strokes), ()), Placing())
    curve = found.curve
    assert isinstance(curve, SplineCurve)
    middles = np.array([stroke.points[4] for stroke in strokes])
    theta = curve.nearest(middles)[0]
    along = curve.at(theta, 1)[:, 0] < 0
    kept = bool((np.diff(theta) > 0).all()) and along.tolist() == ways
    assert ("say.reordered" in [each.code for each in found.remarks]) is not kept
