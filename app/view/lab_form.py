"""The form of a lab and of a lesson's step in it, and the values of its fields."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Literal

from msgspec import structs

from onpath.app.channel.form_messages import (
    FieldValue,
    FormField,
    FormGroup,
    FormMessage,
    FormNeed,
    FormOption,
)
from onpath.app.common.newcomer import NEWCOMER
from onpath.app.common.robot_files import other_tips
from onpath.app.lab.commands import (
    AddPoint,
    Identify,
    Pulse,
    Redo,
    RemovePoint,
    Reset,
    ResetParameters,
    StartOnPath,
    Undo,
)
from onpath.app.lab.commands.command_codec import message_of
from onpath.app.lab.lab import Command
from onpath.app.lab.plant_state import SIDE, settable
from onpath.app.lab.snapshots.page_snapshot import PageSnapshot, parameters_of
from onpath.app.view.forms import (
    ELSEWHERE,
    drawing_field,
    setting_field,
    settings_in_form,
    with_limit,
)
from onpath.app.view.laws import suitable
from onpath.app.view.notes import NEVER, alpha_note, deflections, wall_forces
from onpath.app.view.paths import outline, preset_label
from onpath.app.view.poles import poles_of
from onpath.app.view.robots import about_robot, picture_of
from onpath.lessons.action_schema import StepSetup
from onpath.lessons.labels import robot_label
from onpath.lessons.sides import law_label, law_text
from onpath.lessons.vocabulary.names import DRAWINGS
from onpath.lessons.words import Words
from onpath.models.closed_loop.lab_settings import SETTINGS, LabSettings
from onpath.models.control.laws.own import OWN, PATH_FOLLOWING, is_text
from onpath.models.control.settable import specs, values_of
from onpath.models.control.sides import DEFAULT_LAWS, LEFT, SIDES
from onpath.models.paths.path_design import REACH, presets
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.robots import Robot

SWITCHES = (*DRAWINGS, "zone", "start", "tips")
"""What a page can draw besides the robots: what lessons can name, the shading of the singular zone,
the start of the next run, which can be dragged, and the tips that a robot's file suggests."""
OF_PAGE = ("pull", "tube_sizes", "rank_scale", "least_rank")
"""Fields whose values the page knows; see app/server/page_form.py."""
SHOWN = "show_"
"""Begins the names of the fields of those that no lesson names."""
PULLS = ("path's plane", "horizontal plane")
"""Planes in which the mouse can pull a robot in space; see `Stage.pulls` in app/scene."""
NO_STEP = FormMessage(place="step", groups=())
GROUPS: Mapping[str, Literal["first", "deeper"]] = {
    "setup": "first",
    **dict.fromkeys(("hand", "gains", "view", "robot"), "deeper"),
}
"""Groups of the form in their order, with their levels."""
GROUP_OF = {
    **dict.fromkeys(("touch", "wall", "start"), "hand"),
    **dict.fromkeys(("basic", "robot", "path"), "robot"),
    "gains": "gains",
    "task": "gains",
    "realism": "hand",
    "view": "view",
}
"""Group of a declaration -> group of the form."""
GROUP_OF_OTHERS = {
    **dict.fromkeys(("pulse", "reset", "start_on_path", "show_start", "wall_forces"), "hand"),
    "identify": "hand",
    **dict.fromkeys(("alpha_note", "deflection", "pull", "show_tips"), "robot"),
    **dict.fromkeys(("poles", "pole_plane", "defaults"), "gains"),
    **dict.fromkeys(("file", "add", "remove", "point", "point_z1", "point_z2"), "gains"),
    "least_rank": "gains",
    **dict.fromkeys((*DRAWINGS, "tube_sizes", "rank_scale", "show_zone", "view"), "view"),
}
"""Group of each field that is no declared setting."""
FIRST = (
    *("robot", "path", "draw", "undo", "redo", "speed", "pace"),
    *(f"{part}{side}" for side in SIDES for part in ("", "typed_", "about_")),
)
"""Fields that are seen at once, in their order."""
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
"""Fields under each heading of the realism; the rest are errors of the model."""
STATES = {
    "hand": ("copy", "hold_direction", "wall"),
    "gains": ("K1", "K2", "K5"),
}
"""Fields whose values a closed group shows."""
BESIDE_PLANT = (
    *("path", "draw", "file", "undo", "redo", "pace"),
    *(f"{part}{side}" for side in SIDES for part in ("", "typed_", "about_")),
    *("poles", "pole_plane", "tube_sizes", "rank_scale", "view"),
)
"""Fields that stay beside the settings when a robot is a plant elsewhere."""
CONTROLS = {
    "path": ("path", "rise"),
    "laws": tuple(name for side in SIDES for name in (side, f"typed_{side}")),
    "wall": (
        *(name for name, each in SETTINGS.items() if each.spec.group == "wall"),
        "wall_forces",
    ),
    "start": (
        "show_start",
        *(name for name, each in SETTINGS.items() if each.spec.group == "start"),
        *("reset", "start_on_path"),
    ),
    "flexible": (
        *("output", "alpha", "alpha_note", "deflection", "pull", "larger"),
        *("plant", "modes", "rho", "frequency", "zeta"),
        *("tip_damping", "tip_prediction", "tip_shaping", "tip_yielding"),
    ),
    "show": (*DRAWINGS, "tube_sizes", "rank_scale"),
    "editor": (
        *("draw", "file", "undo", "redo", "add", "remove", "point", "point_z1", "point_z2"),
        *("least_rank", "show_zone"),
    ),
    "sign": ("draw", "undo", "lines"),
    "gains": ("speed", "pace", "K1", "K2", "K3", "K4", "K5", "poles", "pole_plane"),
}
"""Controls of a lesson's step that stand for several fields."""


def form_of(snapshot: PageSnapshot, setup: StepSetup | None, words: Words) -> FormMessage:
    """The form of a lab; of a lesson's step if there is one.

    Args:
        setup: of the open step.
    """
    edit = snapshot.edit
    own = "" if edit.name in presets() else edit.name
    laws, plant = tuple(snapshot.run.laws.items()), snapshot.plant
    lab = _Lab(
        robot=snapshot.key.robot,
        laws=laws,
        path=own,
        points=len(edit.points),
        plant=() if plant is None else plant.laws,
    )
    if setup is None:
        return _lab_form(lab, words)
    return _step_form(lab, setup.controls, tuple(setup.set.items()), words)


def drawn_form(snapshot: PageSnapshot, words: Words) -> FormMessage:
    """The form of another's lab, which only switches drawings."""
    return _drawn_form(snapshot.key.robot, words)


@dataclass(frozen=True, slots=True)
class _Lab:
    """What the fields of a lab depend on.

    Attributes:
        path: the name of a custom path; empty if it is a preset.
        points: number of its control points.
        plant: laws of a plant elsewhere in the place of a robot; (): there is none.
    """

    robot: str
    laws: tuple[tuple[str, str], ...]
    path: str
    points: int
    plant: tuple[str, ...] = ()


def values_in(
    snapshot: PageSnapshot,
    drawn: Mapping[str, bool],
    typing: Iterable[str],
    words: Words,
    critical: float | None = None,
) -> dict[str, FieldValue]:
    """The values of all fields but those `OF_PAGE`.

    Args:
        drawn: which of `SWITCHES` are switched on.
        typing: sides for which a law is being typed.
        critical: the critical α of a flexible link; None while it is not known.
    """
    laws, settings = snapshot.run.laws, snapshot.settings
    values: dict[str, FieldValue] = {**snapshot.parameters}
    values |= {switch_name(name): on for name, on in drawn.items()}
    for name in SETTINGS:
        if name not in ELSEWHERE:
            values[name] = getattr(settings, name)
    values["path"] = snapshot.edit.name
    fastest = snapshot.edit.fastest
    values["pace"] = words("design.pace", speed=f"{1e3 * fastest:.0f}") if fastest else ""
    values["can_undo"], values["can_redo"] = snapshot.edit.can_undo, snapshot.edit.can_redo
    selected, points = snapshot.edit.selected, snapshot.edit.points
    values |= {"point": 0, "point_z1": 0.0, "point_z2": 0.0}
    if selected is not None and selected < len(points):
        values["point"] = selected + 1
        values["point_z1"], values["point_z2"] = map(float, points[selected])
    for side, law in laws.items():
        typed = is_text(law) and (snapshot.plant is None or side != SIDE)
        values[side] = OWN if typed or side in typing else law
        values[f"typed_{side}"] = (law if typed else PATH_FOLLOWING).replace("; ", "\n")
        values[f"about_{side}"] = "" if values[side] == OWN else law_text(law, words)
    places = tuple(snapshot.places.of.items())
    values["poles"], values["pole_plane"] = poles_of(
        parameters_of(snapshot), tuple(laws.items()), places, words
    )
    values["wall_forces"] = wall_forces(snapshot, words)
    if ROBOTS[snapshot.key.robot].flexible_link is not None:
        now = snapshot.parameters
        values["critical_alpha"] = NEVER if critical is None else min(critical, NEVER)
        values["alpha_note"] = alpha_note(
            float(now["alpha"]), critical, int(now["modes"]), float(now["zeta"]), words
        )
        values["deflection"] = deflections(snapshot, words)
    return values


def refusals_in(snapshot: PageSnapshot) -> dict[str, str]:
    """Why the last value of a field was refused, by field; a law is refused where it is typed."""
    return {
        f"typed_{name}" if name in SIDES else name: why for name, why in snapshot.refused.items()
    }


def switch_name(drawing: str) -> str:
    """The name of the field that switches something that is drawn."""
    return drawing if drawing in DRAWINGS else f"{SHOWN}{drawing}"


@lru_cache(maxsize=64)
def _lab_form(lab: _Lab, words: Words) -> FormMessage:
    fields = _fields(lab, {}, words)
    if lab.plant:
        fields = _beside_plant(fields, lab, words)
    groups: dict[str, list[FormField]] = {name: [] for name in GROUPS}
    groups["setup"] = [fields[name] for name in FIRST if name in fields]
    for name, field in fields.items():
        if name not in FIRST:
            section = _section_of(name, lab.robot)
            titled = structs.replace(field, section=words(section)) if section else field
            groups[_group_of(name, lab.robot)].append(titled)
    counted = [each.name for each in groups["hand"] if each.on is not None]
    states = {**STATES, "hand": tuple(dict.fromkeys((*STATES["hand"], *counted)))}
    return FormMessage(
        place="lab",
        groups=tuple(
            FormGroup(
                name=name,
                title=words(f"form.group_{name}"),
                fields=tuple(groups[name]),
                level=level,
                states=states.get(name, ()),
            )
            for name, level in GROUPS.items()
            if groups[name]
        ),
    )


def _beside_plant(fields: Mapping[str, FormField], lab: _Lab, words: Words) -> dict[str, FormField]:
    """The fields of what can be done with a plant in the place of a robot."""
    drawn = {switch_name(name) for name in SWITCHES if name not in ("start", "tips")}
    kept = {*BESIDE_PLANT, *drawn} - {f"typed_{SIDE}"}
    parameters = ROBOTS[lab.robot].parameters
    found = {
        name: field for name, field in fields.items() if name in kept or settable(name, parameters)
    }
    options = tuple(FormOption(value=law, label=law_label(law, words)) for law in lab.plant)
    law = structs.replace(found[SIDE], label=words("plant.law"), options=options, default=None)
    simulated = structs.replace(found[LEFT], label=words("plant.law_simulated"))
    found |= {SIDE: law, LEFT: simulated}
    return found


@lru_cache(maxsize=64)
def _drawn_form(robot: str, words: Words) -> FormMessage:
    fields = _fields(_Lab(robot=robot, laws=(), path="", points=0), {}, words)
    drawn = [field for name in SWITCHES if (field := fields.get(switch_name(name))) is not None]
    title = words("form.group_view")
    return FormMessage(
        place="lab", groups=(FormGroup(name="view", title=title, fields=tuple(drawn)),)
    )


@lru_cache(maxsize=256)
def _step_form(
    lab: _Lab,
    controls: tuple[str, ...],
    marks: tuple[tuple[str, FieldValue], ...],
    words: Words,
) -> FormMessage:
    fields = _fields(lab, dict(marks), words)
    lines = {"is": "make", "file": "lines", "with_code": False}
    fields["lines"] = FormField(name="lines", kind="button", label=words("export.lines"), act=lines)
    named = [name for control in controls for name in CONTROLS.get(control, (control,))]
    shown = tuple(fields[name] for name in dict.fromkeys(named) if name in fields)
    if not shown:
        return NO_STEP
    fields_and_all = (*shown, _button("controls", words("lesson.all_controls")))
    group = FormGroup(name="step", title=words("lesson.controls"), fields=fields_and_all)
    return FormMessage(place="step", groups=(group,))


def _group_of(name: str, robot: str) -> str:
    """The group of a field that is not seen at once."""
    if name in GROUP_OF_OTHERS:
        return GROUP_OF_OTHERS[name]
    known = specs(ROBOTS[robot].parameters)
    spec = known[name] if name in known else SETTINGS[name].spec
    return GROUP_OF.get(spec.group, "robot")


def _section_of(name: str, robot: str) -> str:
    """The key of a heading that a field has in the lab only, not in a step; or empty."""
    known = specs(ROBOTS[robot].parameters)
    if name in known and known[name].group == "task":
        return "form.section_motion"
    return {"file": "form.section_points", "identify": "form.section_model"}.get(name, "")


def _fields(lab: _Lab, marks: Mapping[str, FieldValue], words: Words) -> dict[str, FormField]:
    """All fields that a lab can have, by name, in the order of the form."""
    entry = ROBOTS[lab.robot]
    kind = entry.parameters
    robot = entry.make(kind())
    known, defaults, link = specs(kind), LabSettings(), entry.flexible_link
    usual = {**values_of(kind()), **NEWCOMER}
    chosen = dict(lab.laws)
    found: list[FormField] = [
        FormField(
            name="robot",
            kind="button",
            label=robot_label(lab.robot, words),
            help=about_robot(entry, words),
            picture=picture_of(entry),
        ),
        _path_field(robot, lab.path, words),
        FormField(
            name="draw",
            kind="button",
            label=words("setup.draw"),
            help=words("design.draw_hint"),
            icon="draw",
            act={"is": "freehand"},
        ),
        structs.replace(
            _button("undo", words("design.undo"), Undo(), words("design.undo_hint"), "can_undo"),
            icon="undo",
        ),
        structs.replace(
            _button("redo", words("design.redo"), Redo(), words("design.redo_hint"), "can_redo"),
            icon="redo",
        ),
        FormField(name="pace", kind="note", label=""),
        *_law_fields(robot, chosen, words),
    ]
    for name in settings_in_form(kind, chosen.values()):
        spec, default = (
            (known[name], usual[name])
            if name in known
            else (SETTINGS[name].spec, getattr(defaults, name))
        )
        section = ""
        if spec.group == "realism":
            where = next((n for n, names in SECTIONS.items() if name in names), "model")
            section = words(f"form.section_{where}")
        elif link is not None and name in (*link.beam, *link.composite):
            section = words("flexible.beam" if name in link.beam else "flexible.composite")
        mark = marks.get(name)
        found.append(
            setting_field(
                name,
                spec,
                words,
                default=default,
                mark=mark,
                section=section,
                guesses=entry.guesses,
            )
        )
    if link is not None:
        found = list(_with_link(found, words))
    if other_tips(entry.name):
        found.append(
            _switch("show_tips", words("robots.show_tips"), words("robots.show_tips_hint"))
        )
    found += [
        _switch("show_start", words("start.show"), words("start.show_hint")),
        _button("pulse", words("gains.pulse"), Pulse(), words("gains.pulse_hint")),
        _button("reset", words("start.reset"), Reset(), words("start.reset_hint")),
        _button(
            "start_on_path", words("start.default"), StartOnPath(), words("start.default_hint")
        ),
        FormField(name="wall_forces", kind="note", label="", needs=((FormNeed("wall"),),)),
        FormField(name="poles", kind="note", label=""),
        FormField(name="pole_plane", kind="poles", label=words("form.poles")),
        _button(
            "defaults", words("gains.defaults"), ResetParameters(), words("gains.defaults_hint")
        ),
        _button("file", words("setup.file"), help=words("setup.file_hint")),
        *_point_fields(robot, lab.points, words),
        _button("identify", words("gains.identify"), Identify(), words("gains.identify_hint")),
        *_drawing_fields(words),
        *(
            (_switch("show_zone", words("design.zone"), words("design.zone_hint")),)
            if robot.frame.p == 2
            else ()
        ),
        FormField(
            name="view",
            kind="button",
            label=words("run.view"),
            help=words("run.view_hint"),
            act={"is": "view"},
        ),
    ]
    return {field.name: field for field in found}


def _button(
    name: str, label: str, command: Command | None = None, help: str = "", needs: str = ""
) -> FormField:
    """A button; without a command, the page knows what its name means.

    Args:
        needs: the value without which it is not shown.
    """
    act = None if command is None else message_of(command)
    conditions = ((FormNeed(needs),),) if needs else ()
    return FormField(name=name, kind="button", label=label, act=act, help=help, needs=conditions)


def _switch(name: str, label: str, help: str) -> FormField:
    """A switch for something that is drawn and that no lesson names."""
    return FormField(name=name, kind="switch", label=label, help=help, default=False)


def _point_fields(robot: Robot, count: int, words: Words) -> Iterator[FormField]:
    """What adds, removes and moves control points of the path."""
    section = words("form.section_points")
    for button in (
        _button("add", words("design.add"), AddPoint(), words("design.add_hint")),
        _button("remove", words("design.remove"), RemovePoint(), words("design.remove_hint")),
    ):
        yield structs.replace(button, section=section)
    numbers = [FormOption(value=i + 1, label=str(i + 1)) for i in range(count)]
    yield FormField(
        name="point",
        kind="choice",
        label=words("design.selected"),
        help=words("design.arrows"),
        options=(FormOption(value=0, label=words("design.no_point")), *numbers),
        section=section,
    )
    for name, axis in zip(("point_z1", "point_z2"), robot.frame.axes, strict=True):
        yield FormField(
            name=name,
            kind="number",
            label=words("design.coordinate", name=f"y{axis}"),
            help=words("design.coordinate_hint"),
            low=-REACH,
            high=REACH,
            step=5e-4,
            factor=1e3,
            needs=((FormNeed("point"),),),
            section=section,
        )
    yield FormField(name="least_rank", kind="note", label="", section=section)


def _drawing_fields(words: Words) -> Iterator[FormField]:
    """What can be drawn besides the robots, with notes on what is drawn."""
    notes = {"grid": "tube_sizes", "rank": "rank_scale"}
    for name in DRAWINGS:
        yield drawing_field(name, words)
        if name in notes:
            tone = "ranks" if name == "rank" else ""
            yield FormField(name=notes[name], kind="note", label="", tone=tone)


def _with_link(fields: Iterable[FormField], words: Words) -> Iterator[FormField]:
    """The settings of a robot with a flexible link, and what belongs to them."""
    named = {field.name: field for field in fields}
    alpha = named.pop("alpha")
    for name, field in named.items():
        yield field
        if name == "output":
            yield from with_limit(alpha)
            yield FormField(name="deflection", kind="note", label="")
            yield _pull_field(words)


def _pull_field(words: Words) -> FormField:
    return FormField(
        name="pull",
        kind="choice",
        label=words("flexible.pull"),
        help=words("flexible.pull_hint"),
        options=tuple(FormOption(value=each, label=words(f"pull.{each}")) for each in PULLS),
        default=PULLS[0],
    )


def _path_field(robot: Robot, own: str, words: Words) -> FormField:
    options = [
        FormOption(value=name, label=preset_label(name, robot, words), picture=outline(name))
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


def _law_fields(robot: Robot, chosen: Mapping[str, str], words: Words) -> list[FormField]:
    offered = suitable(robot)
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
            FormField(name=f"about_{side}", kind="note", label="", tone=f"of_{side}"),
        ]
    return fields
