"""The texts of the interface in the user's language."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cached_property
from typing import Any

from onpath.assets.messages import DEFAULT, Catalogue, catalogue, languages
from onpath.models.errors import Coded, Message

ELSEWHERE = ("parameter.", "machine.", "path.", "law.")
"""Prefixes of keys whose English texts are in models/; only catalogues of other languages have
them."""


class Words:
    """The texts of one language. Objects of the same language are equal, so that caches share them.

    Args:
        language: code of the language; English if there is no catalogue for it.
    """

    def __init__(self, language: str = DEFAULT) -> None:
        self.language = language if language in languages() else DEFAULT
        self._plain = dict[str, str]()

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Words) and other.language == self.language

    def __hash__(self) -> int:
        return hash(self.language)

    @cached_property
    def _catalogue(self) -> Catalogue:
        return catalogue(self.language)

    def __call__(self, key: str, **values: Any) -> str:
        """The text of a key with values filled in; a count must be an integer, for the plural.

        Raises:
            KeyError: there is no such key, or a value is missing.
        """
        if values:
            return self._catalogue.text(key, values)
        try:
            return self._plain[key]
        except KeyError:
            return self._plain.setdefault(key, self._catalogue.text(key, values))

    def get(self, key: str, default: str) -> str:
        """The text of a key, or a default."""
        return self(key) if key in self._plain or key in self._catalogue else default

    def unfilled(self, keys: Mapping[str, Sequence[str]]) -> dict[str, str]:
        """The texts of keys in which a page fills in the {names} of each."""
        return {
            key: self(key, **{name: f"{{{name}}}" for name in names}) for key, names in keys.items()
        }

    def number(self, value: float, digits: int = 4) -> str:
        """A number with some significant digits and the decimal separator of the language."""
        text = f"{float(f'{value:.{digits}g}') + 0.0:g}"
        return self.written(text.replace("-", "−"))

    def written(self, number: str) -> str:
        """A written number with the decimal separator of the language in place of the point."""
        return number.replace(".", self("report.point"))

    def sentence(self, source: Message | Exception) -> str:
        """The text of a message or an error; an error without a code is not translated."""
        message = source.message if isinstance(source, Coded) else source
        return message.text(self.language) if isinstance(message, Message) else str(message)


def language_name(language: str) -> str:
    """The name of a language in that language; its code if its catalogue has none."""
    return Words(language).get(f"language.{language}", language)


ENGLISH = Words()
