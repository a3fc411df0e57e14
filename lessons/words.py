"""Everything the interface says, in one catalogue per language: assets/words/<language>.toml."""

from __future__ import annotations

import re
import tomllib
from functools import lru_cache
from typing import Any

from onpath.assets import asset_path

DEFAULT = "en"
SENTENCE = "sentence."
ELSEWHERE = (SENTENCE, "parameter.", "machine.", "path.")
"""Beginnings of keys whose English stands in models/, so that other languages alone have them."""


def languages() -> list[str]:
    """Those that there is a catalogue for."""
    return sorted(path.stem for path in asset_path("words").glob("*.toml"))


@lru_cache
def catalogue(language: str) -> dict[str, str]:
    """Dotted key -> words. What a language lacks is in English."""
    own = _flat(tomllib.loads((asset_path("words") / f"{language}.toml").read_text("utf-8")))
    return own if language == DEFAULT else catalogue(DEFAULT) | own


@lru_cache
def sentences(language: str) -> list[tuple[re.Pattern[str], str]]:
    """Sentences of models/ as patterns, and what they are in a language."""
    return [
        (re.compile(re.sub(r"\\{(\w+)\\}", r"(?P<\1>.+?)", re.escape(key[len(SENTENCE) :]))), own)
        for key, own in catalogue(language).items()
        if key.startswith(SENTENCE)
    ]


class Words:
    """What is said in one language.

    Args:
        language: one that there is no catalogue for is answered in English.
    """

    def __init__(self, language: str = DEFAULT) -> None:
        self.language = language if language in languages() else DEFAULT
        self._words = catalogue(self.language)

    def __call__(self, key: str, **values: Any) -> str:
        """The words for a key, with values filled in.

        Raises:
            KeyError: there is no such key.
        """
        return self._words[key].format(**values) if values else self._words[key]

    def get(self, key: str, default: str) -> str:
        """The words for a key, or others."""
        return self._words.get(key, default)

    def sentence(self, english: str) -> str:
        """A sentence that models/ says; as it is where this language has nothing for it."""
        for pattern, own in sentences(self.language):
            if found := pattern.fullmatch(english):
                return own.format(**{k: self.sentence(v) for k, v in found.groupdict().items()})
        return english


def _flat(table: dict[str, Any], prefix: str = "") -> dict[str, str]:
    flat: dict[str, str] = {}
    for key, value in table.items():
        if isinstance(value, dict):
            flat |= _flat(value, f"{prefix}{key}.")  # pyright: ignore[reportUnknownArgumentType]
        else:
            flat[prefix + key] = str(value)
    return flat


ENGLISH = Words()
