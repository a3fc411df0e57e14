"""A part of a step as data for a page's script; see assets/web/core/lesson_data.ts."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import msgspec

from onpath.app.steps.step_html import StepPart
from onpath.lessons.action_schema import Script
from onpath.lessons.checks import bound_words
from onpath.lessons.derivation.judged import LineState, points_of
from onpath.lessons.derivation.typed import spellings
from onpath.lessons.given import Answer
from onpath.lessons.progress import Truth
from onpath.lessons.record import QUANTITIES, ROBOTS
from onpath.lessons.schema import Choice, Derivation, Lesson, NumberQuestion, Quiz, Sketch
from onpath.lessons.sides import robot_names
from onpath.lessons.task_schema import Bound, Task
from onpath.lessons.words import Words


def block_data(part: StepPart, lesson: Lesson, index: int, words: Words) -> dict[str, Any]:
    """What every page needs; what is right only if the part has its answers.

    Args:
        index: of the step.
    """
    block, data = part.block, dict[str, Any](kind=part.kind)
    if isinstance(block, Sketch):
        data |= sketch_data(block, lesson.laws_shown(index), words)
        if part.told:
            data["features"] = [msgspec.to_builtins(each) for each in block.features]
    elif isinstance(block, Choice | Quiz) and part.told:
        data["right"] = [option.right for option in block.options].index(True)
    elif isinstance(block, NumberQuestion) and part.told:
        wrong = [each.number for each in block.wrong]
        data |= {"number": block.number, "tolerance": block.tolerance, "wrong": wrong}
    elif isinstance(block, Derivation):
        data |= derivation_data(block, part.states)
    elif isinstance(block, Task):
        data["limits"] = limits_data(block, lesson.laws_shown(index), words)
    counts = not (isinstance(block, Choice) or (isinstance(block, Quiz) and block.warm_up))
    if isinstance(block, Quiz) and not counts:
        data["uncounted"] = True
    if isinstance(block, Choice | Quiz) and block.second is not None:
        data["followed"] = True
    if part.second is not None:
        data["second"] = block_data(part.second, lesson, index, words)
        data["second"] |= {} if counts else {"uncounted": True}
    return data


def derivation_data(block: Derivation, states: Sequence[LineState] | None) -> dict[str, Any]:
    """How formulas may be typed, and either what has become of each line, or how it is judged."""
    data = dict[str, Any](known=spellings(block.names))
    if states is not None:
        return data | {"states": [msgspec.to_builtins(each) for each in states]}
    lines = [
        {
            "name": line.name,
            "formula": line.formula,
            "tolerance": line.tolerance,
            "wrong": [each.formula for each in line.wrong],
        }
        for line in block.line
    ]
    values = {name: each.tolist() for name, each in points_of(block).items()}
    return data | {"lines": lines, "values": values}


PLOTS = {"torque": "torques"} | {
    name: name
    for name in ("distance", "speed", "rate", "place", "across", "across_rate", "deflection")
}
PLOTS |= {"energy": "energy"}
"""Quantity of a check -> plot that shows it."""
BESIDE = ("settling", "overshoot")
"""Statistics whose bounds are none of the plotted quantity."""


def limits_data(task: Task, laws: dict[str, str], words: Words) -> list[dict[str, Any]]:
    """What a task wants of plotted quantities; see `LimitData` in the page's script."""
    robots = robot_names(laws, words)
    return [
        {
            "plot": PLOTS[check.quantity],
            "below": check.below,
            "above": check.above,
            "side": ROBOTS.index(check.robot),
            "label": f"{robots[check.robot]}: {bound_words(check, robots, words)['wanted']}",
        }
        for check in task.check
        if isinstance(check, Bound) and check.quantity in PLOTS and check.stat not in BESIDE
    ]


def sketch_data(block: Sketch, laws: dict[str, str], words: Words) -> dict[str, Any]:
    """The axes of a sketch, and the names of the robots.

    Args:
        laws: control laws under which the prediction is tested.
    """
    names = ("quantity", "robot", "seconds", "top", "bottom")
    return {
        "kind": "sketch",
        **{name: getattr(block, name) for name in names},
        "unit": QUANTITIES[block.quantity],
        "robots": list(robot_names(laws, words).values()),
        "label": words(f"quantity.{block.quantity}"),
    }


def script_data(script: Script) -> dict[str, Any]:
    """When a script holds and pulls, for the chart of its run."""
    acts = [(each.at, msgspec.to_builtins(each)) for each in script.do]
    names = ("hold", "pull", "release", "reset", "path")
    return {
        "until": script.until,
        "do": [(at, {n: act[n] for n in names if act.get(n) is not None}) for at, act in acts],
    }


def answer_data(answer: Answer) -> dict[str, Any]:
    """What was chosen or drawn; nothing for a prediction that was skipped."""
    if answer.option is not None:
        return {"option": answer.option}
    return {"times": answer.times, "values": answer.values} if answer.times else {}


class Curves(msgspec.Struct, frozen=True):
    """The same quantity of both robots over time, [s]."""

    times: Sequence[float]
    tracker: Sequence[float]
    follower: Sequence[float]


def curves_data(truth: Truth) -> Curves:
    """The curves of both robots."""
    return Curves(truth.times, truth.tracker, truth.follower)
