"""The open step of a lesson, and what is measured in it."""

from __future__ import annotations

from typing import Annotated, Any

from msgspec import UNSET, Meta, Struct, UnsetType

from onpath.app.steps.block_data import Curves
from onpath.lessons.checks import Verdict


class LessonMessage(Struct, frozen=True, kw_only=True, tag_field="is", tag="lesson"):
    """The open step of a lesson, or its end; when another one is open, or anything is noted in it.
    A teacher's page has none.

    What is right is told only once the student has answered, or has seen what happens; in a test
    never.

    Attributes:
        lesson: its name; empty: no lesson is open, and the other fields but `version` are, too.
        version: changes with every message.
        index: number of the open step, from 0.
        ended: whether the end is shown.
        test: whether it is the concept test.
        playing: whether the lab plays the step's script.
        symbols: names of the lesson's symbols that mean something on this robot, and what they
            mean.
        head, pager: HTML of what stands above and below the text. A button's `data-send` has the
            messages that it sends.
        sections: HTML by number of the step: the open one, and the one whose prediction it shows;
            `end` for the end of a lesson. Both come from `assets/templates/step`, as on the course
            site.
        steps: what the script needs of each step; parts and plots only of those in `sections`.
        notes: the answers of the open step.
        charts: at the end: the curves of each prediction, in the order of the elements
            `[data-chart]`.
    """

    lesson: str
    version: int
    index: int = 0
    ended: bool = False
    test: bool = False
    playing: bool = False
    symbols: dict[str, str] = {}
    head: str = ""
    pager: str = ""
    sections: dict[str, str] = {}
    steps: Annotated[list[dict[str, Any]], Meta(extra={"typescript": "StepData[]"})] = []
    notes: Annotated[dict[str, Any], Meta(extra={"typescript": "Notes"})] | UnsetType = UNSET
    charts: Annotated[list[dict[str, Any]], Meta(extra={"typescript": "ChartData[]"})] = []


class MeasuredMessage(Struct, frozen=True, tag_field="is", tag="measured"):
    """What is measured in the open step of a lesson, at most ten times a second.

    Attributes:
        verdicts: on each check of each task.
        truth: while a script runs: the curves so far of the predicted quantity, three times a
            second; else null.
    """

    verdicts: dict[str, list[Verdict]]
    truth: Curves | None
