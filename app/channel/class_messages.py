"""What a teacher's page says to its class, besides `SetField` with the names of its fields, and
what its wall is told."""

from __future__ import annotations

from typing import Annotated, Literal

from msgspec import Meta, Struct

Order = Literal[
    "freeze",
    "thaw",
    "send_setup",
    "stop",
    "own_lab",
    "back",
    "next",
    "close_votes",
    "timer",
    "open_votes",
    "ask_again",
    "play",
    "put_back",
    "send_step",
    "send_route",
    "set_aside",
    "give_place",
    "keep_apart",
    "remove",
    "delete",
    "end_standing",
    "keep",
    "let_go",
    "record",
    "end",
    "forget",
    "let_in",
    "throw_out",
]
"""What a button of the teacher's page does; see `TeacherOrders`."""


class Lead(Struct, frozen=True, forbid_unknown_fields=True, tag_field="is", tag="lead"):
    """An order of a teacher to the class; refused from any other page.

    Attributes:
        member: number of the student whom it concerns, or of the phone.
    """

    do: Order
    member: Annotated[int, Meta(ge=0)] = 0


class WallMessage(Struct, frozen=True, tag_field="is", tag="wall"):
    """What the class's wall shows besides the robots, whenever it changes. It has no names and,
    until the teacher shows the answers, nothing that depends on them.

    Attributes:
        join: how students join: address, QR code and class code, as HTML.
        asked: what the class is asked and, once they are shown, its answers, as HTML.
        closing: seconds until the vote is closed; null if it is not being closed.
        note: that the vote is closed; else empty.
    """

    join: str
    asked: str
    closing: int | None
    note: str


class RemoteMessage(Struct, frozen=True, tag_field="is", tag="remote"):
    """What a remote control is told besides the form of the class, whenever it changes.

    Attributes:
        number: that it shows until it is let in; empty once it is.
        text: what to do with the number.
        votes: whether a vote is open, so that the phone is to stay awake.
    """

    number: str
    text: str
    votes: bool
