"""The glossary: the lessons' plain words and the corresponding textbook terms."""

from __future__ import annotations

import tomllib
from functools import cache
from typing import Annotated

import msgspec

from onpath.assets import asset_path
from onpath.lessons.action_schema import Data
from onpath.lessons.words import DEFAULT

NonEmpty = Annotated[str, msgspec.Meta(min_length=1)]


class Entry(Data, frozen=True):
    """One idea.

    Attributes:
        plain: the lessons' words.
        term: the technical term.
        means: an explanation in one sentence.
        lesson: number of the lesson that explains it, such as 4 or 4b.
    """

    plain: NonEmpty
    term: NonEmpty
    means: NonEmpty
    lesson: Annotated[str, msgspec.Meta(pattern=r"^[0-9]+[a-z]?$")]


@cache
def glossary(language: str) -> tuple[Entry, ...]:
    """All entries in the order of the lessons; in English if the language has none.

    Raises:
        ValueError: the file assets/glossary/<language>.toml is wrong.
    """
    folder = asset_path("glossary")
    file = folder / f"{language}.toml"
    file = file if file in folder.glob("*.toml") else folder / f"{DEFAULT}.toml"
    read = tomllib.loads(file.read_text("utf-8"))
    return tuple(msgspec.convert(read["entry"], list[Entry]))
