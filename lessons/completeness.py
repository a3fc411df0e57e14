"""What a lesson lacks as a whole: kinds of steps, parts of a step, and marks that contradict."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Sequence

from markupsafe import Markup

from onpath.lessons.schema import Choice, Sketch, Step, Text
from onpath.lessons.task_schema import Task

NEEDED = ("play", "predict", "run", "explain", "task")
"""Kinds of steps of which each lesson has one that is not optional."""


def lacks(steps: Sequence[Step], broken: Collection[int] = ()) -> Iterator[str]:
    """Problems of the lesson: missing kinds of steps, repeated ids, incomplete steps.

    Args:
        broken: lines at which steps begin of which a block could not be read.
    """
    kinds = [step.kind for step in steps if not step.optional]
    for kind in NEEDED:
        if kind not in kinds:
            optional = any(step.kind == kind for step in steps)
            yield f"the lesson has no step `# {kind}: …`" + " that is not optional" * optional
    ids = [task.id for step in steps for task in step.tasks()]
    for repeated in {task for task in ids if ids.count(task) > 1}:
        yield f"two tasks have the id {repeated!r}"
    for step, after in zip(steps, [*steps[1:], None], strict=False):
        if step.line not in broken:
            for fault in _step_lacks(step, after):
                yield f"step {step.title!r} at line {step.line}{fault}"


def _step_lacks(step: Step, after: Step | None) -> Iterator[str]:
    if step.kind == "predict" and not any(isinstance(b, Choice | Sketch) for b in step.blocks):
        yield " has no prediction"
    if step.kind == "predict" and (after is None or after.kind != "run"):
        yield ": a `run` step must follow"
    elif step.kind == "predict" and after is not None and after.optional != step.optional:
        yield ": the `run` step after it must be optional, too, or neither of them"
    if step.kind == "run" and step.script is None:
        yield " has no script"
    if step.kind == "task" and not any(isinstance(b, Task) for b in step.blocks):
        yield " has no task"


FOLDED = re.compile(r"<details>.*?</details>", re.DOTALL)


def order_faults(steps: Sequence[Step], broken: Collection[int] = ()) -> Iterator[tuple[int, str]]:
    """Lines and faults of predictions that do not suit what comes before or after them.

    Args:
        broken: as in `lacks`.
    """
    for index, step in enumerate(steps):
        after = steps[index + 1] if index + 1 < len(steps) else None
        for prediction in step.predictions():
            if isinstance(prediction, Sketch) and after is not None and after.line not in broken:
                yield from ((step.line, fault) for fault in _length_faults(prediction, after))
            for told in prediction.hidden:
                yield from ((s.line, f) for s, f in _told_before(told, steps[: index + 1], step))


def _length_faults(sketch: Sketch, run: Step) -> Iterator[str]:
    if run.kind == "run" and run.script is not None and run.script.until != sketch.seconds:
        yield (
            f"seconds = {sketch.seconds:g}: the sketch is {sketch.seconds:g} s long, and the run"
            f" after it, {run.title!r}, {run.script.until:g} s"
        )


def _told_before(told: str, steps: Sequence[Step], asked: Step) -> Iterator[tuple[Step, str]]:
    """The steps up to a prediction whose text tells what it hides."""
    word = re.compile(rf"(?<!\w){re.escape(' '.join(told.split()))}(?!\w)", re.IGNORECASE)
    for step in steps:
        blocks = [block.html for block in step.blocks if isinstance(block, Text)]
        words = Markup(FOLDED.sub(" ", "".join(blocks))).striptags()
        if word.search(f"{step.title} {words}") and told.strip():
            yield (
                step,
                f"{told!r} is told before step {asked.title!r} asks for it; put it in a fold",
            )
