"""Faults of a lesson as a whole: missing kinds of steps, incomplete steps, revealed answers."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Sequence

from onpath.lessons.safe_html import safe
from onpath.lessons.schema import (
    Choice,
    Derivation,
    Front,
    NumberQuestion,
    OpenQuestion,
    Quiz,
    Sketch,
    Step,
    StepKind,
    Text,
)
from onpath.lessons.task_schema import Task

NEEDED: tuple[StepKind, ...] = ("play", "predict", "run", "explain", "task")
"""Each lesson has at least one step of each of these kinds that is not optional."""


def lacks(
    steps: Sequence[Step], broken: Collection[int] = (), needed: Collection[StepKind] = NEEDED
) -> Iterator[tuple[int, str]]:
    """Missing kinds of steps and incomplete steps: line and problem of each.

    Args:
        broken: first lines of the steps in which a block could not be read.
        needed: kinds of which there must be a step that is not optional.
    """
    kinds = [step.kind for step in steps if not step.optional]
    for kind in needed:
        if kind not in kinds:
            optional = any(step.kind == kind for step in steps)
            yield 1, f"the lesson has no step `# {kind}: …`" + " that is not optional" * optional
    for step, after in zip(steps, [*steps[1:], None], strict=False):
        if step.line not in broken:
            for fault in _step_lacks(step, after):
                yield step.line, f"step {step.title!r}{fault}"


def _step_lacks(step: Step, after: Step | None) -> Iterator[str]:
    if step.kind == "predict" and not any(isinstance(b, Choice | Sketch) for b in step.blocks):
        yield " has no prediction"
    if step.kind == "predict" and _told_late(step):
        yield ": text stands after its prediction; what it says is needed before"
    if step.kind == "predict" and (after is None or after.kind != "run"):
        yield ": a `run` step must follow"
    elif step.kind == "predict" and after is not None and after.optional != step.optional:
        yield ": the `run` step after it must be optional, too, or neither of them"
    if step.kind == "run" and step.script is None:
        yield " has no script"
    if step.kind != "run" and step.script is not None:
        yield f": a script stands in a `run` step, and this is a `{step.kind}` step"
    if step.kind == "quiz" and not any(isinstance(b, Asked) for b in step.blocks):
        yield " has no question: a quiz, number, open or derivation block"
    if step.kind == "task" and not any(isinstance(b, Task) for b in step.blocks):
        yield " has no task"


def _told_late(step: Step) -> bool:
    """Whether text, other than folds and what depends on an answer, stands after a prediction."""
    asked = [at for at, block in enumerate(step.blocks) if isinstance(block, Choice | Sketch)]
    return any(
        isinstance(block, Text) and not block.when and FOLDED.sub("", block.html).strip()
        for block in step.blocks[min(asked, default=len(step.blocks)) :]
    )


Asked = Quiz | NumberQuestion | OpenQuestion | Derivation
FOLDED = re.compile(r"<details>.*?</details>", re.DOTALL)


def order_faults(steps: Sequence[Step], broken: Collection[int] = ()) -> Iterator[tuple[int, str]]:
    """Predictions that do not fit the steps before or after them: line and fault of each.

    Args:
        broken: as in `lacks`.
    """
    for index, step in enumerate(steps):
        after = steps[index + 1] if index + 1 < len(steps) else None
        for prediction in step.predictions():
            if isinstance(prediction, Sketch) and after is not None and after.line not in broken:
                yield from ((step.line, fault) for fault in _length_faults(prediction, after))
            for hidden in prediction.hidden:
                yield from (
                    (s.line, f) for s, f in _revealed_before(hidden, steps[: index + 1], step)
                )


def first_page_faults(front: Front, steps: Sequence[Step]) -> Iterator[str]:
    """Faults of the front matter that reveal what a prediction hides."""
    for name in ("title", "summary", "needs", "goals"):
        words = safe(getattr(front, name)).striptags()
        for step in steps:
            for hidden in (each for asked in step.predictions() for each in asked.hidden):
                if _contains(words, hidden):
                    yield f"{name}: {hidden!r} is told before step {step.title!r} asks for it"


def _contains(text: str, hidden: str) -> bool:
    """Whether a text contains hidden words."""
    word = rf"(?<!\w){re.escape(' '.join(hidden.split()))}(?!\w)"
    return bool(hidden.strip()) and re.search(word, text, re.IGNORECASE) is not None


def _length_faults(sketch: Sketch, run: Step) -> Iterator[str]:
    if run.kind == "run" and run.script is not None and run.script.until != sketch.seconds:
        yield (
            f"seconds = {sketch.seconds:g}: the sketch is {sketch.seconds:g} s long, and the run"
            f" after it, {run.title!r}, {run.script.until:g} s"
        )


def _revealed_before(hidden: str, steps: Sequence[Step], asked: Step) -> Iterator[tuple[Step, str]]:
    """The steps up to a prediction whose text reveals what it hides."""
    for step in steps:
        blocks = [block.html for block in step.blocks if isinstance(block, Text)]
        words = safe(FOLDED.sub(" ", "".join([*blocks, step.watch]))).striptags()
        if _contains(f"{step.title} {words}", hidden):
            yield (
                step,
                f"{hidden!r} is told before step {asked.title!r} asks for it; put it in a fold",
            )
