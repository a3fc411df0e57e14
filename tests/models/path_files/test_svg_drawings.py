"""SVG drawings as programs write them: which lines they have, and what hostile ones cost."""

from __future__ import annotations

import re
import time
from itertools import pairwise
from random import Random

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from onpath.models.arrays import Array
from onpath.models.errors import CodedError
from onpath.models.path_files.joining import joined
from onpath.models.path_files.reading import drawing_of
from onpath.models.path_files.stroke import LineDrawing, drawn_stroke

pytest.importorskip("svgpathtools")
HEAD = '<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" '
INKSCAPE = 'xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape" '
SIZE = 'width="100mm" height="100mm" viewBox="0 0 100 100"'
LEAF = '<path id="leaf" d="M10 50C10 10 90 10 90 50S10 90 10 50Z"/>'
STYLED = LEAF.replace("/>", ' style="&st;"/>')
LINED = LEAF.replace("/>", ' fill="none" stroke="#123"/>')
SHEET = '<rect width="100%" height="100%" fill="#fffbe6"/>'
WHITE = '<rect width="80" height="100" style="fill:#ffffff"/>'
CLIP = '<clipPath><rect width="100" height="100"/></clipPath>'
CIRCLE = '<circle r="9"/>'


def read(text: str | bytes, layer: str | None = None) -> LineDrawing:
    return drawing_of(text.encode() if isinstance(text, str) else text, "a.svg", layer=layer)


def drawn(body: str, head: str = HEAD + SIZE) -> LineDrawing:
    return read(f"{head}>{body}</svg>".replace("<svg>", "<svg "))


def names(drawing: LineDrawing) -> list[str]:
    return [stroke.name for stroke in drawing.strokes]


def points(drawing: LineDrawing) -> Array:
    return np.vstack([stroke.points for stroke in drawing.strokes])


# The same lines, however they are written

PLAIN = drawn(LEAF)
DOCTYPE = '<!DOCTYPE svg PUBLIC "-//W3C//DTD SVG 1.1//EN" "http://www.w3.org/svg11.dtd"'
SAME = {
    "document type": f"{DOCTYPE}>{HEAD}{SIZE}>{LEAF}</svg>",
    "Illustrator's entities": f'{DOCTYPE} [<!ENTITY ns "http://ns.adobe.com/">'
    f'<!ENTITY st "fill:none;stroke:#000">]>{HEAD}xmlns:x="&ns;" {SIZE}>'
    f"{STYLED}</svg>",
    "default attributes": '<!DOCTYPE svg [<!ATTLIST svg viewBox CDATA "0 0 100 100">]>'
    f'{HEAD}width="100mm" height="100mm">{LEAF}</svg>',
    "size by style": f'{HEAD}style="width:10cm;height:10cm" viewBox="0 0 100 100">{LEAF}</svg>',
    "only one side": f'{HEAD}width="100mm" viewBox="0 0 100 100">{LEAF}</svg>',
    "percent": f'{HEAD}width="100mm" height="100%" viewBox="0 0 100 100">{LEAF}</svg>',
    "use": f'{HEAD}{SIZE}><defs>{LEAF}</defs><use xlink:href="#leaf"/></svg>',
    "use of a symbol": f'{HEAD}{SIZE}><symbol id="s" viewBox="0 0 10 10">'
    f'<g transform="scale(.1)">{LEAF}</g></symbol><use href="#s"/></svg>',
    "transform of a class": f"{HEAD}{SIZE}><style>g > .a, .b .c {{transform: translate(5px, 0)}}"
    f'</style><g transform="translate(-5)"><g class="a">{LEAF}</g></g></svg>',
    "hidden things": f'{HEAD}{SIZE}><g style="display:none"><rect width="90" height="90"/></g>'
    f'<style>.h{{visibility:hidden}}</style><g class="h"><circle r="50"/></g>{LEAF}'
    '<g opacity="0"><circle r="50"/></g>' + CLIP + "</svg>",
    "a sheet of paper": f"{HEAD}{SIZE}>{SHEET}{LEAF}</svg>",
    "a white sheet": f"{HEAD}{SIZE}>{WHITE}{LEAF}</svg>",
    "lines and fills": f'{HEAD}{SIZE}><circle cx="50" cy="50" r="3"/>{LINED}</svg>',
    "invisible": f'{HEAD}{SIZE} fill="none">{LEAF}</svg>',
    "switch": f'{HEAD}{SIZE}><switch><foreignObject requiredExtensions="http://x"/>'
    f"<g>{LEAF}</g></switch></svg>",
}


@pytest.mark.parametrize("way", SAME)
def test_a_drawing_has_the_same_line_however_it_is_written(way: str) -> None:
    found = read(SAME[way])
    assert names(found) == ["leaf"]
    np.testing.assert_allclose(points(found), points(PLAIN), atol=1e-12)


def test_the_box_of_a_drawing_is_shown_as_browsers_show_it() -> None:
    """The smaller scale, centred, and without the first two numbers of the box."""
    box = 'width="200mm" height="100mm" viewBox="-50 -50 100 100"'
    circle = points(drawn('<circle r="40"/>', HEAD + box))
    np.testing.assert_allclose(np.ptp(circle, axis=0), 0.08, atol=1e-4)
    np.testing.assert_allclose(circle.mean(0), (0.1, -0.05), atol=1e-3)


LAYERS = f"""{HEAD}{INKSCAPE}{SIZE} fill="none" stroke="red">
<g inkscape:groupmode="layer" inkscape:label="sketch" style="display:none">{LEAF}</g>
<g inkscape:groupmode="layer" id="layer2" inkscape:label="final"><circle id="o" r="30"/></g>
</svg>"""


def test_hidden_layers_are_drawn_only_if_asked_for() -> None:
    assert names(read(LAYERS)) == ["o"] == names(read(LAYERS, "final"))
    assert names(read(LAYERS, "sketch")) == ["leaf"]
    with pytest.raises(CodedError, match="no layer ink with lines; the layers are sketch, final"):
        read(LAYERS, "ink")


@pytest.mark.parametrize(
    ("body", "words"),
    [
        ("<text>Anna</text>", "convert it to paths"),
        ("<switch><text>Anna</text></switch>", "convert it to paths"),
        ('<foreignObject width="9"/>', "convert it to paths"),
        ('<image href="a.png"/>', "trace it"),
        ('<defs><font><glyph d="M0 0L9 9"/></font></defs>', "is a font"),
    ],
)
def test_what_has_no_lines_is_named_with_what_to_do(body: str, words: str) -> None:
    with pytest.raises(CodedError, match=words):
        drawn(body)
    if "font" in words:
        return
    told = drawn(body + LEAF)
    assert names(told) == ["leaf"] and words.split()[0] in " ".join(map(str, told.remarks))


def test_an_arc_that_ends_where_it_begins_is_none() -> None:
    arc = '<path d="M10 50h30a2.5.2 0 01-0,0 9 9 0 1120 0a1 1 0 0 1 0 0h30"/>'
    plain = '<path d="M10 50h30a9 9 0 1120 0h30"/>'
    np.testing.assert_allclose(points(drawn(arc)), points(drawn(plain)), atol=1e-12)


def test_large_filled_shapes_beside_lines_are_drawn() -> None:
    both = drawn(f'<circle id="o" cx="50" cy="50" r="20"/>{LINED}')
    assert names(both) == ["o", "leaf"] and not both.remarks


def test_filled_shapes_beside_lines_are_told() -> None:
    told = " ".join(map(str, read(SAME["lines and fills"]).remarks))
    assert "small filled shape" in told and "stroke" in told


# Pieces that touch

XY = st.tuples(st.integers(0, 30), st.integers(0, 30))


@given(
    st.lists(XY, min_size=3, max_size=12, unique=True),
    st.booleans(),
    st.randoms(use_true_random=False),
)
def test_pieces_of_a_line_are_one_line_in_any_order_and_direction(
    corners: list[tuple[int, int]], closed: bool, random: Random
) -> None:
    ring = [*corners, corners[0]] if closed else corners
    line = np.array(ring, dtype=float)
    size = float(np.ptp(line, axis=0).max())
    shaken = [
        np.array([a, (a + b) / 2, b]) + random.uniform(-1, 1) * 3e-4 * size
        for a, b in pairwise(line)
    ]
    for shuffled in (False, True):
        pieces = [*shaken]
        if shuffled:
            random.shuffle(pieces)
            pieces = [piece[:: random.choice((1, -1))] for piece in pieces]
        strokes = [drawn_stroke(piece, f"{i}") for i, piece in enumerate(pieces)]
        (found,) = joined(strokes).strokes
        assert found.closed == closed
        if not shuffled:
            assert np.linalg.norm(found.points[0] - line[0]) < 1e-3 * size
        length = np.linalg.norm(np.diff(line, axis=0), axis=1).sum()
        assert found.length == pytest.approx(length, rel=0.02)


def test_where_three_lines_meet_only_what_follows_in_the_file_is_joined() -> None:
    ends = [(1, 0), (0, 1), (-1, 0)]
    star = [drawn_stroke([(0, 0), end], f"{i}") for i, end in enumerate(ends)]
    assert len(joined(star).strokes) == 3
    into = [drawn_stroke([ends[0], (0, 0)], "in"), *star[1:]]
    assert [line.name for line in joined(into).strokes] == ["in", "2"]
    assert joined(into).strokes[0].points[-1].tolist() == [0, 1]


def test_a_line_that_is_repeated_is_drawn_once_and_this_is_told() -> None:
    there, back = "M0 0L9 0L9 5", "M9 5L9 0L0 0"
    found = drawn("".join(f'<path d="{d}"/>' for d in (there, there, back)))
    assert len(found.strokes) == 1 and not found.strokes[0].closed
    assert "2 lines repeat others" in str(found.remarks[0])


def test_specks_are_left_out_and_told() -> None:
    dots = "".join(f'<circle cx="{9 * i}" r=".05"/>' for i in range(3))
    found = drawn(LEAF + dots)
    assert names(found) == ["leaf"] and "3 specks" in str(found.remarks[0])
    assert len(drawn(dots).strokes) == 3  # of a larger drawing they are


# Hostile drawings cost little, and are refused in words

DEEP = "".join(f'<g id="g{i}">' + f'<use href="#g{i + 1}"/>' * 10 + "</g>" for i in range(30))
HOSTILE = {
    "laughs": (
        "<!DOCTYPE svg [<!ENTITY a 'ha'>"
        + "".join(
            f"<!ENTITY {x} '&{y};&{y};&{y};'>" for x, y in zip("bcdefg", "abcdef", strict=True)
        )
        + "]><svg id='&g;'/>",
        "line 1: the entity b does not stand for plain text",
    ),
    "growth": (
        f"<!DOCTYPE svg [<!ENTITY a '{'x' * 9999}'>]><svg>"
        + "<g id='&a;&a;&a;'/>" * 9999
        + "</svg>",
        "line 1: entities make the drawing much longer than the file",
    ),
    "a file": (
        "<!DOCTYPE svg [<!ENTITY a SYSTEM 'file:///etc/passwd'>]><svg>&a;</svg>",
        "entity a",
    ),
    "parameters": ("<!DOCTYPE svg [<!ENTITY % p 'x'> %p;]><svg/>", "line 1: the entity p"),
    "markup": ("<!DOCTYPE svg [<!ENTITY a '&#60;g/>'>]><svg>&a;</svg>", "the entity a"),
    "uses of uses": (f"{HEAD}>{DEEP}</svg>", "line 1: the drawing has more than"),
    "a use of itself": (f'{HEAD}><g id="a"><use href="#a"/></g></svg>', "nested in each other"),
    "two that use each other": (
        f'{HEAD}><use id="a" href="#b"/><use id="b" href="#a"/></svg>',
        "nested in each other",
    ),
    "many rules": (
        f"{HEAD}><style>{'*{fill:red}' * 9999}</style>{'<g/>' * 9999}</svg>",
        "too many rules",
    ),
    "long selectors": (
        f"{HEAD}><style>{('* ' * 500 + 'g{fill:red}') * 50}</style>"
        f"{('<g>' * 30 + '</g>' * 30) * 600}</svg>",
        "too many rules",
    ),
    "many points": (f"{HEAD}>{CIRCLE * 9999}</svg>", "more than 100000 points"),
    "an overflow": (f'{HEAD}><g transform="scale(1e300)"><circle r="1e300"/></g></svg>', "line 1"),
    "a wrong transform": (f'{HEAD}>\n<g transform="turn(3)"/></svg>', "line 2: this g"),
    "a wrong length": (f'{HEAD}>\n<circle r="3 parsec"/></svg>', "line 2: this circle"),
    "wrong points": (f'{HEAD}>\n<polyline points="1 2 x"/></svg>', "line 2: this polyline"),
}


@pytest.mark.thorough
@pytest.mark.parametrize("case", HOSTILE)
def test_a_hostile_drawing_is_refused_in_words_and_soon(case: str) -> None:
    text, words = HOSTILE[case]
    begin = time.process_time()
    with pytest.raises(CodedError, match=re.escape(words)):
        read(text)
    assert time.process_time() - begin < 20


@pytest.mark.parametrize(
    "sheet", ["{" * 9999, "@media x{" * 999, "g{fill:" + "(" * 9999, "a,b{}}<!--"]
)
def test_a_style_sheet_that_is_none_has_no_effect(sheet: str) -> None:
    style = f"<style><![CDATA[{sheet}]]></style>"
    assert names(drawn(style + LEAF)) == ["leaf"]
