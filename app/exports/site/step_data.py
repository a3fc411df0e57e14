"""A step of a lesson for its page: the texts as HTML, the rest as data."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from onpath.app.common.templates import Markup
from onpath.app.exports.site.step_figures import StepFigure, figure_of, lacking_words, step_figure
from onpath.app.exports.site.task_data import task_data
from onpath.app.steps.block_data import block_data
from onpath.app.steps.step_html import StepPart, part_of, predicted_second, step_html
from onpath.lessons.adaptive.branches import answers_meant
from onpath.lessons.schema import Lesson, Step, Text
from onpath.lessons.task_schema import Once, Reference, Setting, Task
from onpath.lessons.words import Words
from onpath.models.control.laws.own import short_name
from onpath.models.control.settable import value_of, values_of


@dataclass(frozen=True, slots=True)
class SiteStep:
    """A step of a lesson.

    Attributes:
        number: number of the step, from 1.
        html: its column; see `onpath.app.steps`.
        data: data for the page's script; see assets/web/core/lesson_data.ts.
        figure: data of the step's figure.
        remade: parameter that makes another robot -> its value -> data of the figure with it.
        lab_only: whether its run can only be seen in the lab.
    """

    number: int
    html: Markup
    data: dict[str, Any]
    figure: dict[str, Any]
    remade: dict[str, dict[str, dict[str, Any]]]
    lab_only: bool


def site_step(
    lesson: Lesson, index: int, references: dict[str, Reference], words: Words
) -> SiteStep:
    """The step for its page."""
    step, figure = lesson.steps[index], step_figure(lesson, index)
    links = [link for block in step.blocks if isinstance(block, Text) for link in block.links]
    actions = [action for link in links for action in link.actions]
    parts = [
        part_of(
            lesson,
            index,
            block_index,
            words,
            here=not isinstance(block, Task)
            or figure.can_pass(block, references[block.id], actions),
        )
        for block_index, block in enumerate(step.blocks)
    ]
    second = predicted_second(lesson, index)
    script, lacking = figure.script(step.script), lacking_words(figure, words)
    data = {
        "kind": step.kind,
        "optional": step.optional,
        "running": lesson.setup_at(index).running,
        "script": script,
        "values": _values(step, figure),
        "plots": figure.plots,
        "onlyLab": lacking,
        "blocks": [_block(part, lesson, index, figure, words) for part in parts],
    }
    lab_only = step.script is not None and script is None
    html = step_html(
        lesson,
        index,
        [second, *parts] if second else parts,
        words,
        plays=script is not None,
        lacking=", ".join(f"{name} ({why})" if why else name for name, why in lacking.items()),
    )
    shown, parameters = figure_of(figure, words), figure.choice.parameters
    return SiteStep(
        number=index + 1,
        html=html,
        data=data,
        figure=shown,
        remade={
            name: {
                str(value): shown
                if value == value_of(parameters, name)
                else figure_of(step_figure(lesson, index, {name: value}), words)
                for value in values
            }
            for name, values in figure.choice.remade.items()
        },
        lab_only=lab_only,
    )


def _values(step: Step, figure: StepFigure) -> dict[str, Any]:
    """The settings that the step's tasks check, as they are when the step begins."""
    parameters, choice = figure.choice.parameters, figure.choice
    others: dict[str, Any] = {
        "path": next(iter(choice.paths)),
        "robot": choice.robot,
        "left": short_name(choice.laws[0]),
        "right": short_name(choice.laws[1]),
        "lengths": [1e3 * curve.length() for curve in choice.paths.values()],
        "paths": list(choice.paths),
    }
    checks = [check for task in step.tasks() for check in task.evaluated]
    names = [check.name for check in checks if isinstance(check, Setting | Once)]
    values = values_of(parameters)
    known = {
        name: values[name] for name in (*names, *choice.sliders, *choice.changing) if name in values
    }
    return {**known, **others}


def _block(
    part: StepPart, lesson: Lesson, index: int, figure: StepFigure, words: Words
) -> dict[str, Any]:
    block, data = part.block, block_data(part, lesson, index, words)
    if isinstance(block, Text):
        data["links"] = [figure.link(link.actions) for link in block.links]
        if block.when:
            data["when"] = answers_meant(block.when, lesson.steps, index, part.block_index)
    elif isinstance(block, Task) and part.here:
        data |= task_data(block, figure.choice.parameters, lesson.setup_at(index).laws.named, words)
    return data
