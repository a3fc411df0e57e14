"""The messages of a page's data channel, in both directions, and those of a page's life itself.

A message is a JSON object, whose `is` names its kind. The others are defined by subject in the
files `…_messages.py` of this folder. Commands, which have `do` instead, are those of
`app/lab/commands`. `typescript.py` makes `assets/web/channel/messages.ts` from all of them.
Lists of robots have the left one first.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal

import msgspec
from msgspec import UNSET, Meta, Struct

from onpath.app.channel.class_messages import Lead, RemoteMessage, WallMessage
from onpath.app.channel.file_messages import (
    DownloadMessage,
    DownloadPart,
    DropFile,
    FileMessage,
    MakeFile,
    SendFile,
    SendPart,
)
from onpath.app.channel.form_messages import AskForm, FormMessage, SetField, ValuesMessage
from onpath.app.channel.lesson_messages import LessonMessage, MeasuredMessage
from onpath.app.channel.motion_messages import FrameMessage, LogMessage, PathMessage, Plot
from onpath.app.channel.plant_messages import DrivePlant
from onpath.app.channel.sheet_messages import (
    ClassMessage,
    Compared,
    CompareSheet,
    DisplaySheet,
    HelpSheet,
    Index,
    KeepSheet,
    LawSheet,
    LessonSheet,
    Request,
    RobotSheet,
    SeatAnswer,
    Told,
)
from onpath.app.channel.state_messages import StateMessage
from onpath.app.channel.symbol_messages import Light, LitMessage

# From the page


Kept = Annotated[str, Meta(max_length=500)]
"""What a browser has kept; empty if nothing."""


class Hello(
    Struct, frozen=True, kw_only=True, forbid_unknown_fields=True, tag_field="is", tag="hello"
):
    """The first message of a page.

    Attributes:
        page: a random number of its own, by which viser's websocket is known to be the same page's.
        labs: the codes of the browser's labs, newest first, separated by commas.
        teacher: the pass of a teacher of the class at the page's address.
        site: where the browser has opened the site.
        dark: whether the browser asks for dark pages.
        plain: whether it draws in software, so that the scene must be quickly drawn.
        upright: whether its window is so; letters in the scene are larger then.
        speaks, sounds, first_minute: see `Store`.
        drives: the key of the page that drives a plant, as its address had it.
    """

    page: Annotated[str, Meta(pattern="^[0-9a-f]{32,64}$")]
    labs: Kept = ""
    teacher: Kept = ""
    site: Kept = ""
    dark: bool = False
    plain: bool = False
    upright: bool = False
    speaks: Kept = ""
    sounds: Kept = ""
    first_minute: Kept = ""
    drives: Kept = ""


class Seen(Struct, frozen=True, forbid_unknown_fields=True, tag_field="is", tag="seen"):
    """The page is drawn: comes every two seconds. A lab that nobody sees rests."""


class Dark(Struct, frozen=True, forbid_unknown_fields=True, tag_field="is", tag="dark"):
    """The browser now asks for dark pages, or for light ones."""

    on: bool


class Resized(Struct, frozen=True, forbid_unknown_fields=True, tag_field="is", tag="resized"):
    """The canvas has another size: the camera is then fitted to it.

    Attributes:
        upright: see `Hello`.
    """

    upright: bool = False


class Skip(Struct, frozen=True, forbid_unknown_fields=True, tag_field="is", tag="skip"):
    """The user wants no introduction any more."""


PageMessage = (
    Hello
    | Seen
    | Dark
    | Resized
    | Skip
    | AskForm
    | SetField
    | Light
    | Plot
    | SendFile
    | SendPart
    | DropFile
    | MakeFile
    | Lead
    | DrivePlant
    | Request
)
"""What a page sends besides commands; `Hello` comes first, and only once."""


# To the page


class LabCode(Struct, frozen=True, tag_field="is", tag="lab"):
    """The code of the page's lab, which its browser keeps before those of its other labs."""

    code: str


StoredName = Literal["teacher", "speaks", "sounds", "first_minute"]
"""Names of what a browser keeps; see `Store`."""


class Store(Struct, frozen=True, tag_field="is", tag="store"):
    """The browser is to keep a value for `Hello`, or to forget it if it is empty.

    Attributes:
        key: "teacher": a pass, of the class at the page's address; "speaks" and "sounds": "yes" or
            "no"; "first_minute": how many of the invitations it has shown.
    """

    key: StoredName
    value: str


class Wait(Struct, frozen=True, tag_field="is", tag="wait"):
    """The page has no lab yet: the server is full.

    Attributes:
        text: says so to the user.
    """

    text: str


class WordsMessage(Struct, frozen=True, tag_field="is", tag="words"):
    """The page's texts by key; when its language changes."""

    language: str
    words: dict[str, str]


class Alive(Struct, frozen=True, tag_field="is", tag="alive"):
    """Comes whenever nothing else has been told for a second."""


class Refused(Struct, frozen=True, tag_field="is", tag="refused"):
    """A message of the page was refused.

    What a command cannot do is told in `StateMessage.message`.

    Attributes:
        why: in English, for programmers.
    """

    why: str


LabMessage = (
    LabCode
    | Store
    | Wait
    | WordsMessage
    | FrameMessage
    | PathMessage
    | LogMessage
    | LitMessage
    | StateMessage
    | LessonMessage
    | MeasuredMessage
    | FormMessage
    | ValuesMessage
    | FileMessage
    | DownloadMessage
    | DownloadPart
    | Alive
    | Refused
    | RobotSheet
    | LawSheet
    | CompareSheet
    | KeepSheet
    | LessonSheet
    | HelpSheet
    | DisplaySheet
    | Index
    | Compared
    | Told
    | ClassMessage
    | SeatAnswer
    | WallMessage
    | RemoteMessage
)
"""What the server sends."""


BY_CHANGES: tuple[type[Struct], ...] = (StateMessage,)
"""Messages of which, after the first one, only changed fields are sent; see `changes`."""


def changes(message: Struct, before: Struct | None) -> dict[str, Any]:
    """The fields of a message that differ from the one before; empty if there are none."""
    names = message.__struct_fields__
    return {
        name: value
        for name in names
        if (value := getattr(message, name)) != getattr(before, name, UNSET)
    }


def encoded(message: Struct) -> bytes:
    """A message as text."""
    return _encoder.encode(message)


def encoded_changes(kind: type[Struct], fields: Mapping[str, Any]) -> bytes:
    """A message with only the fields that have changed, as text."""
    config = kind.__struct_config__
    return _encoder.encode({config.tag_field: config.tag, **fields})


_encoder = msgspec.json.Encoder(enc_hook=str)  # texts that are safe HTML
