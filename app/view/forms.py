"""The settings that a lab, a step or a figure shows, as data for assets/web/parts/form.ts."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

from msgspec import structs

from onpath.app.channel.form_messages import FieldValue, FormField, FormNeed, FormOption
from onpath.lessons.labels import option_label, parameter_help, parameter_label, parameter_unit
from onpath.lessons.words import Words
from onpath.models.closed_loop.lab_settings import SETTINGS
from onpath.models.control.laws.registry import LAWS, law_named
from onpath.models.control.settable import specs
from onpath.models.robot_files.guesses import Guess
from onpath.models.systems.guessed_numbers import setting_with_mark
from onpath.models.systems.parameter_specs import Need, Spec
from onpath.models.systems.parameters import Parameters

ELSEWHERE = ("rate", "presenting")
"""Settings that are not in the lab's form: one is beside its plots, one among the page's own."""


def settings_in_form(kind: type[Parameters], laws: Iterable[str]) -> list[str]:
    """The settings in a lab's form: those that can act on a robot under some laws, whatever the
    values of the others.

    Args:
        kind: of the robot's parameters.
    """
    every = {gain for law in LAWS.values() for gain in law.gain_names}
    used = {gain for law in laws for gain in law_named(law).gain_names}
    acts = [name for name in specs(kind) if name in used or name not in every]
    known = {*acts, *SETTINGS}
    for name, setting in SETTINGS.items():
        needs = [{one.name for one in _instead(need)} for need in setting.spec.needs]
        if name not in ELSEWHERE and all(names & known for names in needs):
            acts.append(name)
    return acts


def setting_field(
    name: str,
    spec: Spec,
    words: Words,
    *,
    default: FieldValue,
    mark: FieldValue | None = None,
    options: Sequence[Any] = (),
    section: str = "",
    guesses: Sequence[Guess] = (),
) -> FormField:
    """The field of a declared setting.

    Args:
        options: those of a choice that a page has; by default all.
        guesses: about the robot; a setting that rests on them is marked.
    """
    unit, factor = spec.shown_in or (parameter_unit(name, spec, words), 1.0)
    offered = options or (spec.options if spec.kind == "choice" else ())
    return FormField(
        name=name,
        kind=spec.kind,
        label=setting_with_mark(parameter_label(name, spec, words), guesses, name, words.language),
        symbol=spec.symbol,
        unit=unit,
        help=parameter_help(name, spec, words),
        low=spec.low,
        high=spec.high,
        step=spec.step,
        factor=factor,
        scale=spec.scale,
        on=spec.on,
        options=tuple(
            FormOption(value=each, label=option_label(name, each, words)) for each in offered
        ),
        needs=tuple(tuple(_instead(need)) for need in spec.needs),
        default=default,
        mark=mark if mark != default else None,
        section=section,
    )


def _instead(need: Need) -> Iterator[FormNeed]:
    """The conditions that a need consists of; any one suffices."""
    yield FormNeed(name=need.name, of=need.of)
    for other in need.instead:
        yield from _instead(other)


def with_limit(alpha: FormField) -> tuple[FormField, FormField]:
    """The field of α on a page that knows its critical value, and the note that says it."""
    note = FormField(name="alpha_note", kind="note", label="", needs=alpha.needs)
    return structs.replace(alpha, limit="critical_alpha"), note


def drawing_field(name: str, words: Words, mark: bool | None = None) -> FormField:
    """The field of something that is drawn besides the robots."""
    key = f"show.{name}"
    return FormField(
        name=name,
        kind="switch",
        label=words(key),
        help=words(f"{key}_hint"),
        default=False,
        mark=mark or None,
    )


def choice_field(
    name: str, label: str, options: Mapping[str, FieldValue], *, default: FieldValue
) -> FormField:
    """The field of a choice among things with names of their own: paths, laws.

    Args:
        options: label -> value.
    """
    offered = tuple(FormOption(value=value, label=text) for text, value in options.items())
    return FormField(name=name, kind="choice", label=label, options=offered, default=default)


_PLAIN = (
    *("form.changed", "form.is_on", "form.off", "form.use"),
    *("gains.across", "gains.along", "gains.rate", "gains.swing"),
)
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
    return messages | words.unfilled(_FILLED)
