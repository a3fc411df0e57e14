"""How long a lesson takes, estimated from its files.

The sum of the words at 130 a minute, the durations of the runs, and a fixed time for each thing
that is drawn, chosen, answered or done. Folded texts, hints, answers to wrong options, and texts
for some answers only are not counted: they need not be read. A formula has as many words as letters
and numbers. The minutes of a lesson are those of its steps that are not optional; the optional ones
are given separately.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from functools import singledispatch
from html import unescape

from onpath.lessons.schema import (
    KINDS,
    Block,
    Choice,
    Derivation,
    Lesson,
    NumberQuestion,
    OpenQuestion,
    Quiz,
    Sketch,
    Step,
    Text,
)
from onpath.lessons.task_schema import Task

WORDS = 130
"""Words read in a minute."""
MINUTES = {
    "play": 2.0,
    "sketch": 1.0,
    "choice": 0.5,
    "quiz": 0.5,
    "task": 3.0,
    "number": 1.0,
    "open": 1.0,
    "derivation": 0.0,
}
"""Assumed time for each kind of activity, beyond reading."""
LINE = 1.0
"""The same for each line of a derivation."""
PAGE = 300
"""Most words of a page that is read in one go."""
FOLDED = re.compile(r"<details>.*?</details>", re.DOTALL)
TAG = re.compile(r"<[^>]*>")


@dataclass(frozen=True, slots=True)
class Minutes:
    """Estimated duration of a step or a lesson, in minutes, by kind of activity."""

    reading: float = 0.0
    runs: float = 0.0
    predictions: float = 0.0
    tasks: float = 0.0

    @property
    def total(self) -> float:
        """The whole duration."""
        return self.reading + self.runs + self.predictions + self.tasks


def word_count(html: str) -> int:
    """Number of words of an HTML text, without its folded parts."""
    words = unescape(TAG.sub(" ", FOLDED.sub(" ", html))).split()
    return sum(any(letter.isalnum() for letter in word) for word in words)


def page_words(step: Step) -> int:
    """Number of words that a step shows before anything is answered, without its folded parts."""
    return sum(map(word_count, [step.watch, *(text for b in step.blocks for text in _shown(b))]))


def _shown(block: Block) -> list[str]:
    if isinstance(block, Text):
        return _for_all(block)
    if isinstance(block, Task):
        return [block.text]
    options = block.options if isinstance(block, Choice | Quiz) else ()
    return [block.question, *(option.text for option in options)]


def long_pages(lesson: Lesson) -> list[tuple[Step, int]]:
    """The steps with more words than `PAGE`, and how many they have."""
    counted = [(step, page_words(step)) for step in lesson.steps]
    return [(step, words) for step, words in counted if words > PAGE]


def step_minutes(step: Step) -> Minutes:
    """Estimated duration of a step: its text, its run, and what the student does in it.

    What to watch is read while the run plays.
    """
    asked = [block for block in step.blocks if not isinstance(block, Text | Task)]
    read = [text for block in step.blocks for text in _read(block)]
    tried = MINUTES["play"] if step.kind == "play" else 0.0
    return Minutes(
        reading=sum(map(word_count, read)) / WORDS,
        runs=0.0 if step.script is None else step.script.seconds / 60,
        predictions=sum(map(_answering, asked)),
        tasks=MINUTES["task"] * len(step.tasks()) + tried,
    )


def _for_all(block: Text) -> list[str]:
    """The text, unless it is shown after some answers only."""
    return [] if block.when else [block.html]


def _answering(block: Block) -> float:
    lines = len(block.line) if isinstance(block, Derivation) else 0
    return MINUTES[KINDS[type(block)]] + LINE * lines


def together(parts: Iterable[Minutes]) -> Minutes:
    """The sum of some durations."""
    every = list(parts)
    return Minutes(
        reading=sum(part.reading for part in every),
        runs=sum(part.runs for part in every),
        predictions=sum(part.predictions for part in every),
        tasks=sum(part.tasks for part in every),
    )


def required_minutes(lesson: Lesson) -> Minutes:
    """Estimated duration of a lesson without its optional steps."""
    return together(step_minutes(step) for step in lesson.steps if not step.optional)


def optional_minutes(lesson: Lesson) -> Minutes:
    """Estimated duration of the optional steps of a lesson."""
    return together(step_minutes(step) for step in lesson.steps if step.optional)


def lesson_minutes(lesson: Lesson) -> int:
    """Whole minutes of a lesson without its optional steps."""
    return max(1, round(required_minutes(lesson).total))


@singledispatch
def _read(block: Block) -> list[str]:
    """The texts of a part of a step that a student reads."""
    raise TypeError(f"no such block: {block!r}")


@_read.register
def _(block: Text) -> list[str]:
    return _for_all(block)


@_read.register
def _(block: Sketch) -> list[str]:
    return [block.question, *block.reasons]


@_read.register(NumberQuestion)
@_read.register(OpenQuestion)
def _(block: NumberQuestion | OpenQuestion) -> list[str]:
    return [block.question, block.answer]


@_read.register
def _(block: Derivation) -> list[str]:
    lines = [text for line in block.line for text in (line.question, line.answer)]
    return [block.question, *lines, block.answer]


@_read.register(Choice)
@_read.register(Quiz)
def _(block: Choice | Quiz) -> list[str]:
    right = [option.answer for option in block.options if option.right]
    reasons = block.reasons if isinstance(block, Choice) else ()
    return [block.question, *(option.text for option in block.options), *right, *reasons]


@_read.register
def _(block: Task) -> list[str]:
    return [block.text, block.passed]
