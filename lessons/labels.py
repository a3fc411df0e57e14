"""Displayed names of what a task checks: parameters, their options, paths and robots."""

from __future__ import annotations

from onpath.lessons.sides import law_label
from onpath.lessons.words import Words
from onpath.models.control.laws.own import OWN
from onpath.models.control.settable import specs
from onpath.models.control.sides import DEFAULT_LAWS
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.parameters import Parameters

OTHERS = {
    "path": "check.path",
    "robot": "check.robot",
    "length": "check.length",
    "start": "check.start",
    "wall": "check.wall",
}
"""Settings other than parameters and laws: name -> key of its label."""


def setting_label(name: str, parameters: Parameters, words: Words) -> str:
    """Displayed name of a setting: a parameter, one of `OTHERS`, or the law of a side."""
    spec = specs(parameters).get(name)
    if spec is not None:
        return words.get(f"parameter.{name}.label", spec.label)
    return words(f"side.{name}") if name in DEFAULT_LAWS else words(OTHERS[name])


def value_label(name: str, value: object, words: Words) -> str:
    """Displayed value of a setting; see `setting_label` for its name."""
    if isinstance(value, int | float):
        return words.written(f"{value:.4g}") if isinstance(value, float) else str(value)
    text = str(value)
    if name in DEFAULT_LAWS:
        return law_label(text, words)
    if name == "path":
        return words("check.own_path") if text == OWN else words.get(f"path.{text}", text)
    if name == "robot" and text in ROBOTS:
        return words.get(f"machine.{text}.label", ROBOTS[text].label)
    return words.get(f"parameter.{name}.option.{text}", text)


def event_label(event: str, detail: str, parameters: Parameters, words: Words) -> str:
    """Displayed name of what an event has changed, such as K1 by "set"."""
    if event == "set":
        return setting_label(detail, parameters, words)
    return law_label(detail, words) if event == "law" else value_label(event, detail, words)
