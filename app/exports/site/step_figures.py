"""The figure of a step: its set-up, what readers may change, and what only the lab has."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Any

from onpath.app.channel.form_messages import FormField
from onpath.app.exports.site.step_actions import Act, link_acts, script_acts
from onpath.app.exports.standalone.drawings import SWITCHES, drawings_data
from onpath.app.exports.standalone.figure_choice import FigureChoice, chosen
from onpath.app.exports.standalone.figure_data import (
    changes_data,
    common_data,
    figure_numbers,
    stop_texts,
)
from onpath.app.exports.standalone.figure_form import figure_form
from onpath.app.exports.standalone.setting_numbers import (
    SettingNumbers,
    Unsupported,
    Used,
    page_values,
    setting_numbers,
)
from onpath.app.view.forms import drawing_field, setting_field
from onpath.lessons.action_schema import Action, SceneMark, Script, StepSetup
from onpath.lessons.labels import setting_label
from onpath.lessons.record import QUANTITIES
from onpath.lessons.schema import Lesson, Step, Text
from onpath.lessons.sides import ROLES, law_titles, robot_names
from onpath.lessons.task_schema import Once, Reference, Setting, Task
from onpath.lessons.words import Words
from onpath.models.closed_loop.lab_settings import SETTINGS, lab_specs
from onpath.models.closed_loop.simulation import raised
from onpath.models.closed_loop.start import Start
from onpath.models.control.laws.registry import law_name
from onpath.models.control.settable import specs, value_of
from onpath.models.control.sides import DEFAULT_LAWS, SIDES
from onpath.models.paths.curve_faults import curve_faults
from onpath.models.paths.curves import Curve
from onpath.models.paths.path_design import presets

ALWAYS = ("pull", "hold", "run", "step", "reset", "plot")
"""Controls that every step of the lab has."""
HERE = ("hold", "editor", "show", "start", "larger")
"""Controls besides parameters that a step's page has, too."""
STANDS_FOR = {"flexible": ("output", "alpha")}
"""Controls that stand for several parameters, of which the page has these."""
MOST = 8  # figures in the cache; those of one lesson follow each other
_SHARED: dict[Any, dict[str, Any]] = {}


@dataclass(frozen=True, slots=True)
class StepFigure:
    """A step's figure.

    Attributes:
        choice: what it shows.
        lacking: names of the step's controls that only the lab has.
        drawings: what is drawn besides the robots.
        marks: texts and arrows beside the robots.
        plots: plots that the step shows besides the distance.
        numbers: where the parameters act that change on the page.
    """

    choice: FigureChoice
    lacking: tuple[str, ...]
    drawings: tuple[str, ...]
    marks: tuple[SceneMark, ...]
    plots: tuple[str, ...]
    numbers: SettingNumbers

    def script(self, script: Script | None) -> dict[str, Any] | None:
        """A script as data; None if there is none, or only the lab can play it."""
        if script is None:
            return None
        try:
            return script_acts(script, self.choice)
        except Unsupported:
            return None

    def link(self, actions: Iterable[Action]) -> list[Act] | None:
        """The actions of a link as data; None if only the lab can do them."""
        try:
            return link_acts(actions, self.choice)
        except Unsupported:
            return None

    def can_pass(self, task: Task, reference: Reference, links: Iterable[Action]) -> bool:
        """Whether a reader has everything that the task's reference solution uses."""
        within_reach = {*self.choice.sliders}
        for action in links:
            if self.link([action]) is not None:
                within_reach |= set(action.set or {})
        for action in reference.solution.do:
            if action.hold is not None and "hold" not in self.choice.controls:
                return False
            if action.move is not None and "drag" not in self.choice.controls:
                return False
            if not set(action.set or {}) <= within_reach or action.only:
                return False
        measured = {getattr(check, "quantity", "distance") for check in task.evaluated}
        return self.script(reference.solution) is not None and measured <= set(self.quantities)

    @property
    def views(self) -> dict[str, float | bool]:
        """What a reader may change of the picture, and its first values."""
        drawn, shown = self.choice.drawings, self.drawings
        larger = {"larger": 1.0} if "larger" in drawn else {}
        return larger | {name: name in shown for name in SWITCHES if name in drawn}

    @property
    def quantities(self) -> list[str]:
        """Quantities that the page records."""
        robot, names = self.choice.machine, list(QUANTITIES)
        if "deflection" not in robot.extras:
            names = [name for name in names if name not in ("deflection", "energy")]
        if robot.system.p > 2 and "deflection" not in robot.extras:
            names.remove("lag")  # the picture does not show distances in space
        if self.choice.parameters.across == "level_set":
            names = [name for name in names if not name.startswith("across")]
        return names


def step_figure(
    lesson: Lesson, index: int, given: Mapping[str, Any] = MappingProxyType({})
) -> StepFigure:
    """The figure of a step.

    Args:
        given: values of parameters that make another robot.

    Raises:
        ValueError: a figure cannot show its set-up.
    """
    setup, step = lesson.setup_at(index), lesson.steps[index]
    robot = setup.robot or lesson.front.robot
    actions = _actions(step)
    laws = tuple({**DEFAULT_LAWS, **setup.laws.named}.values())
    first, *others = _paths(lesson, index, setup)
    curves = {first: presets()[first].curve}
    own = {name: value for name, value in setup.set.items() if name in SETTINGS}
    values = {name: value for name, value in setup.set.items() if name not in own}
    values |= given
    figure = chosen(robot, laws, curves, values, sliders=(), controls=_controls(setup, step))
    figure = replace(
        figure,
        paths={**curves, **_possible(figure, others)},
        scripted=tuple(
            law_name(law) for each in actions if each.laws for law in each.laws.named.values()
        ),
        drawings=_drawings(setup, figure),
        bends=any(action.move for action in actions),
        begins=Start(**setup.start.numbers),
    )
    known, wanted = specs(type(figure.parameters)), dict.fromkeys(_expanded(setup.controls))
    used = _used(actions)
    settable = dict.fromkeys(name for name in (*wanted, *used) if name in known)
    figure, numbers = _changing(figure, settable, used)
    remade = _remade(figure, lesson, wanted)
    figure = replace(figure, remade={name: each for name, each in remade.items() if len(each) > 1})
    sliders = tuple(name for name in wanted if name in (*figure.changing, *figure.remade))
    lacking = [name for name in (*wanted, *own) if name not in (*sliders, *remade, *HERE)]
    if step.kind == "quiz":  # asks about what was seen before
        lacking = []
    if any(action.identify for action in actions) and "identify" not in lacking:
        lacking.append("identify")
    return StepFigure(
        choice=replace(figure, sliders=sliders),
        lacking=tuple(lacking),
        drawings=setup.show,
        marks=setup.marks,
        plots=setup.plots,
        numbers=numbers,
    )


def _remade(
    figure: FigureChoice, lesson: Lesson, wanted: Iterable[str]
) -> dict[str, tuple[Any, ...]]:
    """The parameters that make another robot, with their options from the first to the last that is
    the step's own, or that tasks name."""
    checks = [check for task in lesson.tasks() for check in task.check]
    named = [check for check in checks if isinstance(check, Setting | Once)]
    own, known = figure.parameters, specs(figure.parameters)
    remade = dict[str, tuple[Any, ...]]()
    for name in wanted:
        if name in known and known[name].options and name not in figure.changing:
            options = known[name].options
            chosen = [options.index(check.equals) for check in named if check.name == name]
            chosen.append(options.index(value_of(own, name)))
            remade[name] = options[min(chosen) : max(chosen) + 1]
    return remade


def _controls(setup: StepSetup, step: Step) -> tuple[str, ...]:
    """The controls of a step's figure."""
    if step.kind == "predict":
        return ()
    return (*ALWAYS, "drag") if "editor" in setup.controls else ALWAYS


def figure_of(figure: StepFigure, words: Words) -> dict[str, Any]:
    """The data of a step's figure, with its module of kernels as Base64."""
    data, choice = _shared_data(figure.choice, words), figure.choice
    curve = next(iter(choice.paths.values()))
    stops = [
        stop_texts(choice, law, curve, "alpha" in choice.changing, words)
        for law in choice.every_law
    ]
    changes = changes_data(choice, figure.numbers)
    views = [view_field(name, value, words) for name, value in figure.views.items()]
    own = {name: value_of(choice.parameters, name) for name in choice.remade}
    return {
        **data,
        "laws": [
            {**law, "stops": texts, **names}
            for law, texts, names in zip(data["laws"], stops, _names(choice, words), strict=True)
        ],
        "form": figure_form(choice, words, "step", views),
        "changes": changes | {"values": changes["values"] | figure.views | own},
        "drawings": drawings_data(choice, figure.drawings, figure.marks, words),
        "controls": choice.controls,
        "quantities": figure.quantities,
    }


def _names(figure: FigureChoice, words: Words) -> list[dict[str, str]]:
    """For each law, the name that the texts give to its robot, and a title with it; else none."""
    names = robot_names(dict(zip(SIDES, figure.laws, strict=True)), words)
    named = {
        law: names[ROLES[side]]
        for side, law in zip(SIDES, figure.laws, strict=True)
        if law == DEFAULT_LAWS[side] and figure.laws.count(law) == 1
    }
    titles = law_titles(figure.every_law, words)
    return [
        {
            "name": named[law],
            "title": words("robot.under_law", robot=named[law], law=titles[law]),
        }
        if law in named
        else {}
        for law in figure.every_law
    ]


def _shared_data(choice: FigureChoice, words: Words) -> dict[str, Any]:
    """The data of a figure without what its reader may do, which many steps share."""
    shared = replace(choice, sliders=(), controls=("drag",) if choice.edits else ())
    fields = (getattr(shared, field.name) for field in dataclasses.fields(shared))
    key = *(tuple(each) if isinstance(each, dict) else each for each in fields), words.language
    if key not in _SHARED:
        while len(_SHARED) >= MOST:
            _SHARED.pop(next(iter(_SHARED)))
        _SHARED[key] = common_data(shared, words, figure_numbers(shared))
    return _SHARED[key]


def lacking_words(figure: StepFigure, words: Words) -> dict[str, str]:
    """What a step has only in the lab -> the reason, in words."""
    known = lab_specs(type(figure.choice.parameters))
    return {
        setting_label(name, figure.choice.parameters, words)
        if name in known
        else words(f"site.control.{name}"): words.get(f"site.why.{name}", "")
        for name in figure.lacking
    }


def _paths(lesson: Lesson, index: int, setup: StepSetup) -> list[str]:
    """The step's path, and those that its links and script choose."""
    actions = _actions(lesson.steps[index])
    paths = [setup.path or "circle", *(action.path for action in actions if action.path)]
    return list(dict.fromkeys(paths))


def _actions(step: Step) -> list[Action]:
    """The actions of a step's links and script."""
    links = [link for block in step.blocks if isinstance(block, Text) for link in block.links]
    actions = [action for link in links for action in link.actions]
    return actions + list(step.script.do if step.script else ())


def _possible(figure: FigureChoice, names: Iterable[str]) -> dict[str, Curve]:
    """The presets with these names that the robot can follow."""
    margin, parameters = figure.machine.margin, figure.parameters
    curves = {name: presets()[name].curve for name in names}
    return {n: c for n, c in curves.items() if not curve_faults(margin, raised(c, parameters))}


def _drawings(setup: StepSetup, figure: FigureChoice) -> tuple[str, ...]:
    """What may be drawn besides the robots."""
    names = SWITCHES if "show" in setup.controls else setup.show
    larger = ("larger",) if {"larger", "flexible"} & {*setup.controls} else ()
    zone = ("zone",) if "editor" in setup.controls else ()
    return (*names, *larger, *zone)


def view_field(name: str, value: float | bool, words: Words) -> FormField:
    """The field of something in the picture.

    Args:
        value: of the step.
    """
    if name not in SETTINGS:
        return drawing_field(name, words, mark=bool(value))
    setting = SETTINGS[name]
    return setting_field(name, setting.spec, words, default=setting.default, mark=value)


def _expanded(controls: Iterable[str]) -> list[str]:
    """The controls, with their parameters in place of a group."""
    return [name for control in controls for name in STANDS_FOR.get(control, (control,))]


def _used(actions: Iterable[Action]) -> Used:
    """The values that actions give to parameters."""
    used = dict[str, tuple[Any, ...]]()
    for action in actions:
        for name, value in (action.set or {}).items():
            used[name] = (*used.get(name, ()), value)
    return used


def _changing(
    figure: FigureChoice, names: Iterable[str], used: Used
) -> tuple[FigureChoice, SettingNumbers]:
    """The figure on whose page as many of some parameters change as can, and where they act."""
    left = tuple(name for name in names if len(page_values(figure, name, used)) > 1)
    while True:
        figure = replace(figure, changing=left)
        numbers = setting_numbers(figure, used)
        if numbers.names >= {*left}:
            return figure, numbers
        left = tuple(name for name in left if name in numbers.names)
