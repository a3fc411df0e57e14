"""What a teacher asks of a student's lab. No widget of a student's page makes these."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

from onpath.app.lab.command import Command
from onpath.app.lab.commands.path import finish
from onpath.app.lab.setup import Setup

if TYPE_CHECKING:
    from onpath.app.lab.session import Session


@dataclass(frozen=True, slots=True)
class Freeze(Command):
    """Stop time and refuse the student's commands; or let all go on."""

    from_teacher: ClassVar[bool] = True
    on: bool

    def apply(self, session: Session) -> None:
        """See `Command.apply`."""
        if self.on == session.frozen:
            return
        if self.on:
            session.grips.release()
            if session.editor.proposed is not None:  # a point is being dragged
                finish(session)
        session.frozen = self.on
        session.clear_message()
        _tell(session)


@dataclass(frozen=True, slots=True)
class TakeSetup(Command):
    """Set the lab up so, in the free lab or in the step that is open."""

    from_teacher: ClassVar[bool] = True
    setup: Setup

    def apply(self, session: Session) -> None:
        """See `Command.apply`."""
        run = session.lessons
        run.take(self.setup, session)
        text = run.words("class.setup" if run.lesson is None else "class.setup_in_step")
        session.show_message(text)
        _tell(session)


@dataclass(frozen=True, slots=True)
class TakeStep(Command):
    """Open a step of a lesson, from wherever the student is."""

    from_teacher: ClassVar[bool] = True
    lesson: str
    step: int

    def apply(self, session: Session) -> None:
        """See `Command.apply`."""
        run = session.lessons
        elsewhere = run.lesson is not None and run.progress.lesson != self.lesson
        run.open_at(self.lesson, self.step, session)
        session.show_message(run.words("class.step_elsewhere" if elsewhere else "class.step"))
        _tell(session)


@dataclass(frozen=True, slots=True)
class ReportState(Command):
    """Tell how the lab is now to somebody who must not keep it waiting."""

    from_teacher: ClassVar[bool] = True
    to: Callable[[Session], None]

    def apply(self, session: Session) -> None:
        """See `Command.apply`."""
        self.to(session)


def _tell(session: Session) -> None:
    """Whoever finds the lab standing still reads why."""
    if session.frozen:
        session.show_message(session.lessons.words("class.frozen"), "warning")
