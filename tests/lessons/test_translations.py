"""A lesson tells and shows the same in every language: only its words differ."""

from __future__ import annotations

import re
from collections import Counter, defaultdict
from pathlib import Path

import pytest

from onpath.lessons.course import BUILT_IN
from onpath.lessons.words import ENGLISH, Words, languages
from onpath.models.control.settable import specs
from onpath.models.systems.catalogue import ROBOTS
from tests.support.catalogues import COMPLETE, arguments, messages
from tests.support.stated_numbers import numbers

LESSONS = sorted({file.parent for file in BUILT_IN.glob("*/en.md")})
TRANSLATED = sorted(file for file in BUILT_IN.glob("*/*.md") if file.stem != "en")
FORMULA = re.compile(r"\$\$(.+?)\$\$|\$([^$\n]+)\$", re.DOTALL)
PICTURE = re.compile(r"!\[[^]]*]\(([^)]+)\)")
BOLD = re.compile(r"\*\*(.+?)\*\*")
WRITTEN = re.compile(r"(<text[^>]*>)([^<]*)")
LAYOUT = re.compile(r"^(```\w*|\||- |#+ \w+:|\+\+\+|\$\$)", re.MULTILINE)

both = pytest.mark.parametrize("file", TRANSLATED, ids=lambda file: file.parent.name)


def steps(file: Path) -> list[tuple[str, str]]:
    """Steps of the English lesson and of its translation, side by side."""
    texts = [each.read_text(encoding="utf-8") for each in (file.with_name("en.md"), file)]
    english, other = ([f"# {step}" for step in text.split("\n# ")] for text in texts)
    return list(zip(english, other, strict=True))


def formulas(step: str) -> Counter[str]:
    """Formulas without their words, with decimal points."""
    found = ("".join(groups) for groups in FORMULA.findall(step))
    return Counter(
        re.sub(r"\\(text|operatorname)\{[^}]*}", "", each.replace("{,}", ".")) for each in found
    )


def test_every_lesson_is_written_in_every_complete_language() -> None:
    written = {lesson.name: {file.stem for file in lesson.glob("*.md")} for lesson in LESSONS}
    assert len(written) >= 9
    assert [name for name, each in written.items() if not each.issuperset(COMPLETE)] == []
    assert set[str]().union(*written.values()) <= {*languages()}


@both
def test_every_step_tells_the_same_numbers(file: Path) -> None:
    for english, other in steps(file):
        assert Counter(numbers(english)) == Counter(numbers(other)), other.splitlines()[0]


@both
def test_every_step_has_the_same_formulas(file: Path) -> None:
    for english, other in steps(file):
        assert formulas(english) == formulas(other), other.splitlines()[0]


@both
def test_every_step_is_laid_out_the_same(file: Path) -> None:
    for english, other in steps(file):
        assert LAYOUT.findall(english) == LAYOUT.findall(other), other.splitlines()[0]


@both
def test_pictures_differ_only_in_their_words(file: Path) -> None:
    for pair in steps(file):
        pictures = [PICTURE.findall(step) for step in pair]
        for english, other in zip(*pictures, strict=True):
            drawn = [(file.parent / each).read_text(encoding="utf-8") for each in (english, other)]
            assert WRITTEN.sub(r"\1", drawn[0]) == WRITTEN.sub(r"\1", drawn[1]), other
            told = [
                [sorted(numbers(words)) for _, words in WRITTEN.findall(each)] for each in drawn
            ]
            assert told[0] == told[1], other


@both
def test_what_the_page_shows_is_called_as_on_the_page(file: Path) -> None:
    """A button, slider or folder that is bold in English is bold in the other language, too."""
    names = labels(file.stem)
    for english, other in steps(file):
        for name in set(BOLD.findall(english)) & names.keys():
            assert names[name] & set(BOLD.findall(other)), f"{name}: {names[name]}"


def labels(language: str) -> dict[str, set[str]]:
    """English words of the page -> what they may be in a language."""
    words, found = Words(language), defaultdict[str, set[str]](set)
    for name, message in messages("en").items():
        if not arguments(message):
            key = name.replace("-", ".")
            found[ENGLISH(key)].add(words(key))
    for robot in ROBOTS.values():
        for name, spec in specs(robot.parameters).items():
            found[spec.label].add(words.get(f"parameter.{name}.label", spec.label))
    return found
