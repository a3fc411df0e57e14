"""The checks of a task as data for a page, with their words; see assets/web/lessons/checks.ts."""

from __future__ import annotations

from collections.abc import Iterable
from functools import singledispatch
from typing import Any

import msgspec

from onpath.lessons.checks import (
    bound_words,
    compare_words,
    event_named,
    event_words,
    setting_wanted,
    stat_words,
)
from onpath.lessons.labels import setting_label, value_label
from onpath.lessons.measures.responses import unit_of
from onpath.lessons.record import ROBOTS as ROLES
from onpath.lessons.sides import robot_names
from onpath.lessons.task_schema import (
    Better,
    Bound,
    Check,
    Compare,
    Event,
    Once,
    Only,
    Order,
    Setting,
    Task,
)
from onpath.lessons.words import Words
from onpath.models.control.laws.own import OWN
from onpath.models.control.laws.registry import LAWS
from onpath.models.control.settable import specs, values_of
from onpath.models.control.sides import DEFAULT_LAWS
from onpath.models.paths.path_design import presets
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.parameters import Parameters

MESSAGES = {
    "check.bound": ("robot", "stat", "during", "value", "unit", "wanted"),
    "check.compare": ("larger", "stat", "during", "ratio", "wanted"),
    "check.better": ("robot", "stat", "during", "value", "before"),
    "check.once": (
        *("robot", "stat", "during", "value", "unit", "wanted"),
        *("setting", "equals", "least"),
    ),
    "check.broken": ("time",),
    "check.seconds": ("have", "need"),
    "check.nothing": ("robot", "stat", "during", "seconds", "wanted"),
    "check.event": ("event", "have", "need"),
    "check.order": ("events",),
    "check.setting": ("name", "value", "wanted"),
    "check.only": ("others",),
    "check.stopped": ("robot",),
}
"""Messages of the checks, with the names of the values that the page fills in."""


def check_words(words: Words) -> dict[str, str]:
    """The messages of the checks, with places for their values."""
    return words.unfilled(MESSAGES) | {"point": words("report.point")}


def task_data(
    task: Task, parameters: Parameters, laws: dict[str, str], words: Words
) -> dict[str, Any]:
    """A task for a page.

    Args:
        parameters, laws: parameters and laws of the step's set-up.
    """
    robots = robot_names(laws, words)
    checks, ways = (
        [check_data(check, parameters, robots, words) for check in some]
        for some in (task.check, [way.when for way in task.way])
    )
    data = {"id": task.id, "best": task.best, "checks": checks, "ways": ways}
    data["hints"] = len(task.hints)
    return data | ({"exploratory": True} if task.exploratory else {})


def check_data(
    check: Check, parameters: Parameters, robots: dict[Any, str], words: Words
) -> dict[str, Any]:
    """A check with all its fields, and `phrases`: those of its words that do not change.

    Args:
        robots: displayed names of the robots.
    """
    return {**msgspec.to_builtins(check), **_more(check, parameters, robots, words)}


@singledispatch
def _more(check: Check, parameters: Parameters, robots: dict[Any, str], words: Words) -> Any:
    raise TypeError(f"no such check: {check!r}")


@_more.register
def _(check: Bound, parameters: Parameters, robots: dict[Any, str], words: Words) -> Any:
    return {"phrases": {**bound_words(check, robots, words), "need": words.number(check.least)}}


@_more.register
def _(check: Compare, parameters: Parameters, robots: dict[Any, str], words: Words) -> Any:
    (smaller,) = set(ROLES) - {check.larger}
    phrases = {
        **compare_words(check, robots, words),
        "smaller": robots[smaller],
        "need": words.number(check.least),
    }
    return {"smaller": smaller, "phrases": phrases}


@_more.register
def _(check: Better, parameters: Parameters, robots: dict[Any, str], words: Words) -> Any:
    phrases = {
        "robot": robots[check.robot],
        "stat": stat_words(check.stat, check.quantity, words),
        "during": words(f"during.{check.during}"),
        "unit": unit_of(check.stat, check.quantity),
        "need": words.number(check.least),
    }
    return {"phrases": phrases}


@_more.register
def _(check: Once, parameters: Parameters, robots: dict[Any, str], words: Words) -> Any:
    setting = Setting(name=check.name, equals=check.equals)
    phrases = {
        **bound_words(check, robots, words),
        "setting": setting_label(check.name, parameters, words),
        "equals": value_label(check.name, check.equals, words),
        "least": words.number(check.least),
    }
    since = [msgspec.to_builtins(event_named(text)) for text in check.since]
    return {
        "since": since,
        "setting": check_data(setting, parameters, robots, words),
        "phrases": phrases,
    }


@_more.register
def _(check: Event, parameters: Parameters, robots: dict[Any, str], words: Words) -> Any:
    since = [msgspec.to_builtins(event_named(text)) for text in check.since]
    return {"since": since, "phrases": {"event": event_words(check, parameters, words)}}


@_more.register
def _(check: Order, parameters: Parameters, robots: dict[Any, str], words: Words) -> Any:
    events = [event_named(text) for text in check.events]
    return {
        "events": [
            {"event": e.event, "name": e.name, "phrase": event_words(e, parameters, words)}
            for e in events
        ]
    }


@_more.register
def _(check: Only, parameters: Parameters, robots: dict[Any, str], words: Words) -> Any:
    every = (*specs(parameters), *DEFAULT_LAWS, "path", "robot")
    return {"labels": {name: setting_label(name, parameters, words) for name in every}}


@_more.register
def _(check: Setting, parameters: Parameters, robots: dict[Any, str], words: Words) -> Any:
    spec = specs(parameters).get(check.name)
    equals, wanted = setting_wanted(check, words)
    present = values_of(parameters).get(check.name)
    options = _named(check.name) if spec is None else spec.options
    return {
        "equals": equals,
        "whole": isinstance(present, int),
        "phrases": {"name": setting_label(check.name, parameters, words), "wanted": wanted},
        "labels": {str(value): value_label(check.name, value, words) for value in options},
    }


def _named(setting: str) -> Iterable[str]:
    """The values of a setting that is not a parameter, if they have names."""
    if setting in DEFAULT_LAWS:
        return (*LAWS, OWN)
    return {"path": (*presets(), OWN), "robot": ROBOTS}.get(setting, ())
