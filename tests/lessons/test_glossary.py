"""The glossary says the same in all languages, and the help shows it in both directions."""

from __future__ import annotations

import re

import pytest
from markupsafe import escape

from onpath.app.page.panels.glossary import glossary_html
from onpath.lessons.course import BUILT_IN
from onpath.lessons.glossary import glossary
from onpath.lessons.words import Words, languages
from tests.support.catalogues import COMPLETE

TRANSLATED = [language for language in COMPLETE if language != "en"]


@pytest.mark.parametrize("language", languages())
def test_every_language_has_the_same_entries(language: str) -> None:
    own, english = glossary(language), glossary("en")
    assert [entry.lesson for entry in own] == [entry.lesson for entry in english]
    assert len({entry.plain for entry in own}) == len({entry.term for entry in own}) == len(own)
    assert language not in TRANSLATED or own != english
    symbols = re.compile(r"[Γηξθϖσα]\S?|Φ\S*|\d+")
    for one, other in zip(own, english, strict=True):
        assert symbols.findall(one.means) == symbols.findall(other.means)


def test_every_entry_belongs_to_an_existing_lesson() -> None:
    numbers = {home.name.split("-")[0].lstrip("0") for home in BUILT_IN.glob("[0-9]*")}
    assert {entry.lesson for entry in glossary("en")} <= numbers


def test_a_language_without_a_glossary_has_the_english_one() -> None:
    assert glossary("../words/en") == glossary("xx") == glossary("en")


@pytest.mark.parametrize("language", languages())
def test_the_help_shows_both_directions(language: str) -> None:
    page = glossary_html(Words(language))
    terms, plain = (
        [str(escape(getattr(e, kind))) for e in glossary(language)] for kind in ("term", "plain")
    )
    headings = re.findall(r"<dt[^>]*>(.*?)</dt>", page)
    assert headings[: len(plain)] == plain
    assert sorted(headings[len(plain) :]) == sorted(terms)
    assert page.count("<details>") == 2
