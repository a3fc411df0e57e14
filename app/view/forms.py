"""The settings that a lab, a step or a figure shows, as data for assets/web/parts/form.ts."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any, Literal

from msgspec import Struct

from onpath.lessons.labels import option_label, parameter_help, parameter_label, parameter_unit
from onpath.lessons.words import Words
from onpath.models.control.laws.registry import LAWS, law_named
from onpath.models.control.settable import specs
from onpath.models.systems.parameter_specs import Spec
from onpath.models.systems.parameters import Parameters

Value = float | str | bool
FieldKind = Literal["number", "choice", "switch", "button", "text", "note"]


class FormNeed(Struct, frozen=True, omit_defaults=True):
    """A condition under which a field acts: another one has one of these values.

    Attributes:
        of: none: any but 0, "off" and false.
    """

    name: str
    of: tuple[Value, ...] = ()


class FormOption(Struct, frozen=True, omit_defaults=True, kw_only=True):
    """A value that may be chosen.

    Attributes:
        picture: an outline: a path of SVG in a square from -50 to 50, up is negative.
    """

    value: Value
    label: str
    help: str = ""
    picture: str = ""


class FormField(Struct, frozen=True, omit_defaults=True, kw_only=True):
    """A row of a form. Its value is told by its name; a note's is what it says.

    Attributes:
        help: what one will see, in a sentence.
        low, high, step: range of a number.
        factor: how many of `unit` make one unit of the value.
        on: the number to which a switch sets it, if 0 is off.
        default: to which one goes back; None: there is no way back.
        mark: the value of a lesson's step.
        act: the message that a button sends.
        tone: of a note or a button: "main", "warning" or none.
        section: a heading above all fields of the same section.
    """

    name: str
    kind: FieldKind
    label: str
    symbol: str = ""
    unit: str = ""
    help: str = ""
    low: float = 0.0
    high: float = 0.0
    step: float = 0.0
    factor: float = 1.0
    scale: Literal["linear", "log"] = "linear"
    on: float | None = None
    options: tuple[FormOption, ...] = ()
    needs: tuple[FormNeed, ...] = ()
    default: Value | None = None
    mark: Value | None = None
    act: Mapping[str, Any] | None = None
    tone: str = ""
    section: str = ""


class FormGroup(Struct, frozen=True, omit_defaults=True, kw_only=True):
    """Fields that belong together.

    Attributes:
        level: "first": seen at once; "deeper": to be opened.
        states: names of the fields whose values make its line while it is closed.
        rest: its line while nothing in it is on.
    """

    name: str
    title: str
    fields: tuple[FormField, ...]
    level: Literal["first", "deeper"] = "first"
    states: tuple[str, ...] = ()
    rest: str = ""


class FormMessage(
    Struct, frozen=True, omit_defaults=True, kw_only=True, tag_field="is", tag="form"
):
    """All fields of a place.

    Attributes:
        lacks: what the place lacks, in one line; empty if nothing.
    """

    place: Literal["lab", "step", "figure"]
    groups: tuple[FormGroup, ...]
    lacks: str = ""


class ValuesMessage(Struct, frozen=True, omit_defaults=True, tag_field="is", tag="values"):
    """Values of fields: all of them at first, then those that have changed.

    Attributes:
        refused: why the last value of a setting was refused; empty: it was not.
    """

    values: dict[str, Value]
    refused: dict[str, str] = {}


def acting(kind: type[Parameters], laws: Iterable[str]) -> list[str]:
    """The settings that can act on a robot under some laws, whatever the values of the others."""
    every = {gain for law in LAWS.values() for gain in law.gain_names}
    used = {gain for law in laws for gain in law_named(law).gain_names}
    return [name for name in specs(kind) if name in used or name not in every]


def setting_field(
    name: str,
    spec: Spec,
    words: Words,
    *,
    default: Value,
    mark: Value | None = None,
    section: str = "",
) -> FormField:
    """The field of a declared setting."""
    choice = bool(spec.options)
    return FormField(
        name=name,
        kind="choice" if choice else "number",
        label=parameter_label(name, spec, words),
        unit=parameter_unit(name, spec, words),
        help=parameter_help(name, spec, words),
        low=spec.low,
        high=spec.high,
        step=spec.step,
        on=spec.on,
        options=tuple(
            FormOption(value=option, label=option_label(name, option, words))
            for option in spec.options
        ),
        default=default,
        mark=mark if mark != default else None,
        section=section,
    )


_PLAIN = (*("form.changed", "form.is_on", "form.off", "form.use"),)
_FILLED = {
    "form.back": ("value",),
    "form.back_lesson": ("value",),
    "form.back_group": ("group",),
    "form.count_on": ("count",),
    "form.no_number": ("low", "high"),
    "form.range": ("low", "high"),
    "form.differs": ("value",),
}


def form_words(words: Words) -> dict[str, str]:
    """The messages of every form, in which the page fills in the {names}."""
    messages = {key: words(key) for key in _PLAIN} | {"point": words("report.point")}
    return messages | {
        key: words(key, **{name: f"{{{name}}}" for name in names}) for key, names in _FILLED.items()
    }
