"""QR codes of addresses, on a page and in a terminal."""

from __future__ import annotations

import re

import segno
from hypothesis import given
from hypothesis import strategies as st

from onpath.app.common.qr_code import BORDER, qr_code, qr_text

ADDRESS = "http://192.0.2.7:8080/c/m63eyz/"
HALVES = {" ": (0, 0), "▀": (1, 0), "▄": (0, 1), "█": (1, 1)}


@given(st.text("abcdefghijklmnopqrstuvwxyz0123456789:/.-_~%[]", min_size=1, max_size=300))
def test_the_lines_on_the_page_are_the_dark_modules(text: str) -> None:
    code, right = qr_code(text), segno.make_qr(text, error="m").matrix
    drawn = {(int(x), int(float(y))) for x, y in re.findall(r"M(\d+) (\d+\.5)h1", code.lines)}
    dark = {
        (BORDER + x, BORDER + y)
        for y, row in enumerate(right)
        for x, module in enumerate(row)
        if module
    }
    assert drawn == dark and code.size == len(right) + 2 * BORDER


def test_in_a_terminal_light_characters_are_light_modules() -> None:
    lines = qr_text(ADDRESS).splitlines()
    shown = [[HALVES[c][half] for c in line] for line in lines for half in (0, 1)]
    right = segno.make_qr(ADDRESS, error="l").matrix
    light = [[not module for module in row] for row in right]
    inner = [row[2 : 2 + len(right)] for row in shown[2 : 2 + len(right)]]
    assert inner == light
