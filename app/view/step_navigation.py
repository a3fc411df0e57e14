"""The buttons that lead from the open step to others: next, back, set up again, free lab."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from onpath.app.view.lesson_view import LessonView
from onpath.lessons.concept_test.concept_test import chosen_in

Sent = dict[str, Any]
"""A command as a page's script sends it; see app/lab/commands/command_codec.py."""
NEXT: Sent = {"do": "GoToStep", "by": 1}
BACK: Sent = {"do": "GoToStep", "by": -1}
FINISH: Sent = {"do": "FinishLesson"}
RECORD: Sent = {"is": "make", "file": "report"}
"""Asks for the record of all lessons, which is no command of the lab."""


@dataclass(frozen=True, slots=True)
class LessonButton:
    """A button of a lesson.

    Attributes:
        name: its whole name.
        send: the commands that it sends.
        main: whether it is the step to take now.
        short: what is written on it; the whole name if empty.
    """

    name: str
    send: list[Sent]
    main: bool = False
    short: str = ""


@dataclass(frozen=True, slots=True)
class Pager:
    """The buttons below a step's text.

    Attributes:
        remark: a sentence above them; may be empty.
        forward: on the right.
        back: on the left, if one can go there.
        others: less important ones, in a row above.
    """

    remark: str
    forward: list[LessonButton]
    back: LessonButton | None
    others: list[LessonButton]


def pager_of(run: LessonView) -> Pager:
    """The buttons of the open step, or of the end."""
    words, lesson = run.words, run.lesson
    first = lesson is None or run.beside(-1) == (lesson.name, run.index)
    back = LessonButton(words("lesson.back"), [BACK], short="←")
    if run.ended:
        return Pager("", [], None if run.is_test else back, [])
    remark = _answered(run) if run.is_test else ""
    if not run.may_go(1):
        remark = words("lesson.wait")
    return Pager(
        remark=remark,
        forward=_forward(run) if run.may_go(1) else [],
        back=None if first or not run.may_go(-1) else back,
        others=_past(run) if run.may_go(1) and not run.at_end else [],
    )


def _forward(run: LessonView) -> list[LessonButton]:
    words = run.words
    if run.waits:
        return [LessonButton(words("lesson.skip"), [NEXT], short=words("site.skip_short"))]
    if run.at_end:
        return [
            LessonButton(
                words("test.hand_in" if run.is_test else "lesson.finish"), [FINISH], main=True
            )
        ]
    return [LessonButton(words("lesson.next"), [NEXT], main=True)]


def _past(run: LessonView) -> list[LessonButton]:
    """Past the optional steps that come next; else to the end."""
    past = run.past_optional()
    if past is None or not run.may_go(past):
        return []
    if not past:
        return [LessonButton(run.words("lesson.past_all"), [FINISH])]
    name = run.words("lesson.past_optional", step=run.index + 1 + past)
    return [LessonButton(name, [{"do": "GoToStep", "by": past}])]


def _answered(run: LessonView) -> str:
    """How many questions of the open test are answered."""
    assert run.lesson is not None
    chosen = chosen_in(run.lesson, run.notes)
    part = sum(option is not None for option in chosen)
    return run.words("test.answered", part=part, all=len(chosen))
