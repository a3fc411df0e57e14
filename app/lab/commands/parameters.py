"""Commands that choose the robot and its parameters."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from onpath.app.lab.identify import identify_model
from onpath.app.lab.lab import Command, Lab
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.parameters import changed, unknown_name


@dataclass(frozen=True, slots=True)
class SetParameter(Command):
    """Set one field of the parameters.

    Attributes:
        name: a field of `models.systems.parameters.Parameters`.
        value: in the unit of its `Spec`; `changed` checks name, type and range.
    """

    name: str
    value: Any

    def apply(self, lab: Lab) -> None:
        """See `Command.apply`."""
        session, before = lab.session, lab.session.parameters
        session.set_parameters(changed(before, self.name, self.value))
        if session.parameters != before:
            session.note("set", self.name)


@dataclass(frozen=True, slots=True)
class ResetParameters(Command):
    """Set all parameters to their defaults."""

    def apply(self, lab: Lab) -> None:
        """See `Command.apply`."""
        lab.session.set_parameters(lab.session.entry.lab)


@dataclass(frozen=True, slots=True)
class Identify(Command):
    """Give the controllers the model identified from the follower's recent motion."""

    def apply(self, lab: Lab) -> None:
        """See `Command.apply`."""
        session, history = lab.session, lab.session.history.all()
        found, said = identify_model(session.robot, session.parameters, history, lab.words)
        session.set_parameters(found)
        session.note("identify")
        lab.show_message(said)


@dataclass(frozen=True, slots=True)
class ChooseRobot(Command):
    """Choose another robot; its previous path and parameters, or the defaults, are restored."""

    name: str

    def apply(self, lab: Lab) -> None:
        """See `Command.apply`."""
        if self.name not in ROBOTS:
            raise unknown_name(self.name, list(ROBOTS), "robot")
        if ROBOTS[self.name] is not lab.session.entry:
            lab.session.choose_robot(ROBOTS[self.name])
            lab.show_message("")
