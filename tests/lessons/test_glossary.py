"""The glossary says the same in all languages, and the help shows it in both directions."""

from __future__ import annotations

import re

import pytest

from onpath.app.view.help import help_sheet
from onpath.lessons.course import BUILT_IN
from onpath.lessons.glossary import glossary
from onpath.lessons.schema import Text
from onpath.lessons.words import Words, languages
from tests.support.built_in import built_in_course
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


SEPARATES = re.compile(r"[;,():{}]")
SYMBOL = re.compile(r"[Γηξθϖσαζ]")
FOLDED = re.compile(r"<details>.*?</details>", re.DOTALL)


@pytest.mark.parametrize("language", COMPLETE)
def test_a_term_is_explained_where_it_is_first_used(language: str) -> None:
    """Outside folds, a term is emphasised at its first use, or stands after its lesson."""
    course, _ = built_in_course()
    places = [
        (lesson.name, step.title, FOLDED.sub("", block.html))
        for lesson in (versions[language] for versions in course.lessons.values())
        for step in lesson.steps
        for block in step.blocks
        if isinstance(block, Text)
    ]
    after, found = list(course.numbers().values()), 0
    for entry in glossary(language):
        for term in filter(None, map(str.strip, SEPARATES.split(entry.term))):
            word = re.compile(rf"\b{re.escape(term)}", re.IGNORECASE)
            used = next((place for place in places if word.search(place[2])), None)
            if used is None or len(term) < 3 or SYMBOL.search(term):
                continue
            found += 1
            emphasised = re.search(rf"<(em|strong)>[^<]*{word.pattern}", used[2], re.IGNORECASE)
            number = course.numbers()[used[0]]
            assert emphasised or after.index(number) > after.index(entry.lesson), (term, *used[:2])
    assert found > 20


def test_a_language_without_a_glossary_has_the_english_one() -> None:
    assert glossary("../words/en") == glossary("xx") == glossary("en")


@pytest.mark.parametrize("language", languages())
def test_the_help_has_every_entry_with_its_lesson(language: str) -> None:
    shown = help_sheet(Words(language)).glossary
    assert [(each.plain, each.term, each.means) for each in shown] == [
        (each.plain, each.term, each.means) for each in glossary(language)
    ]
    for each, entry in zip(shown, glossary(language), strict=True):
        assert entry.lesson in each.lesson
