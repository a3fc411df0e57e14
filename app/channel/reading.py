"""Reads what a page sends."""

from __future__ import annotations

import msgspec

from onpath.app.channel.messages import PageMessage
from onpath.app.lab.commands.command_codec import LONGEST, MOST_WHY, NoCommand, command_from
from onpath.app.lab.lab import Command


class NoPageMessage(ValueError):
    """A text that is no message of a page; it says why."""


def read_message(text: str) -> PageMessage | Command:
    """The message or the command in a text.

    Raises:
        NoPageMessage: there is none.
    """
    if len(text) > LONGEST:
        raise NoPageMessage(f"expected at most {LONGEST} characters, got {len(text)}")
    try:
        if _kind.decode(text).kind is msgspec.UNSET:
            return command_from(text)
        return _messages.decode(text)
    except NoCommand as error:
        raise NoPageMessage(str(error)) from None
    except (ValueError, RecursionError, MemoryError) as error:
        raise NoPageMessage(str(error)[:MOST_WHY]) from None


class _Kind(msgspec.Struct):
    kind: str | msgspec.UnsetType = msgspec.field(name="is", default=msgspec.UNSET)


_kind = msgspec.json.Decoder(_Kind)
_messages = msgspec.json.Decoder(PageMessage)
