"""Errors and reasons as data: a code, which the catalogues translate, and its arguments."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TypeAlias

from onpath.assets.messages import DEFAULT, catalogue

Argument: TypeAlias = "str | int | Message | tuple[Message, ...]"


@dataclass(frozen=True)
class Message:
    """A message to a user; `str` of it is English.

    Attributes:
        code: a key of the catalogues, such as "fault.crosses".
        arguments: by name. A count is a whole number, so that a language can choose the plural;
            other numbers are formatted as text. Messages in a message are translated
            too, several of them separated by semicolons.
    """

    code: str
    arguments: Mapping[str, Argument] = field(default_factory=dict[str, Argument])

    def __str__(self) -> str:
        return self.text()

    def text(self, language: str = DEFAULT) -> str:
        """The sentence in a language.

        Raises:
            KeyError: no such code, or an argument is missing.
        """
        values = {name: _value(value, language) for name, value in self.arguments.items()}
        return catalogue(language).text(self.code, values)


def _value(value: Argument, language: str) -> str | int:
    if isinstance(value, Message):
        return value.text(language)
    if isinstance(value, tuple):
        return "; ".join(message.text(language) for message in value)
    return value


class Coded(Exception):
    """An error that a user may see; `str` of it is English.

    Args:
        code, arguments: see `Message`.
    """

    def __init__(self, code: str, /, **arguments: Argument) -> None:
        super().__init__(code)
        self.message = Message(code, arguments)

    def __str__(self) -> str:
        return str(self.message)


class CodedError(Coded, ValueError):
    """A user's request cannot be met; see `Coded`."""


def message_of(error: Exception) -> Message | str:
    """The message of an error, as an argument of another message."""
    return error.message if isinstance(error, Coded) else str(error)
