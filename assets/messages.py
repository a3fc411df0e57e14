"""User-visible messages in every language, from the Fluent files words/<language>.ftl."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING

from onpath.assets import asset_path

if TYPE_CHECKING:
    from fluent.runtime import FluentBundle
    from fluent.syntax.ast import Pattern, Resource

DEFAULT = "en"
DECIMAL = re.compile(r"[-+\N{MINUS SIGN}]?\d+\.\d+")


def languages() -> list[str]:
    """Languages that have a catalogue."""
    return sorted(path.stem for path in asset_path("words").glob("*.ftl"))


def preferred(accepted: str) -> str:
    """The language that a browser's Accept-Language header prefers; English if there is none.

    See RFC 9110, 12.5.4: "de-AT, fr;q=0.8" prefers German to French. What is malformed is ignored.
    """
    wanted = list[tuple[float, str]]()
    for entry in accepted.split(","):
        tag, _, weight = entry.partition(";")
        found = re.fullmatch(r"\s*q=(0(?:\.\d{0,3})?|1(?:\.0{0,3})?)\s*", weight or "q=1")
        language = tag.strip().lower().partition("-")[0]
        if found and language in languages():
            wanted.append((float(found[1]), language))
    quality, language = max(wanted, key=lambda each: each[0], default=(0.0, DEFAULT))
    return language if quality > 0.0 else DEFAULT


@lru_cache
def catalogue(language: str) -> Catalogue:
    """The catalogue of a language, cached because parsing takes about a tenth of a second."""
    return Catalogue(language)


@lru_cache(maxsize=4096)
def identifier(key: str) -> str:
    """The Fluent identifier of a key: "lesson.next" -> "lesson-next"."""
    return re.sub(r"[^A-Za-z0-9_-]", "-", key)


class Catalogue:
    """The messages of one language, with English as the fallback.

    Messages that contain only placeholders are formatted by `str.format`, which takes a fifth of
    the time of Fluent's resolver. Messages with variants, such as plurals, are formatted by
    Fluent. Numbers are written without grouping, and text without direction marks.
    """

    def __init__(self, language: str) -> None:
        from fluent.syntax.ast import Message

        self._messages: dict[str, str | _Choice] = {}
        if language != DEFAULT:
            self._messages |= catalogue(DEFAULT)._messages
        for entry in _resource(language).body:
            if isinstance(entry, Message) and entry.value is not None:
                name, template = entry.id.name, _template(entry.value)
                self._messages[name] = _Choice(language, name) if template is None else template

    def __contains__(self, key: str) -> bool:
        return identifier(key) in self._messages

    def keys(self, group: str) -> list[str]:
        """The keys of a group: "help" -> ["help.close", "help.text", …]."""
        begin = f"{group}-"
        return sorted(
            f"{group}.{n.removeprefix(begin)}" for n in self._messages if n.startswith(begin)
        )

    def text(self, key: str, arguments: Mapping[str, object]) -> str:
        """Format a message with its arguments.

        An argument that is a decimal number, such as "0.5", is written with the decimal separator
        of the language.

        Raises:
            KeyError: no such message, or an argument is missing.
        """
        point = self._messages["report-point"]
        if point != "." and arguments:
            arguments = {
                name: value.replace(".", str(point))
                if isinstance(value, str) and DECIMAL.fullmatch(value)
                else value
                for name, value in arguments.items()
            }
        return self._messages[identifier(key)].format_map(arguments)


@lru_cache
def _resource(language: str) -> Resource:
    from fluent.syntax import FluentParser

    text = (asset_path("words") / f"{language}.ftl").read_text("utf-8")
    return FluentParser(with_spans=False).parse(text)


@lru_cache
def _bundle(language: str) -> FluentBundle:
    from fluent.runtime import FluentBundle  # imports Babel, which is slow

    bundle = FluentBundle([language], use_isolating=False)
    bundle.add_resource(_resource(language))
    return bundle


@dataclass(frozen=True)
class _Choice:
    """A Fluent message with variants, with the same `format` method as a string."""

    language: str
    name: str

    def format_map(self, arguments: Mapping[str, object]) -> str:
        from fluent.runtime.types import fluent_number

        values = {
            key: fluent_number(value, useGrouping=False) if isinstance(value, int) else str(value)
            for key, value in arguments.items()
        }
        bundle = _bundle(self.language)
        pattern = bundle.get_message(self.name).value
        assert pattern is not None
        text, errors = bundle.format_pattern(pattern, values)
        if errors:
            raise KeyError(f"{self.name}: {errors[0]}")
        return str(text)


def _template(pattern: Pattern) -> str | None:
    """Template for `str.format`; None if the message has variants."""
    from fluent.syntax.ast import Placeable, StringLiteral, TextElement, VariableReference

    parts = list[str]()
    for element in pattern.elements:
        inner = element.expression if isinstance(element, Placeable) else element
        if isinstance(inner, TextElement | StringLiteral):
            parts.append(inner.value.replace("{", "{{").replace("}", "}}"))
        elif isinstance(inner, VariableReference):
            parts.append(f"{{{inner.id.name}}}")
        else:
            return None
    return "".join(parts)
