"""Displayed names of parameters, their units and options, of paths and of robots."""

from __future__ import annotations

from onpath.lessons.sides import law_label
from onpath.lessons.words import Words
from onpath.models.closed_loop.lab_settings import lab_specs
from onpath.models.control.laws.own import OWN
from onpath.models.control.sides import DEFAULT_LAWS
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.efforts import stated
from onpath.models.systems.parameter_specs import Spec
from onpath.models.systems.parameters import Parameters
from onpath.models.systems.robots import RobotEntry

OTHERS = {
    "path": "check.path",
    "robot": "check.robot",
    "length": "check.length",
    "start": "check.start",
    "wall": "check.wall",
}
"""Settings other than parameters and laws: name -> key of its label."""


def parameter_label(name: str, spec: Spec, words: Words) -> str:
    """Displayed name of a parameter."""
    return words.get(f"parameter.{name}.label", spec.label)


def parameter_unit(name: str, spec: Spec, words: Words) -> str:
    """Unit of a parameter; empty if it has none."""
    return words.get(f"parameter.{name}.unit", spec.unit)


def parameter_help(name: str, spec: Spec, words: Words) -> str:
    """Help text of a parameter."""
    return words.get(f"parameter.{name}.help", spec.help)


def option_label(name: str, option: object, words: Words) -> str:
    """Displayed name of one of a parameter's options."""
    return words.get(f"parameter.{name}.option.{option}", str(option).replace("_", " "))


def path_label(name: str, words: Words) -> str:
    """Displayed name of a path; a user's own keeps its name."""
    return words.get(f"path.{name}", name)


def robot_label(name: str, words: Words) -> str:
    """Displayed name of a robot in the catalogue."""
    return words.get(f"machine.{name}.label", ROBOTS[name].label)


def robot_text(entry: RobotEntry, words: Words) -> str:
    """What a robot is, with the torque limits that its file states."""
    translated = words.get(f"machine.{entry.name}.text", "")
    if not translated or entry.source is None:
        return translated or entry.text
    limits = stated(entry.source.chain)
    return translated if limits is None else f"{translated} {words.sentence(limits)}"


def setting_label(name: str, parameters: Parameters, words: Words) -> str:
    """Displayed name of a parameter, one of the lab's own settings or `OTHERS`, or a side's law.

    Args:
        parameters: of the robot; a lesson may name a parameter that only another robot has.
    """
    if name in DEFAULT_LAWS:
        return words(f"side.{name}")
    if name in OTHERS:
        return words(OTHERS[name])
    others = [entry.parameters for entry in tuple(ROBOTS.values())]
    declared = (lab_specs(each) for each in (parameters, *others))
    return parameter_label(name, next(each[name] for each in declared if name in each), words)


def value_label(name: str, value: object, words: Words) -> str:
    """Displayed value of a setting; see `setting_label` for its name."""
    if isinstance(value, bool):
        return words("form.is_on" if value else "form.off")
    if isinstance(value, int | float):
        return words.written(f"{value:.4g}") if isinstance(value, float) else str(value)
    text = str(value)
    if name in DEFAULT_LAWS:
        return law_label(text, words)
    if name == "path":
        return words("check.own_path") if text == OWN else path_label(text, words)
    if name == "robot" and text in ROBOTS:
        return robot_label(text, words)
    return option_label(name, text, words)


def event_label(event: str, detail: str, parameters: Parameters, words: Words) -> str:
    """Displayed name of what an event has changed, such as K1 by "set"."""
    if event == "set":
        return setting_label(detail, parameters, words)
    return law_label(detail, words) if event == "law" else value_label(event, detail, words)
