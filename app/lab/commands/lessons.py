"""Commands of a student who goes through the lessons."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from onpath.app.lab.command import Command
from onpath.lessons.progress import Answer
from onpath.lessons.schema import Action

if TYPE_CHECKING:
    from onpath.app.lab.session import Session


@dataclass(frozen=True, slots=True)
class OpenLesson(Command):
    """Open a lesson where it was left."""

    name: str

    def apply(self, session: Session) -> None:
        """See `Command.apply`."""
        session.lessons.open(self.name, session)


@dataclass(frozen=True, slots=True)
class CloseLesson(Command):
    """Go back to the lab as it was before the lesson."""

    def apply(self, session: Session) -> None:
        """See `Command.apply`."""
        session.lessons.close(session)


@dataclass(frozen=True, slots=True)
class GoToStep(Command):
    """Go to another step of the open lesson, `by` so many from the present one."""

    by: int

    def apply(self, session: Session) -> None:
        """See `Command.apply`."""
        session.lessons.go(int(self.by), session)


@dataclass(frozen=True, slots=True)
class Predict(Command):
    """Commit to a prediction: an option, or a curve; with neither, skip it."""

    option: int | None = None
    times: tuple[float, ...] = ()
    values: tuple[float, ...] = ()

    def apply(self, session: Session) -> None:
        """See `Command.apply`."""
        session.lessons.predict(Answer(self.option, self.times, self.values), session)


@dataclass(frozen=True, slots=True)
class PlayStep(Command):
    """Let the lab do what the step shows."""

    def apply(self, session: Session) -> None:
        """See `Command.apply`."""
        session.lessons.play(session)


@dataclass(frozen=True, slots=True)
class BeginStepAnew(Command):
    """Set the lab up again as the step wants it."""

    def apply(self, session: Session) -> None:
        """See `Command.apply`."""
        session.lessons.begin_anew(session)


@dataclass(frozen=True, slots=True)
class ShowHint(Command):
    """Show one hint more."""

    task: str

    def apply(self, session: Session) -> None:
        """See `Command.apply`."""
        session.lessons.hint(self.task)


@dataclass(frozen=True, slots=True)
class AnswerQuiz(Command):
    """Choose an option of a question; `block` is its place in the step."""

    block: int
    option: int

    def apply(self, session: Session) -> None:
        """See `Command.apply`."""
        session.lessons.answer_quiz(self.block, self.option)


@dataclass(frozen=True, slots=True)
class Act(Command):
    """Do what a link in the text says."""

    actions: tuple[Action, ...]

    def apply(self, session: Session) -> None:
        """See `Command.apply`."""
        session.lessons.act(self.actions, session)


@dataclass(frozen=True, slots=True)
class SetLanguage(Command):
    """Set the language of texts and interface."""

    language: str

    def apply(self, session: Session) -> None:
        """See `Command.apply`."""
        session.lessons.set_language(self.language)
        if session.locked:
            session.locked = session.lessons.words("lesson.locked")
        session.clear_message()


@dataclass(frozen=True, slots=True)
class SetPresenting(Command):
    """Set large type for a projector, or not."""

    on: bool

    def apply(self, session: Session) -> None:
        """See `Command.apply`."""
        session.lessons.set_presenting(bool(self.on))
