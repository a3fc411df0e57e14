"""What the lessons' commands do to a session; with these, `apply` knows all commands."""

from __future__ import annotations

from typing import TYPE_CHECKING

from onpath.app.lab import lesson_commands as c
from onpath.app.lab.apply import apply
from onpath.lessons.progress import Answer

if TYPE_CHECKING:
    from onpath.app.lab.session import Session

__all__ = ["apply"]


@apply.register(c.OpenLesson)
def _(command: c.OpenLesson, session: Session) -> None:
    session.lessons.open(command.name, session)


@apply.register(c.CloseLesson)
def _(_: c.CloseLesson, session: Session) -> None:
    session.lessons.close(session)


@apply.register(c.GoToStep)
def _(command: c.GoToStep, session: Session) -> None:
    session.lessons.go(int(command.by), session)


@apply.register(c.Predict)
def _(command: c.Predict, session: Session) -> None:
    session.lessons.predict(Answer(command.option, command.times, command.values), session)


@apply.register(c.PlayStep)
def _(_: c.PlayStep, session: Session) -> None:
    session.lessons.play(session)


@apply.register(c.BeginStepAnew)
def _(_: c.BeginStepAnew, session: Session) -> None:
    session.lessons.begin_anew(session)


@apply.register(c.ShowHint)
def _(command: c.ShowHint, session: Session) -> None:
    session.lessons.hint(command.task)


@apply.register(c.AnswerQuiz)
def _(command: c.AnswerQuiz, session: Session) -> None:
    session.lessons.answer_quiz(command.block, command.option)


@apply.register(c.Act)
def _(command: c.Act, session: Session) -> None:
    session.lessons.act(command.actions, session)


@apply.register(c.SetLanguage)
def _(command: c.SetLanguage, session: Session) -> None:
    session.lessons.set_language(command.language)
    if session.locked:
        session.locked = session.lessons.words("lesson.locked")
    session.clear_message()


@apply.register(c.SetPresenting)
def _(command: c.SetPresenting, session: Session) -> None:
    session.lessons.set_presenting(bool(command.on))
