"""What a reader of a figure may set, as a form for its page."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, Literal

import msgspec

from onpath.app.channel.form_messages import FormField, FormGroup, FormMessage, FormNeed
from onpath.app.exports.standalone.figure_choice import FigureChoice
from onpath.app.exports.standalone.setting_numbers import page_values
from onpath.app.view.forms import choice_field, setting_field, with_limit
from onpath.lessons.labels import path_label
from onpath.lessons.sides import law_titles
from onpath.lessons.words import Words
from onpath.models.control.settable import specs, value_of
from onpath.models.control.sides import RIGHT, SIDES
from onpath.models.paths.spline_curves import SplineCurve


def figure_form(
    figure: FigureChoice,
    words: Words,
    place: Literal["figure", "step"] = "figure",
    more: Iterable[FormField] = (),
) -> dict[str, Any]:
    """The form as data for JSON.

    Args:
        place: in a step, the figure's values are marked, and one goes back to them.
        more: further fields.
    """
    fields = list[FormField]()
    for name in figure.sliders:
        field = setting_of(figure, name, words, place)
        fields += with_limit(field) if name == "alpha" and figure.flexes else (field,)
        if name == "speed" and any(isinstance(each, SplineCurve) for each in figure.paths.values()):
            fields.append(FormField(name="pace", kind="note", label="", needs=field.needs))
    if "poles" in figure.controls:
        fields.append(FormField(name="poles", kind="note", label=""))
        fields.append(FormField(name="pole_plane", kind="poles", label=words("form.poles")))
    choices = (*_choices_of_path(figure, words), *_choices_of_law(figure, words))
    group = FormGroup(
        name="figure", title=words("lesson.controls"), fields=(*choices, *fields, *more)
    )
    form = FormMessage(place=place, groups=(group,) if group.fields else ())
    return msgspec.to_builtins(form)


def setting_of(figure: FigureChoice, name: str, words: Words, place: str = "figure") -> FormField:
    """The field of a parameter or gain, with the options that the page has."""
    parameters, spec = figure.parameters, specs(figure.parameters)[name]
    usual = parameters if place == "figure" else type(parameters)()
    field = setting_field(
        name,
        spec,
        words,
        default=value_of(usual, name),
        mark=value_of(parameters, name),
        guesses=figure.entry.guesses,
        options=figure.remade.get(name, page_values(figure, name, {}) if spec.options else ()),
    )
    needs = [need for need in field.needs if not any(_holds(figure, each) for each in need)]
    return msgspec.structs.replace(field, needs=tuple(needs))


def _holds(figure: FigureChoice, need: FormNeed) -> bool:
    """Whether a condition always holds on the page, which then does not know its setting."""
    changing = (*figure.sliders, *figure.changing, *figure.remade)
    if need.name in changing or need.name not in specs(figure.parameters):
        return False
    value = value_of(figure.parameters, need.name)
    return value in need.of if need.of else bool(value) and value != "off"


def _choices_of_path(figure: FigureChoice, words: Words) -> list[FormField]:
    if len(figure.paths) < 2 or "path" not in figure.controls:
        return []
    options = {path_label(name, words): i for i, name in enumerate(figure.paths)}
    return [choice_field("path", words("standalone.path"), options, default=0)]


def _choices_of_law(figure: FigureChoice, words: Words) -> list[FormField]:
    if not figure.choices:
        return []
    titles = law_titles(figure.every_law, words)
    offered = dict.fromkeys((*figure.laws, *figure.choices))
    options = {titles[law]: figure.every_law.index(law) for law in offered}
    label, sides = words("standalone.law"), SIDES if len(figure.laws) > 1 else (RIGHT,)
    return [
        choice_field(
            side,
            label if len(sides) == 1 else f"{label}, {words(f'side.{side}')}",
            options,
            default=figure.every_law.index(law),
        )
        for side, law in zip(sides, figure.laws, strict=True)
    ]
