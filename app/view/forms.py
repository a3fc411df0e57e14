"""The settings that a lab, a step or a figure shows, as data for assets/web/parts/form.ts."""

from __future__ import annotations

from collections.abc import Iterable

from onpath.app.channel.messages import FieldValue, FormField, FormOption
from onpath.lessons.labels import option_label, parameter_help, parameter_label, parameter_unit
from onpath.lessons.words import Words
from onpath.models.control.laws.registry import LAWS, law_named
from onpath.models.control.settable import specs
from onpath.models.systems.parameter_specs import Spec
from onpath.models.systems.parameters import Parameters


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
    default: FieldValue,
    mark: FieldValue | None = None,
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
