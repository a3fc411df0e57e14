"""Commands that run, pause, reset and rewind simulated time, and that say how it is drawn."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

from onpath.app.lab.command import Command
from onpath.app.lab.commands.checks import finite, within
from onpath.app.lab.looking_back import go_on, look_back, return_to_present, undo_going_on
from onpath.app.lab.setup import EXAGGERATIONS, RATES

if TYPE_CHECKING:
    from onpath.app.lab.session import Session


@dataclass(frozen=True, slots=True)
class SetRunning(Command):
    """Run or pause; None toggles."""

    lets_time_run: ClassVar[bool] = True
    running: bool | None = None

    def apply(self, session: Session) -> None:
        """See `Command.apply`."""
        running = not session.running if self.running is None else self.running
        if running:
            return_to_present(session)
        session.running = running


@dataclass(frozen=True, slots=True)
class StepOnce(Command):
    """Make one step of simulated time while paused."""

    lets_time_run: ClassVar[bool] = True

    def apply(self, session: Session) -> None:
        """See `Command.apply`."""
        return_to_present(session)
        session.step_once()


@dataclass(frozen=True, slots=True)
class Reset(Command):
    """Put both robots at the start, at rest; path and parameters stay."""

    def apply(self, session: Session) -> None:
        """See `Command.apply`."""
        session.reset()


@dataclass(frozen=True, slots=True)
class SetRate(Command):
    """Set the simulated seconds per second, one of `RATES` or between them."""

    rate: float

    def apply(self, session: Session) -> None:
        """See `Command.apply`."""
        session.rate = within("speed", self.rate, RATES)


@dataclass(frozen=True, slots=True)
class LookAt(Command):
    """Pause and look at how it was, [s] before now; 0 is now."""

    ago: float

    def apply(self, session: Session) -> None:
        """See `Command.apply`."""
        look_back(session, finite(self.ago))


@dataclass(frozen=True, slots=True)
class LookBack(Command):
    """Look further back, or forward if negative, [s]."""

    by: float

    def apply(self, session: Session) -> None:
        """See `Command.apply`."""
        shown = session.time if session.viewing is None else session.viewing
        look_back(session, session.time - shown + finite(self.by))


@dataclass(frozen=True, slots=True)
class GoOn(Command):
    """Go on from the instant being looked at; what came after it is put aside."""

    lets_time_run: ClassVar[bool] = True

    def apply(self, session: Session) -> None:
        """See `Command.apply`."""
        go_on(session)


@dataclass(frozen=True, slots=True)
class UndoGoOn(Command):
    """Bring back what was put aside last, and put aside what was done instead."""

    def apply(self, session: Session) -> None:
        """See `Command.apply`."""
        undo_going_on(session)


@dataclass(frozen=True, slots=True)
class SetExaggeration(Command):
    """Set how many times larger a deflection is drawn; the simulation does not depend on it."""

    factor: float

    def apply(self, session: Session) -> None:
        """See `Command.apply`."""
        session.exaggeration = within("exaggeration", self.factor, EXAGGERATIONS)
