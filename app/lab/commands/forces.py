"""Commands that hold the robots back or pull at their end-points."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from onpath.app.lab.command import Command
from onpath.app.lab.commands import checks
from onpath.app.lab.external_forces import displaced
from onpath.app.lab.looking_back import return_to_present
from onpath.models.arrays import Array
from onpath.models.control.laws import NAMES

if TYPE_CHECKING:
    from onpath.app.lab.session import Session


@dataclass(frozen=True, slots=True)
class Hold(Command):
    """Hold end-points back, or let them go; None toggles.

    Attributes:
        controller: whose; None means both robots. See `SetCopy`.
    """

    on: bool | None = None
    controller: str | None = None

    def apply(self, session: Session) -> None:
        """See `Command.apply`."""
        return_to_present(session)
        names = list[str](NAMES)
        if self.controller is not None:
            names = session.targets(checks.controller(self.controller))
        on = not session.grips.held.intersection(names) if self.on is None else self.on
        session.grips.hold(names, on, session.editor.curve)


@dataclass(frozen=True, slots=True, eq=False)
class Grab(Command):
    """Pull a robot's end-point towards a target.

    Attributes:
        target: in the robot's output space, shape (p,), [m]. It is not in coordinates of the
            path's plane, because the flexible arm is pulled in a horizontal plane, too.
    """

    controller: str
    target: Array

    def apply(self, session: Session) -> None:
        """See `Command.apply`."""
        name = checks.controller(self.controller)
        target = checks.point(self.target, session.robot.system.p)
        return_to_present(session)
        session.grips.grab(name, target, session.targets(name))


@dataclass(frozen=True, slots=True)
class Release(Command):
    """Let the end-points go; with a name, only if that robot's is the one being pulled."""

    controller: str | None = None

    def apply(self, session: Session) -> None:
        """See `Command.apply`."""
        if self.controller in (None, session.grips.grabbed):
            session.grips.release()


@dataclass(frozen=True, slots=True)
class MoveHand(Command):
    """Move the hand by a little in the path's plane, [m]; it takes hold first if need be."""

    right: float
    up: float

    def apply(self, session: Session) -> None:
        """See `Command.apply`."""
        by = np.array([checks.finite(self.right), checks.finite(self.up)])
        return_to_present(session)
        name = session.grips.grabbed or NAMES[-1]
        target = session.grips.hands.get(name, session.runs[name].shown()["y"])
        there = displaced(session.robot.frame, target, by)
        session.grips.grab(name, there, session.targets(name))


@dataclass(frozen=True, slots=True)
class SetCopy(Command):
    """Set whether hand and hold act on both robots."""

    on: bool

    def apply(self, session: Session) -> None:
        """See `Command.apply`."""
        session.copy = bool(self.on)
