"""Commands that choose the robot and its parameters."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from onpath.app.lab.command import Command
from onpath.app.lab.identify import identify_model
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.parameters import changed, unknown_name

if TYPE_CHECKING:
    from onpath.app.lab.session import Session


@dataclass(frozen=True, slots=True)
class SetParameter(Command):
    """Set one field of the parameters.

    Attributes:
        name: a field of `models.systems.parameters.Parameters`.
        value: in the unit of its `Spec`; `changed` checks name, type and range.
    """

    name: str
    value: Any

    def apply(self, session: Session) -> None:
        """See `Command.apply`."""
        before = session.parameters
        session.set_parameters(changed(before, self.name, self.value))
        if session.parameters != before:
            session.note("set", self.name)


@dataclass(frozen=True, slots=True)
class ResetParameters(Command):
    """Set all parameters to their defaults."""

    def apply(self, session: Session) -> None:
        """See `Command.apply`."""
        session.set_parameters(session.entry.lab)


@dataclass(frozen=True, slots=True)
class Identify(Command):
    """Give the controllers the model identified from the follower's last seconds."""

    def apply(self, session: Session) -> None:
        """See `Command.apply`."""
        identify_model(session)
        session.note("identify")


@dataclass(frozen=True, slots=True)
class ChooseRobot(Command):
    """Choose another robot; path and parameters are those that it had before, or its defaults."""

    name: str

    def apply(self, session: Session) -> None:
        """See `Command.apply`."""
        if self.name not in ROBOTS:
            raise unknown_name(self.name, list(ROBOTS), "robot")
        session.choose_robot(ROBOTS[self.name])
