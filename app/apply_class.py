"""What a teacher's commands do to a student's lab; with these, `apply` knows all commands."""

from __future__ import annotations

from typing import TYPE_CHECKING

from app import class_commands as c
from app import commands
from app.apply_lesson import apply
from app.setups import restore

if TYPE_CHECKING:
    from app.session import Session

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
    session.hush()
    _tell(session)


@apply.register(c.TakeSetup)
def _(command: c.TakeSetup, session: Session) -> None:
    if session.lessons.lesson is not None:
        session.lessons.close(session)
    restore(session, command.setup)
    session.running = True
    session.say(session.lessons.words("class.setup"))
    _tell(session)


@apply.register(c.TakeStep)
def _(command: c.TakeStep, session: Session) -> None:
    session.lessons.open_at(command.lesson, command.step, session)
    session.say(session.lessons.words("class.step"))
    _tell(session)


@apply.register(c.Tell)
def _(command: c.Tell, session: Session) -> None:
    command.to(session)


def _tell(session: Session) -> None:
    """Whoever finds the lab standing still reads why."""
    if session.frozen:
        session.say(session.lessons.words("class.frozen"), "warning")
