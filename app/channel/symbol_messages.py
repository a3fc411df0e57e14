"""Where a lesson's symbol is found on the robots."""

from __future__ import annotations

from typing import Literal

from msgspec import Struct

JointSymbol = Literal["q_1", "q_2", "delta", "rho"]
"""The symbols of lessons whose meaning depends on the kind of robot."""


# From the page


class Light(Struct, frozen=True, forbid_unknown_fields=True, tag_field="is", tag="light"):
    """Tell where a symbol is found on the robots, until another one is asked for.

    Attributes:
        symbol: "bars" for the ends of all bars, two for each; empty to be told nothing more.
    """

    symbol: JointSymbol | Literal["bars", ""]


# To the page


class LitMessage(Struct, frozen=True, tag_field="is", tag="lit"):
    """Where the symbol is found that is asked for, whenever the robots have moved, at most 20
    times a second.

    Attributes:
        symbol: what is asked for.
        lines: for each robot the points of a line, or one point for a joint, in 10 µm of the output
            space.
    """

    symbol: str
    lines: list[list[list[int]]]
