"""What every command has in common; the commands themselves are in `app.lab.commands`."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

if TYPE_CHECKING:
    from onpath.app.lab.session import Session


class Command:
    """Something that is asked of a lab: a frozen record that knows how to apply itself.

    Widgets, keys, the mouse and the teacher's page make commands in any thread; `Session.post`
    takes them, and the simulation thread applies them at the beginning of its next frame. Numbers
    are checked when a command is applied, and nowhere later.

    Attributes:
        from_teacher: whether a teacher asks it of a student's lab, which it may even while that
            is frozen.
        lets_time_run: whether a locked lab refuses it.
    """

    __slots__ = ()
    from_teacher: ClassVar[bool] = False
    lets_time_run: ClassVar[bool] = False

    def apply(self, session: Session) -> None:
        """Do it, in the simulation thread.

        Raises:
            ValueError: it makes no sense now; the message tells the user why.
        """
        raise NotImplementedError
