"""G-code as programs write it: what the tool draws, what is travel, and what has no effect."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from onpath.models.arrays import Array
from onpath.models.errors import CodedError
from onpath.models.path_files.gcode import strokes_of_gcode
from onpath.models.path_files.reading import drawing_of

Lines = list[list[tuple[float, float]]]


def dots(points: list[tuple[float, float]]) -> str:
    return "\n".join(f"G1 X{x:g} Y{y:g}" for x, y in points[1:])


def written(
    lines: Lines, down: str, up: str, head: str = "", tail: str = "", *, travel: str = "G0"
) -> str:
    """G-code that travels to each line, lowers the tool, draws and raises it."""
    text = head + "\n"
    for line in lines:
        (x, y), *_ = line
        text += f"{travel} X{x:g} Y{y:g}\n{down}\n{dots(line)}\n{up}\n"
    return text + tail


def printed(lines: Lines, *, relative: bool, layers: int = 1, marks: str = "") -> str:
    """What a slicer writes: material comes only while it draws."""
    text, e = "M104 S200\nM109 S200\nG28 ; home\nG90\n", 0.0
    text += "M83\n" if relative else "M82\nG92 E0\n"
    for layer in range(layers):
        text += marks.format(layer) + f"\nG1 Z{0.2 * (layer + 1):g} F300\n"
        for line in lines:
            (x, y), *rest = line
            text += f"G0 X{x + layer:g} Y{y:g}\n"
            for x, y in rest:
                e = 0.5 if relative else e + 0.5
                text += f"G1 X{x + layer:g} Y{y:g} E{e:g}\n"
            text += "G1 E-2\n" if relative else f"G1 E{e - 2:g}\n"
    return text + "M107\nM84 X Y E\n"


WAYS: dict[str, Callable[[Lines], str]] = {
    "G0": lambda z: written(z, "", ""),
    "mill": lambda z: written(z, "G1 Z-1 F100", "G0 Z5", "G21 G90 G17\nM3 S9000\nG0 Z5", "M5\nM30"),
    "mill that feeds to its lines": lambda z: written(
        z, "G1 Z-1", "G1 Z5", "M3 S9000\nG0 Z5", travel="G1"
    ),
    "mill with one height a line": lambda z: written(z, "G1 Z-1", "G1 Z0", "G1 Z0", travel="G1"),
    "laser by M5": lambda z: written(z, "M3 S200", "M5", "G21\nM5", "G1 X0 Y0\nM2", travel="G1"),
    "laser by S0": lambda z: written(z, "S200", "S0", "M4 S0", "M5", travel="G1"),
    "laser of a fan": lambda z: written(z, "M106 S255", "M107", travel="G1"),
    "pen by height": lambda z: written(z, "G1 Z0", "G1 Z3", "G1 Z3", "G1 X0 Y0", travel="G1"),
    "pen whose height counts downwards": lambda z: written(z, "G0 Z5", "G0 Z1", "G0 Z1"),
    "pen above the machine's zero": lambda z: written(z, "G1 Z-9", "G1 Z-2", "G1 Z-2", travel="G1"),
    "servo": lambda z: written(
        z, "M280 P0 S40\nG4 P150", "M280 P0 S90", "M280 P0 S90", "G1 X0 Y0", travel="G1"
    ),
    "servo that is switched off": lambda z: written(
        z, "M300 S30", "M300 S50", "M300 S50", "M300 S255\nG1 X0 Y0\nM18", travel="G1"
    ),
    "laser whose power is set at the machine": lambda z: written(
        z, "M3 S0", "M5 S0", "M5", travel="G1"
    ),
    "servo with G0": lambda z: written(z, "M300 S30", "M300 S50", "M300 S50", "G0 X0 Y0\nM18"),
    "servo of a spindle": lambda z: written(z, "M3 S30", "M3 S90", "M3 S90", "G0 X0 Y0"),
    "printer": lambda z: printed(z, relative=False),
    "printer with relative material": lambda z: printed(z, relative=True),
    "plunges that repeat X and Y": lambda z: written(
        [[line[0], *line] for line in z], "G1 Z-1", "G1 Z5", "G0 Z5"
    ),
    "GRBL's state": lambda z: (
        "$H\n$X\n" + written(z, "", "", travel="").replace("G1", "G1 F300", 1)
        if len(z) == 1
        else written(z, "", "")
    ),
}
XY = st.tuples(st.integers(-40, 40), st.integers(-40, 40))


def apart(lines: list[list[tuple[int, int]]]) -> Lines:
    """Lines without moves that are none, on which the place of travel has no part."""
    kept = Lines()
    for i, line in enumerate(lines):
        points = [(float(x + 200 * (i + 1)), float(y + 100)) for x, y in line]
        kept.append([a for a, b in zip(points, [None, *points], strict=False) if a != b])
    return [line for line in kept if len(line) > 1]


@pytest.mark.parametrize("way", WAYS)
@given(st.lists(st.lists(XY, min_size=2, max_size=5), min_size=1, max_size=4))
def test_a_tool_draws_the_lines_and_travel_is_travel(
    way: str, given_lines: list[list[tuple[int, int]]]
) -> None:
    lines = apart(given_lines)
    if not lines:
        return
    strokes, _ = strokes_of_gcode(WAYS[way](lines))
    assert len(strokes) == len(lines)
    for stroke, line in zip(strokes, lines, strict=True):
        np.testing.assert_allclose(stroke.points, 1e-3 * np.array(line), atol=1e-12)


@pytest.mark.parametrize("marks", ["", ";LAYER:{}", ";LAYER_CHANGE\n;Z:{}", "; CHANGE_LAYER"])
@pytest.mark.parametrize("relative", [False, True])
def test_of_a_print_one_layer_is_drawn(marks: str, relative: bool) -> None:
    lines: Lines = [[(0.0, 0.0), (9.0, 0.0), (9.0, 5.0)], [(20.0, 0.0), (20.0, 9.0)]]
    begun = "G1 X1 Y1 Z3 E4\nG1 X2 E9\n" if marks else ""
    text = begun + printed(lines, relative=relative, layers=3, marks=marks)
    for layer, at in ((None, 0), ("1", 0), ("3", 2)):
        strokes, remarks = strokes_of_gcode(text, layer)
        assert [stroke.points[0, 0] for stroke in strokes] == pytest.approx(
            [1e-3 * at, 1e-3 * (20 + at)]
        )
        assert f"prints 3 layers, of which layer {at + 1}" in str(remarks[0])
    for wrong in ("4", "0", "x", "1.5", "9" * 30):
        with pytest.raises(CodedError, match="the layers are 1 … 3"):
            strokes_of_gcode(text, wrong)


def circle(text: str) -> Array:
    (stroke,), _ = strokes_of_gcode("M3 S9000\nG0 Z5\nG0 X10 Y0\n" + text)
    return stroke.points


def test_ramps_and_helices_are_their_view_from_above() -> None:
    flat = circle("G1 Z-1\nG3 X10 Y0 I-10 J0 K0\nG0 Z5")
    for helix in ("G3 X10 Y0 Z-1 I-10 J0 K0.5", "G91\nG3 X0 Y0 Z-6 I-10", "G3 Z-1 I-10 P1"):
        np.testing.assert_allclose(circle(f"{helix}\nG90\nG0 Z5"), flat, atol=1e-9)
    absolute = circle("G90.1\nG1 Z-1\nG3 X10 Y0 I0 J0\nG0 Z5")
    np.testing.assert_allclose(absolute, flat, atol=1e-9)
    ramp = circle("G1 X20 Z-1\nG1 X30\nG0 Z5")
    np.testing.assert_allclose(ramp, [[0.01, 0], [0.02, 0], [0.03, 0]], atol=1e-12)


def test_passes_at_several_depths_are_drawn_once() -> None:
    ring = "G1 X9\nY9\nX0\nY0\n"
    text = (
        "M3\nG0 Z5\nG0 X0 Y0\n" + "".join(f"G1 Z-{depth}\n{ring}" for depth in (1, 2, 3)) + "G0 Z5"
    )
    found = drawing_of(text.encode(), "a.nc")
    assert len(found.strokes) == 1 and found.strokes[0].closed
    assert "2 lines repeat others" in " ".join(map(str, found.remarks))


def test_a_stated_place_moves_the_coordinates_and_not_the_tool() -> None:
    moved = "G0 X10 Y5\nG92 X0 Y0\nG1 X3 Y4\nG92.1\nG1 X20 Y9\n"
    (stroke,), _ = strokes_of_gcode(moved)
    np.testing.assert_allclose(1e3 * stroke.points, [[10, 5], [13, 9], [20, 9]], atol=1e-9)


def test_what_has_no_effect_is_listed_shortly() -> None:
    text = "\n".join(f"M{code} S1" for code in range(500, 520)) + "\nM117 a text: 1, 2 (x)\n"
    text += ";" + "x" * 5000 + "\nG31 X50 Z-3\n"
    macros = "SET_VELOCITY_LIMIT ACCEL=3000\nG4 X3\nN5 G1 X3 Y4*87\n/G1 X5\n"
    strokes, (remark,) = strokes_of_gcode(text + macros)
    assert len(strokes) == 1 and len(strokes[0].points) == 3
    assert "M500, M501" in str(remark) and "and 12 more." in str(remark)
