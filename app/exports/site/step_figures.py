"""The figure of a step: its set-up, what readers may change, and what only the lab has."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Any

from onpath.app.exports.site.settings_places import Unsupported
from onpath.app.exports.site.step_actions import Act, link_acts, script_acts
from onpath.app.exports.standalone.figure_choice import FigureChoice, check_slider, chosen
from onpath.app.exports.standalone.figure_data import figure_data, slider_data, stop_texts
from onpath.lessons.action_schema import Action, Script, StepSetup
from onpath.lessons.labels import setting_label
from onpath.lessons.record import QUANTITIES
from onpath.lessons.schema import Lesson, Step, Text
from onpath.lessons.sides import ROLES, law_titles, robot_names
from onpath.lessons.task_schema import Better, Once, Reference, Task
from onpath.lessons.words import Words
from onpath.models.closed_loop.lab_settings import SETTINGS, lab_specs
from onpath.models.closed_loop.simulation import raised
from onpath.models.control.settable import specs
from onpath.models.control.sides import DEFAULT_LAWS, SIDES
from onpath.models.paths.curve_faults import curve_faults
from onpath.models.paths.curves import Curve
from onpath.models.paths.path_design import presets

ALWAYS = ("pull", "run", "step", "reset", "plot")
"""Controls that every step of the lab has."""
MOST = 8  # figures in the cache; those of one lesson follow each other
_SHARED: dict[Any, dict[str, Any]] = {}


@dataclass(frozen=True, slots=True)
class StepFigure:
    """A step's figure.

    Attributes:
        choice: what it shows.
        lacking: names of the step's controls that only the lab has.
        drawings: what is drawn besides the robots, in the lab.
        plots: that the step shows besides that of the distance.
        faithful: whether the figure begins where the lab does; only then is it shown.
        changing: names of the parameters that sliders, links or the script change.
    """

    choice: FigureChoice
    lacking: tuple[str, ...]
    drawings: tuple[str, ...]
    plots: tuple[str, ...]
    faithful: bool
    changing: frozenset[str]

    def script(self, script: Script | None) -> dict[str, Any] | None:
        """A script as data; None if there is none, or only the lab can play it."""
        if script is None or not self.faithful:
            return None
        try:
            return script_acts(script, self.choice)
        except Unsupported:
            return None

    def link(self, actions: Iterable[Action]) -> list[Act] | None:
        """The actions of a link as data; None if only the lab can do them."""
        if not self.faithful:
            return None
        try:
            return link_acts(actions, self.choice)
        except Unsupported:
            return None

    def can_pass(self, task: Task, reference: Reference, links: Iterable[Action]) -> bool:
        """Whether a reader has everything that the task's reference solution uses."""
        if any(isinstance(check, Better | Once) for check in task.check):
            return False
        within_reach = {*self.choice.sliders}
        for action in links:
            if self.link([action]) is not None:
                within_reach |= set(action.set or {})
        for action in reference.solution.do:
            if action.hold is not None and "hold" not in self.choice.controls:
                return False
            if not set(action.set or {}) <= within_reach or action.only:
                return False
        measured = {getattr(check, "quantity", "distance") for check in task.evaluated}
        return self.script(reference.solution) is not None and measured <= set(self.quantities)

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


def step_figure(lesson: Lesson, index: int) -> StepFigure:
    """The figure of a step.

    Raises:
        ValueError: a figure cannot show its set-up.
    """
    scene, step = lesson.scene_at(index), lesson.steps[index]
    robot = scene.robot or lesson.front.robot
    laws = tuple({**DEFAULT_LAWS, **scene.laws.named}.values())
    first, *others = _paths(lesson, index, scene)
    curves = {first: presets()[first].curve}
    controls = (*ALWAYS, "hold") if "hold" in scene.controls else ALWAYS
    if step.kind == "predict":
        controls = ()
    own = [name for name in scene.set if name in SETTINGS]
    parameters = {name: value for name, value in scene.set.items() if name not in SETTINGS}
    bare = chosen(robot, laws, curves, parameters, sliders=(), controls=controls)
    bare = replace(bare, paths={**curves, **_possible(bare, others)})
    known = specs(type(bare.parameters))
    sliders = tuple(n for n in scene.controls if n in known and _slides(bare, n))
    lacking = {name: None for name in scene.controls if name not in (*sliders, "hold")}
    if scene.show:
        lacking.pop("show", None)
    elif scene.marks:
        lacking["show"] = None
    lacking |= dict.fromkeys(own)
    if scene.start.numbers:
        lacking["start"] = None
    figure = replace(bare, sliders=sliders)
    set_by = (name for action in _actions(step) for name in action.set or {})
    changing = frozenset((*sliders, *set_by))
    return StepFigure(
        choice=figure,
        lacking=tuple(lacking),
        drawings=scene.show,
        plots=scene.plots,
        faithful=not scene.start.numbers and not own,
        changing=changing,
    )


def figure_of(figure: StepFigure, words: Words) -> dict[str, Any]:
    """The data of a step's figure, with its module of kernels as Base64."""
    data, choice = _shared_data(figure.choice, words), figure.choice
    curve = next(iter(choice.paths.values()))
    stops = [
        stop_texts(choice, law, curve, "alpha" in figure.changing, words)
        for law in choice.every_law
    ]
    return {
        **data,
        "laws": [
            {**law, "stops": texts, **names}
            for law, texts, names in zip(data["laws"], stops, _names(choice, words), strict=True)
        ],
        "sliders": [slider_data(choice, name, words) for name in choice.sliders],
        "controls": choice.controls,
        "names": choice.sliders,
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
    """The data of a figure without sliders and controls, which many steps share."""
    key = choice.robot, choice.laws, tuple(choice.paths), choice.parameters, words.language
    if key not in _SHARED:
        while len(_SHARED) >= MOST:
            _SHARED.pop(next(iter(_SHARED)))
        _SHARED[key] = figure_data(replace(choice, sliders=(), controls=()), words)
    return _SHARED[key]


def lacking_words(figure: StepFigure, words: Words) -> str:
    """What a step has only in the lab, in words; empty if nothing."""
    known = lab_specs(type(figure.choice.parameters))
    named = [
        setting_label(name, figure.choice.parameters, words)
        if name in known
        else words(f"site.control.{name}")
        for name in figure.lacking
    ]
    named += [words(f"show.{name}") for name in figure.drawings]
    return ", ".join(named)


def _paths(lesson: Lesson, index: int, scene: StepSetup) -> list[str]:
    """The step's path, and those that its links and script choose."""
    actions = _actions(lesson.steps[index])
    paths = [scene.path or "circle", *(action.path for action in actions if action.path)]
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


def _slides(figure: FigureChoice, name: str) -> bool:
    try:
        check_slider(figure, name)
    except ValueError:
        return False
    return True
