"""What a teacher's commands do to a student's lab; with these, `apply` knows all commands."""

from __future__ import annotations

from typing import TYPE_CHECKING

from onpath.app.lab import class_commands as c
from onpath.app.lab import commands
from onpath.app.lab.apply_lesson import apply

if TYPE_CHECKING:
    from onpath.app.lab.session import Session

__all__ = ["apply"]


@apply.register(c.Freeze)
def _(command: c.Freeze, session: Session) -> None:
    if command.on == session.frozen:
        return
    if command.on:
        session.grips.release()
        if session.editor.proposed is not None:  # a point is being dragged
            apply(commands.EndMove(), session)
    session.frozen = command.on
    session.clear_message()
    _tell(session)


@apply.register(c.TakeSetup)
def _(command: c.TakeSetup, session: Session) -> None:
    run = session.lessons
    run.take(command.setup, session)
    session.show_message(run.words("class.setup" if run.lesson is None else "class.setup_in_step"))
    _tell(session)


@apply.register(c.TakeStep)
def _(command: c.TakeStep, session: Session) -> None:
    run = session.lessons
    elsewhere = run.lesson is not None and run.progress.lesson != command.lesson
    run.open_at(command.lesson, command.step, session)
    session.show_message(run.words("class.step_elsewhere" if elsewhere else "class.step"))
    _tell(session)


@apply.register(c.ShowMessage)
def _(command: c.ShowMessage, session: Session) -> None:
    command.to(session)


def _tell(session: Session) -> None:
    """Whoever finds the lab standing still reads why."""
    if session.frozen:
        session.show_message(session.lessons.words("class.frozen"), "warning")
