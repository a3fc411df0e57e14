"""A student's notes with some answers, each given once."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from msgspec.structs import replace

from onpath.lessons.given import Answer, Given
from onpath.lessons.progress import Notes


def notes_with(
    *,
    answers: Mapping[str, Answer] = {},
    second: Mapping[str, Answer] = {},
    quiz: Mapping[str, int] = {},
    numbers: Mapping[str, float] = {},
    written: Mapping[str, str] = {},
    tasks: Mapping[str, float] = {},
    marks: Mapping[str, str] = {},
    attempt: int = 1,
    way: int = 0,
    **more: Any,
) -> Notes:
    """Notes from which `Notes.answers` and the like read these.

    Args:
        second: answers to predictions that are asked again once.
        marks: keys of the chosen options.
        attempt: number of each answer.
        way: in which the tasks were passed.
        more: other fields.
    """
    given = [Given(item, answer=answer) for item, answer in answers.items()]
    given += [Given(item, round=1, answer=answer) for item, answer in second.items()]
    given += [Given(item, answer=Answer(option=option)) for item, option in quiz.items()]
    given += [Given(item, number=number) for item, number in numbers.items()]
    given += [Given(item, text=text) for item, text in written.items()]
    given += [Given(item, number=value, right=True, way=way) for item, value in tasks.items()]
    marked = [replace(each, mark=marks.get(each.item, ""), attempt=attempt) for each in given]
    return Notes(given=tuple(marked), asked_again=tuple(second), **more)
