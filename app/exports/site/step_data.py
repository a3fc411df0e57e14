"""A step of a lesson for its page: the texts as HTML, the rest as data."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from msgspec.structs import replace

from onpath.app.exports.site.step_figures import StepFigure, figure_of, lacking_words, step_figure
from onpath.app.exports.site.task_data import task_data
from onpath.lessons.adaptive.branches import answers_meant
from onpath.lessons.adaptive.own_numbers import filled, marked
from onpath.lessons.progress import Notes
from onpath.lessons.record import QUANTITIES
from onpath.lessons.schema import (
    KINDS,
    Block,
    Choice,
    Lesson,
    NumberQuestion,
    Quiz,
    Sketch,
    Step,
    Text,
)
from onpath.lessons.sides import robot_names
from onpath.lessons.task_schema import Reference, Setting, Task
from onpath.lessons.words import Words
from onpath.models.control.settable import values_of


@dataclass(frozen=True, slots=True)
class SiteBlock:
    """A part of a step.

    Attributes:
        kind: see `onpath.lessons.schema.KINDS`.
        here: whether a task can be done on the page; True for other parts.
    """

    kind: str
    block: Block
    here: bool = True


@dataclass(frozen=True, slots=True)
class SiteStep:
    """A step of a lesson.

    Attributes:
        number: number of the step, from 1.
        blocks: parts of the step.
        data: data for the page's script; see assets/web/lesson_data.ts.
        figure: data of the step's figure; empty if only the lab can show it.
        lacking: what only the lab has here, in words; may be empty.
        lab_only: whether its run can only be seen in the lab.
    """

    number: int
    step: Step
    blocks: list[SiteBlock]
    data: dict[str, Any]
    figure: dict[str, Any]
    lacking: str
    lab_only: bool


def site_step(
    lesson: Lesson, index: int, references: dict[str, Reference], words: Words
) -> SiteStep:
    """The step for its page."""
    step, figure = lesson.steps[index], step_figure(lesson, index)
    links = [link for block in step.blocks if isinstance(block, Text) for link in block.links]
    actions = [action for link in links for action in link.actions]
    blocks = [
        SiteBlock(
            KINDS[type(block)],
            _unpersonal(block, lesson, index, words),
            not isinstance(block, Task) or figure.can_pass(block, references[block.id], actions),
        )
        for block in step.blocks
    ]
    script = figure.script(step.script)
    data = {
        "kind": step.kind,
        "optional": step.optional,
        "running": lesson.scene_at(index).running,
        "script": script,
        "values": _values(step, figure),
        "blocks": [_block(each, lesson, index, i, figure, words) for i, each in enumerate(blocks)],
    }
    lab_only = step.script is not None and script is None
    return SiteStep(
        number=index + 1,
        step=step,
        blocks=blocks,
        data=data,
        figure=figure_of(figure, words) if figure.faithful else {},
        lacking=lacking_words(figure, words),
        lab_only=lab_only,
    )


def _unpersonal(block: Block, lesson: Lesson, index: int, words: Words) -> Block:
    """A block whose text has the default of each of the student's own numbers, and marks it."""
    if not isinstance(block, Text):
        return block
    html = marked(block.html, lesson.steps, index)
    return replace(block, html=filled(html, lesson.steps, index, Notes(), words))


def _values(step: Step, figure: StepFigure) -> dict[str, Any]:
    """The settings that the step's tasks check, as they are when the step begins."""
    parameters, choice = figure.choice.parameters, figure.choice
    scene: dict[str, Any] = {
        "path": next(iter(choice.paths)),
        "robot": choice.robot,
        "left": choice.laws[0],
        "right": choice.laws[1],
        "lengths": [1e3 * curve.length() for curve in choice.paths.values()],
        "paths": list(choice.paths),
    }
    names = [c.name for task in step.tasks() for c in task.check if isinstance(c, Setting)]
    values = values_of(parameters)
    known = {name: values[name] for name in (*names, *choice.sliders) if name in values}
    return {**known, **scene}


def _block(
    part: SiteBlock, lesson: Lesson, index: int, place: int, figure: StepFigure, words: Words
) -> dict[str, Any]:
    block, laws = part.block, lesson.laws_shown(index)
    data: dict[str, Any] = {"kind": part.kind}
    if isinstance(block, Text):
        data["links"] = [figure.link(link.actions) for link in block.links]
        if block.when:
            data["when"] = answers_meant(block.when, lesson.steps, index, place)
    elif isinstance(block, Sketch):
        names = robot_names(laws, words)
        data |= {name: getattr(block, name) for name in ("quantity", "seconds", "top", "bottom")}
        data |= {"unit": QUANTITIES[block.quantity], "robots": list(names.values())}
        data["label"] = words(f"quantity.{block.quantity}")
    elif isinstance(block, Choice | Quiz):
        data["right"] = [option.right for option in block.options].index(True)
    elif isinstance(block, NumberQuestion):
        data |= {"number": block.number, "tolerance": block.tolerance}
    elif isinstance(block, Task) and part.here:
        data |= task_data(block, figure.choice.parameters, lesson.scene_at(index).laws.named, words)
    return data
