"""Symbols in a lesson's texts are marked where they stand, and nothing else changes."""

from __future__ import annotations

import re
from collections import Counter

import pytest
from markupsafe import Markup

from onpath.lessons.formulas import to_html
from onpath.lessons.safe_html import refused
from onpath.lessons.schema import Lesson, Text
from onpath.lessons.symbols import SYMBOLS, marked_symbols
from onpath.lessons.words import Words
from tests.support.built_in import built_in_course
from tests.support.catalogues import COMPLETE

COURSE, _ = built_in_course()
VERSIONS = [lesson for versions in COURSE.lessons.values() for lesson in versions.values()]
MARK = re.compile(r' data-symbol="(\w+)"')
SPAN = re.compile(r'<span data-symbol="\w+">([^<]*)</span>')


def texts(lesson: Lesson) -> list[Markup]:
    """All texts of the steps."""
    found = list[Markup]()
    for step in lesson.steps:
        found.append(step.watch)
        for block in step.blocks:
            if isinstance(block, Text):
                found.append(block.html)
            for name in ("question", "text", "passed", "answer"):
                found.append(Markup(getattr(block, name, "")))
            for option in getattr(block, "options", ()):
                found += [Markup(option.text), Markup(option.answer)]
    return found


@pytest.mark.parametrize("lesson", VERSIONS, ids=lambda each: f"{each.name} {each.language}")
def test_without_its_marks_a_text_is_as_before(lesson: Lesson) -> None:
    for text in texts(lesson):
        marked = marked_symbols(text, tuple(SYMBOLS))
        assert not list(refused(marked))
        assert MARK.sub("", SPAN.sub(r"\1", marked)) == text
        assert marked_symbols(text, ()) == text


@pytest.mark.parametrize("name", COURSE.lessons)
def test_every_language_marks_the_symbols_that_the_lesson_names(name: str) -> None:
    versions = COURSE.lessons[name]
    found = {
        language: Counter(
            mark
            for text in texts(lesson)
            for mark in MARK.findall(marked_symbols(text, lesson.front.symbols))
        )
        for language, lesson in versions.items()
    }
    first, *others = found.values()
    assert set(first) == {*versions["en"].front.symbols}
    assert all(other == first for other in others)


@pytest.mark.parametrize(
    ("text", "marks"),
    [
        (r"$\ddot\lambda = -K_1\lambda$", ["lambda", "K_1", "lambda"]),
        (r"$\sigma(\theta_r)$", ["sigma", "theta_r"]),
        (r"$\xi_2 + \dot\xi_1$", ["xi_1"]),
        (r"$q_1^2 + q_3$", ["q_1"]),
        (r"$\dot\theta_\mathrm{ref}$", []),
        (r"$|e|^2 e^\top e'$", ["e", "e", "e"]),
        (r"$e^{-K_5 t}$", ["K_5"]),
        ("the letter e, and *e*, the error", ["e"]),
        ("K1 is not K10, K₁ or XK1", ["K_1"]),
        ("`K1` and [K1](https://example.org)", []),
        ("θ, θ̇ and **ξ₁**", ["theta", "theta", "xi_1"]),
    ],
)
def test_what_is_a_symbol_is_marked_and_what_only_looks_like_one_is_not(
    text: str, marks: list[str]
) -> None:
    assert MARK.findall(marked_symbols(to_html(text), tuple(SYMBOLS))) == marks


def test_what_a_symbol_means_is_said_in_every_language() -> None:
    for language in COMPLETE:
        words = Words(language)
        assert len({words(f"symbol.{name}") for name in SYMBOLS}) == len(SYMBOLS)
