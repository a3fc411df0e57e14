"""Formulas are set in the font that comes with the pages, which has all that the course needs."""

from __future__ import annotations

import re
from html import unescape
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from onpath.app.exports.guide import guide
from onpath.lessons.course import BUILT_IN
from onpath.lessons.words import Words
from tests.support.built_in import built_in_course
from tests.support.waiting import wait_for

if TYPE_CHECKING:
    from playwright.sync_api import Browser

pytestmark = pytest.mark.thorough

WAIT = 30.0  # [s]
LOADED = "[...document.fonts].map(font => [font.family.replace(/['\"]/g, ''), font.status])"
LACKING = """letters => {
    const ink = document.createElement("canvas").getContext("2d")
    const width = (letter, other) => {
        ink.font = `100px "STIX Two Math", ${other}`
        return ink.measureText(letter).width
    }
    return letters.filter(each => width(each, "monospace") !== width(each, "sans-serif"))
}"""
"""Letters that another font draws."""


def test_a_guide_has_the_font_of_its_formulas(browser: Browser, tmp_path: Path) -> None:
    language = "en"  # formulas have no words
    course, _ = built_in_course()
    text = guide(course, BUILT_IN, course.lessons, Words(language))
    file = tmp_path / "guide.html"
    file.write_text(text, encoding="utf-8")
    page = browser.new_page()
    complaints = list[str]()
    page.on("console", lambda message: complaints.append(message.text))
    page.goto(file.as_uri())
    wait_for(lambda: page.evaluate(LOADED) == [["STIX Two Math", "loaded"]], WAIT)
    lessons = "".join(repr(course.lesson(name, language).steps) for name in course.lessons)
    formulas = re.findall(r"<math.*?</math>", text + lessons, re.DOTALL)
    plain = {*unescape(re.sub(r"<[^>]*>", "", "".join(formulas)))} - {*"\n\\"}
    slanted = {*page.evaluate(SLANTED, sorted(plain))}
    assert len(formulas) > 300 and {"θ", "˙", "¨", "𝜃"} <= plain | slanted
    assert page.evaluate(LACKING, sorted(plain | slanted)) == []
    assert page.evaluate(LACKING, ["Ж"]) == ["Ж"]  # the check can fail
    assert complaints == []
    page.close()


SLANTED = """letters => letters.flatMap(each => {
    const code = each.codePointAt(0)
    const from = (first, last, to) =>
        code >= first && code <= last ? [String.fromCodePoint(to + code - first)] : []
    return each === "h" ? ["ℎ"] : [
        ...from(0x41, 0x5a, 0x1d434), ...from(0x61, 0x7a, 0x1d44e),
        ...from(0x391, 0x3a9, 0x1d6e2), ...from(0x3b1, 0x3c9, 0x1d6fc),
    ]
})"""
"""The letters that MathML draws for single ones: slanted."""
