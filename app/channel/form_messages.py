"""The fields of a form, and their values: what a page sets, and what it shows."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal

from msgspec import Meta, Struct

from onpath.app.lab.setups.share_code import LONGEST_TEXT

# From the page

FieldText = Annotated[str, Meta(max_length=LONGEST_TEXT)]
"""A law, for instance, or a share code."""


class AskForm(Struct, frozen=True, forbid_unknown_fields=True, tag_field="is", tag="fields"):
    """Tell the form and the values of its fields, from now on."""


class SetField(Struct, frozen=True, forbid_unknown_fields=True, tag_field="is", tag="set"):
    """A field of the form has another value.

    Attributes:
        number: larger than that of all messages before; see `ValuesMessage.heard`.
    """

    name: Annotated[str, Meta(max_length=60)]
    value: bool | Annotated[float, Meta(ge=-1e9, le=1e9)] | FieldText
    number: int


# To the page


FieldValue = float | str | bool
"""The value of a field, in the unit in which it is kept."""


class FormNeed(Struct, frozen=True, omit_defaults=True):
    """A condition under which a field acts: another one has one of these values.

    Attributes:
        of: none: any but 0, "off" and false.
    """

    name: str
    of: tuple[FieldValue, ...] = ()


class FormOption(Struct, frozen=True, omit_defaults=True, kw_only=True):
    """A value that may be chosen.

    Attributes:
        picture: an outline: a path of SVG in a square from -50 to 50, up is negative.
    """

    value: FieldValue
    label: str
    help: str = ""
    picture: str = ""


class FormField(Struct, frozen=True, omit_defaults=True, kw_only=True):
    """A row of a form. Its value is told by its name; a note's is what it says. The value of
    `poles` has a line for each pole: its channel, its real and its imaginary part, [1/s]; that of
    "html" comes from a template that escapes what users have typed.

    Attributes:
        help: what one will see, in a sentence.
        low, high, step: range of a number.
        limit: of a number: the name of the value above which it is unstable.
        factor: how many of `unit` make one unit of the value.
        needs: what it needs in order to act: of each, one suffices.
        on: the number to which a switch sets it, if 0 is off.
        default: to which one goes back; None: there is no way back.
        mark: the value of a lesson's step.
        act: the command that a button sends.
        asks: the question that it asks before it does.
        tone: of a note or a button: "main", "warning" or none; of a note also the side whose colour
            it has, "of_left" or "of_right", or "ranks", below the colours of the rank test's map.
        picture: the address of a button's picture.
        icon: the sign that stands on a button instead of its label.
        section: a heading above all fields of the same section.
    """

    name: str
    kind: Literal["number", "choice", "switch", "button", "text", "note", "poles", "html"]
    label: str
    symbol: str = ""
    unit: str = ""
    help: str = ""
    low: float = 0.0
    high: float = 0.0
    step: float = 0.0
    limit: str = ""
    factor: float = 1.0
    scale: Literal["linear", "log"] = "linear"
    on: float | None = None
    options: tuple[FormOption, ...] = ()
    needs: tuple[tuple[FormNeed, ...], ...] = ()
    default: FieldValue | None = None
    mark: FieldValue | None = None
    act: Mapping[str, Any] | None = None
    asks: str = ""
    tone: str = ""
    section: str = ""
    picture: str = ""
    icon: Literal["", "draw", "undo", "redo"] = ""


class FormGroup(Struct, frozen=True, omit_defaults=True, kw_only=True):
    """Fields that belong together.

    Attributes:
        level: "first": seen at once; "deeper": to be opened.
        states: names of the fields whose values make its line while it is closed.
    """

    name: str
    title: str
    fields: tuple[FormField, ...]
    level: Literal["first", "deeper"] = "first"
    states: tuple[str, ...] = ()


class FormMessage(
    Struct, frozen=True, omit_defaults=True, kw_only=True, tag_field="is", tag="form"
):
    """All fields of a place; without groups, there is no such place now."""

    place: Literal["lab", "step", "figure", "class"]
    groups: tuple[FormGroup, ...]


class ValuesMessage(Struct, frozen=True, omit_defaults=True, tag_field="is", tag="values"):
    """Values of fields: all of them at first, then those that have changed.

    Attributes:
        refused: why the last value of a setting was refused; empty: it was not.
        heard: of each setting of the page, the number of its last message that counts here.
    """

    values: dict[str, FieldValue]
    refused: dict[str, str] = {}
    heard: dict[str, int] = {}


FORMS: tuple[type[Struct], ...] = (FormMessage, ValuesMessage)
"""Messages that the data of pages without a server have, too."""
