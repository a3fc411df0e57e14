"""The form of a lab and of a lesson's step in it, and the values of its fields."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import lru_cache

import numpy as np

from onpath.app.channel.messages import (
    FieldValue,
    FormField,
    FormGroup,
    FormMessage,
    FormNeed,
    FormOption,
)
from onpath.app.common.newcomer import NEWCOMER
from onpath.app.lab.commands import Identify, Pulse, Redo, StartOnPath, Undo
from onpath.app.lab.commands.command_codec import message_of
from onpath.app.lab.snapshots.page_snapshot import PageSnapshot, parameters_of
from onpath.app.view.forms import ELSEWHERE, drawing_field, fields_of, setting_field
from onpath.lessons.action_schema import StepSetup
from onpath.lessons.labels import path_label, robot_label
from onpath.lessons.sides import law_label, law_text, side_titles
from onpath.lessons.words import Words
from onpath.models.closed_loop.lab_settings import SETTINGS, LabSettings
from onpath.models.control.law_poles import channels_of
from onpath.models.control.laws.own import OWN, PATH_FOLLOWING, is_text
from onpath.models.control.laws.registry import LAWS
from onpath.models.control.place import Place
from onpath.models.control.settable import specs, values_of
from onpath.models.control.sides import DEFAULT_LAWS, SIDES
from onpath.models.errors import Message
from onpath.models.paths.path_design import presets
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.parameters import Parameters

DRAWINGS = ("labels", "tube", "grid", "rank", "errors", "mass")
"""What a page can draw besides the robots: fields of `app.page.overlays.Switches`."""
GROUP_OF = {
    **dict.fromkeys(("touch", "wall", "start"), "hand"),
    **dict.fromkeys(("basic", "robot", "path"), "robot"),
    "gains": "gains",
    "task": "along",
    "realism": "reality",
    "view": "view",
}
"""Group of a declaration -> group of the form."""
FIRST = ("speed",)
SECTIONS = {
    "motors": ("torque_limit", "at_limit", "at_limit_for", "torque_step"),
    "sensors": (
        *("encoder_counts", "encoder_filter", "observer_time", "sensor_noise", "strain_noise"),
        "seed",
    ),
    "friction": ("coulomb", "stiction"),
    "computer": ("control_rate", "look_ahead", "delay"),
    "load": ("counterweights_removed", "payload"),
}
"""Headings in the group of the realism; the rest are errors of the model."""
STATES = {
    "hand": ("copy", "hold_direction", "wall"),
    "gains": ("K1", "K2", "K5"),
    "along": ("speed_profile", "task"),
}
CONTROLS = {
    "path": ("path", "rise"),
    "laws": tuple(name for side in SIDES for name in (side, f"typed_{side}")),
    "wall": tuple(name for name, each in SETTINGS.items() if each.spec.group == "wall"),
    "start": tuple(name for name, each in SETTINGS.items() if each.spec.group == "start"),
    "flexible": ("output", "alpha", "larger"),
    "show": DRAWINGS,
    "gains": ("speed", "K1", "K2", "K3", "K4", "K5", "poles"),
}
"""Controls of a lesson's step that stand for several fields."""


def form_of(snapshot: PageSnapshot, setup: StepSetup | None, words: Words) -> FormMessage:
    """The form of a lab; of a lesson's step if there is one.

    Args:
        setup: of the open step.
    """
    laws = tuple(snapshot.run.laws.items())
    own = "" if snapshot.edit.name in presets() else snapshot.edit.name
    if setup is None:
        return _lab_form(snapshot.key.robot, laws, own, words)
    marks = tuple(setup.set.items())
    return _step_form(snapshot.key.robot, laws, own, setup.controls, marks, words)


def values_in(
    snapshot: PageSnapshot, drawn: Mapping[str, bool], typing: Iterable[str], words: Words
) -> dict[str, FieldValue]:
    """The values of all fields.

    Args:
        drawn: which of `DRAWINGS` are switched on.
        typing: sides for which a law is being typed.
    """
    laws, settings = snapshot.run.laws, snapshot.settings
    values: dict[str, FieldValue] = {**snapshot.parameters, **drawn}
    for name in SETTINGS:
        if name not in ELSEWHERE:
            values[name] = getattr(settings, name)
    values["path"] = snapshot.edit.name
    values["robot"] = robot_label(snapshot.key.robot, words)
    for side, law in laws.items():
        typed = is_text(law)
        values[side] = OWN if typed or side in typing else law
        values[f"typed_{side}"] = (law if typed else PATH_FOLLOWING).replace("; ", "\n")
        values[f"about_{side}"] = "" if typed else law_text(law, words)
    places = tuple(snapshot.places.of.items())
    values["poles"] = _settling(parameters_of(snapshot), tuple(laws.items()), places, words)
    return values


def refusals_in(snapshot: PageSnapshot) -> dict[str, str]:
    """Why the last value of a field was refused, by field."""
    refused = snapshot.refused
    typed = {f"typed_{side}": refused[side] for side in SIDES if side in refused}
    return {**refused, **typed}


@lru_cache(maxsize=64)
def _lab_form(robot: str, laws: tuple[tuple[str, str], ...], own: str, words: Words) -> FormMessage:
    fields = _fields(robot, laws, own, {}, words)
    groups: dict[str, list[FormField]] = {name: [] for name in LEVELS}
    for name, field in fields.items():
        if group := _group_of(name, robot):
            groups[group].append(field)
    reality = [each.name for each in groups["reality"] if each.on is not None]
    states = {**STATES, "reality": tuple(reality)}
    return FormMessage(
        place="lab",
        groups=tuple(
            FormGroup(
                name=name,
                title=words(f"form.group_{name}"),
                fields=tuple(groups[name]),
                level="first" if level == "first" else "deeper",
                states=states.get(name, ()),
                rest=words("form.ideal") if name == "reality" else "",
            )
            for name, level in LEVELS.items()
            if groups[name]
        ),
    )


@lru_cache(maxsize=256)
def _step_form(
    robot: str,
    laws: tuple[tuple[str, str], ...],
    own: str,
    controls: tuple[str, ...],
    marks: tuple[tuple[str, FieldValue], ...],
    words: Words,
) -> FormMessage:
    fields = _fields(robot, laws, own, dict(marks), words)
    named = [name for control in controls for name in CONTROLS.get(control, (control,))]
    shown = tuple(fields[name] for name in dict.fromkeys(named) if name in fields)
    group = FormGroup(name="step", title=words("lesson.controls"), fields=shown)
    return FormMessage(place="step", groups=(group,) if shown else ())


LEVELS = {
    "setup": "first",
    **dict.fromkeys(("hand", "gains", "along", "reality", "view", "robot"), "deeper"),
}


def _group_of(name: str, robot: str) -> str:
    """The group in which a field of the lab stands; empty: it is not shown there."""
    if name in _OTHERS:
        return _OTHERS[name]
    if name in FIRST:
        return "setup"
    known = specs(ROBOTS[robot].parameters)
    spec = known[name] if name in known else SETTINGS[name].spec
    return GROUP_OF.get(spec.group, "robot")


_OTHERS = {
    **dict.fromkeys(("pulse", "start_on_path"), "hand"),
    "poles": "gains",
    "identify": "reality",
    **dict.fromkeys(DRAWINGS, "view"),
    **dict.fromkeys(("robot", "path", "file", "undo", "redo", "laws", "compare"), ""),
    **{f"{part}{side}": "" for side in SIDES for part in ("", "typed_", "about_")},
}
"""Group of each field that is no declared setting; parts/setup.ts shows those of none."""


def _fields(
    robot: str,
    laws: tuple[tuple[str, str], ...],
    own: str,
    marks: Mapping[str, FieldValue],
    words: Words,
) -> dict[str, FormField]:
    """All fields that a lab can have, by name, in the order of the form."""
    kind = ROBOTS[robot].parameters
    known, defaults = specs(kind), LabSettings()
    usual = {**values_of(kind()), **NEWCOMER}
    chosen = dict(laws)
    found: list[FormField] = [
        FormField(name="robot", kind="button", label=robot_label(robot, words)),
        _path_field(own, words),
        _button("file", words("design.files")),
        _button("undo", words("design.undo"), Undo()),
        _button("redo", words("design.redo"), Redo()),
        *_law_fields(robot, chosen, words),
        _button("laws", words("laws.about")),
        _button("compare", words("compare.title")),
    ]
    for name in fields_of("lab", kind, chosen.values()):
        spec, default = (
            (known[name], usual[name])
            if name in known
            else (SETTINGS[name].spec, getattr(defaults, name))
        )
        section = ""
        if spec.group == "realism":
            where = next((n for n, names in SECTIONS.items() if name in names), "model")
            section = words(f"form.section_{where}")
        mark = marks.get(name)
        field = setting_field(name, spec, words, default=default, mark=mark, section=section)
        found.append(field)
    found += [
        FormField(name="poles", kind="note", label=""),
        _button("pulse", words("gains.pulse"), Pulse(), words("gains.pulse_hint")),
        _button("start_on_path", words("start.default"), StartOnPath()),
        _button("identify", words("gains.identify"), Identify(), words("gains.identify_hint")),
        *(drawing_field(name, words) for name in DRAWINGS),
    ]
    return {field.name: field for field in found}


def _button(name: str, label: str, command: object = None, help: str = "") -> FormField:
    """A button; without a command, the page knows what its name means."""
    act = None if command is None else message_of(command)  # type: ignore[arg-type]
    return FormField(name=name, kind="button", label=label, act=act, help=help)


def _path_field(own: str, words: Words) -> FormField:
    options = [
        FormOption(value=name, label=path_label(name, words), picture=_outline(name))
        for name in presets()
    ]
    if own:
        options.append(FormOption(value=own, label=words("design.own")))
    return FormField(
        name="path",
        kind="choice",
        label=words("design.path"),
        help=words("design.path_hint"),
        options=tuple(options),
        default="circle",
    )


@lru_cache(maxsize=16)
def _outline(preset: str) -> str:
    """The picture of a preset path."""
    curve = presets()[preset].curve
    points = curve.at(np.linspace(-np.pi, np.pi, 49))
    points = points - (points.min(axis=0) + points.max(axis=0)) / 2
    points = 45 * points / np.abs(points).max() * (1, -1)
    return "M" + "L".join(f"{x:.0f} {y:.0f}" for x, y in points)


def _law_fields(robot: str, chosen: Mapping[str, str], words: Words) -> list[FormField]:
    system = ROBOTS[robot].make(ROBOTS[robot].parameters()).system
    offered = [name for name, law in LAWS.items() if law.suits(system)]
    options = tuple(FormOption(value=name, label=law_label(name, words)) for name in offered)
    options = (*options, FormOption(value=OWN, label=words("laws.own")))
    fields = list[FormField]()
    for side in chosen:
        fields += [
            FormField(
                name=side,
                kind="choice",
                label=words(f"laws.{side}"),
                help=words("laws.hint"),
                options=options,
                default=DEFAULT_LAWS[side] if DEFAULT_LAWS[side] in offered else None,
            ),
            FormField(
                name=f"typed_{side}",
                kind="text",
                label=words(f"laws.own_{side}"),
                help=words("laws.own_hint"),
                needs=((FormNeed(side, (OWN,)),),),
            ),
            FormField(name=f"about_{side}", kind="note", label="", tone="about"),
        ]
    return fields


@lru_cache(maxsize=256)
def _settling(
    parameters: Parameters,
    laws: tuple[tuple[str, str], ...],
    places: tuple[tuple[str, Place], ...],
    words: Words,
) -> str:
    """How the motion across and along settles, a line for each; cached, since a class mostly looks
    at the same gains."""
    titles, lines = side_titles(dict(laws), words), dict[str, None]()
    for side, law in laws:
        channels = channels_of(law, parameters, dict(places).get(side))
        if isinstance(channels, Message):
            lines[f"{titles[side]}: {words.sentence(channels)}"] = None
            continue
        for channel in channels:
            name = words(f"gains.{channel.name}")
            lines[f"{name}: {words.sentence(channel.behaviour())}"] = None
    return "\n".join(lines)
