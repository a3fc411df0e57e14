"""Everything the interface says, in the language of its user."""

from __future__ import annotations

from functools import cached_property
from typing import Any

from onpath.assets.messages import DEFAULT, Catalogue, catalogue, languages
from onpath.models.errors import Coded, Message

ELSEWHERE = ("parameter.", "machine.", "path.")
"""Beginnings of keys whose English stands in models/, so that other languages alone have them."""


class Words:
    """What is said in one language.

    Args:
        language: one that there is no catalogue for is answered in English.
    """

    def __init__(self, language: str = DEFAULT) -> None:
        self.language = language if language in languages() else DEFAULT
        self._plain = dict[str, str]()

    @cached_property
    def _catalogue(self) -> Catalogue:
        return catalogue(self.language)

    def __call__(self, key: str, **values: Any) -> str:
        """The words for a key, with values filled in; a count as a whole number, for the plural.

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
        """The words for a key, or others."""
        return self(key) if key in self._plain or key in self._catalogue else default

    def sentence(self, said: Message | Exception) -> str:
        """A message, or what an error says; one without a code stays as it is."""
        message = said.message if isinstance(said, Coded) else said
        return message.told(self.language) if isinstance(message, Message) else str(message)


ENGLISH = Words()
