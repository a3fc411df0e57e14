"""Converts the Markdown in the parts of a lesson to safe HTML."""

from __future__ import annotations

from functools import singledispatch
from typing import Any

from msgspec.structs import replace

from onpath.lessons.formulas import to_html
from onpath.lessons.kept.option_keys import fingerprint
from onpath.lessons.schema import (
    Choice,
    Derivation,
    Front,
    NumberQuestion,
    OpenQuestion,
    Option,
    Quiz,
    SecondTry,
    Sketch,
)
from onpath.lessons.task_schema import Task


@singledispatch
def rendered(part: Any) -> Any:
    """The same part with its texts as HTML.

    Raises:
        TextError: see `onpath.lessons.formulas.to_html`.
        TypeError: it is not a part of a lesson.
    """
    raise TypeError(f"no part of a lesson: {part!r}")


@rendered.register
def _(part: Front) -> Front:
    points = tuple(map(to_html, part.takeaway))
    return replace(_html(part, "needs", "goals", "misconception"), takeaway=points)


@rendered.register
def _(part: Sketch) -> Sketch:
    return _html(part, "question", "usual", "answer", "ask")


@rendered.register
def _(part: Choice) -> Choice:
    return replace(
        _html(part, "question", "ask"), options=_options(part), second=_second(part.second)
    )


@rendered.register
def _(part: Quiz) -> Quiz:
    return replace(
        _html(part, "question", "misconception"),
        options=_options(part),
        second=_second(part.second),
    )


@rendered.register
def _(part: NumberQuestion) -> NumberQuestion:
    wrong = tuple(_html(each, "answer") for each in part.wrong)
    return replace(_html(part, "question", "answer"), wrong=wrong)


@rendered.register
def _(part: OpenQuestion) -> OpenQuestion:
    return _html(part, "question", "answer")


@rendered.register
def _(part: Derivation) -> Derivation:
    lines = tuple(
        replace(
            _html(line, "question", "answer"),
            wrong=tuple(_html(each, "answer") for each in line.wrong),
        )
        for line in part.line
    )
    return replace(_html(part, "question", "answer"), line=lines)


@rendered.register
def _(part: Task) -> Task:
    return replace(
        _html(part, "text", "passed"),
        hints=tuple(map(to_html, part.hints)),
        way=tuple(_html(way, "passed") for way in part.way),
    )


def _html(part: Any, *names: str) -> Any:
    return replace(part, **{name: to_html(getattr(part, name)) for name in names})


def _second(part: SecondTry | None) -> SecondTry | None:
    if part is None:
        return None
    return replace(_html(part, "question", "answer"), options=_options(part))


def _options(part: Choice | Quiz | SecondTry) -> tuple[Option, ...]:
    return tuple(
        Option(
            text=to_html(option.text),
            answer=to_html(option.answer),
            right=option.right,
            key=option.key or fingerprint(option.text),
        )
        for option in part.options
    )
