"""Commands that hold the robots back or pull at their end-points."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from typing_extensions import override

from onpath.app.lab.commands import checks
from onpath.app.lab.external_forces import displaced
from onpath.app.lab.lab import Command, Lab
from onpath.models.arrays import Array
from onpath.models.closed_loop.obstacles import check_direction
from onpath.models.control.benches import BENCHES, RIGHT


@dataclass(frozen=True, slots=True)
class Hold(Command):
    """Hold end-points back, or release them; None toggles.

    Attributes:
        bench: whose end-point; None means both. See `SetCopy`.
    """

    on: bool | None = None
    bench: str | None = None

    @override
    def apply(self, lab: Lab) -> None:
        lab.return_to_present()
        session, names = lab.session, list[str](BENCHES)
        if self.bench is not None:
            names = session.targets(checks.bench(self.bench))
        on = not session.grips.held.intersection(names) if self.on is None else self.on
        session.grips.hold(names, on, session.editor.curve, session.hold_direction)


@dataclass(frozen=True, slots=True)
class SetHoldDirection(Command):
    """Choose the direction in which brakes act; one that is on is applied anew where it is.

    Attributes:
        direction: one of `models.closed_loop.obstacles.DIRECTIONS`.
    """

    direction: str

    @override
    def apply(self, lab: Lab) -> None:
        direction = check_direction(self.direction)
        lab.return_to_present()
        session = lab.session
        session.hold_direction, held = direction, sorted(session.grips.held)
        session.grips.hold(held, False, session.editor.curve)
        session.grips.hold(held, True, session.editor.curve, direction)


@dataclass(frozen=True, slots=True, eq=False)
class Grab(Command):
    """Pull a robot's end-point towards a target.

    Attributes:
        target: in the robot's output space, shape (p,), [m]; not in the path's plane,
            because the flexible arm can also be pulled within a horizontal plane.
    """

    bench: str
    target: Array

    @override
    def apply(self, lab: Lab) -> None:
        name = checks.bench(self.bench)
        target = checks.point(self.target, lab.session.robot.system.p)
        lab.return_to_present()
        lab.session.grips.grab(name, target, lab.session.targets(name))


@dataclass(frozen=True, slots=True)
class Release(Command):
    """Release the end-points; with a bench, only if that robot's is being pulled."""

    bench: str | None = None

    @override
    def apply(self, lab: Lab) -> None:
        if self.bench in (None, lab.session.grips.grabbed):
            lab.session.grips.release()


@dataclass(frozen=True, slots=True)
class MoveHand(Command):
    """Move the pulling hand by a small step in the path's plane, [m]; grab first if necessary."""

    right: float
    up: float

    @override
    def apply(self, lab: Lab) -> None:
        by = np.array([checks.finite(self.right), checks.finite(self.up)])
        lab.return_to_present()
        session, grips = lab.session, lab.session.grips
        name = grips.grabbed or RIGHT
        target = grips.hands.get(name, session.runs[name].shown()["y"])
        grips.grab(name, displaced(session.robot.frame, target, by), session.targets(name))


@dataclass(frozen=True, slots=True)
class SetCopy(Command):
    """Set whether pulling and holding act on both robots."""

    on: bool

    @override
    def apply(self, lab: Lab) -> None:
        lab.session.copy = bool(self.on)
