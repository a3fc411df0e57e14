"""Commands that hold the robots back or pull at their end-points."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from typing_extensions import override

from onpath.app.lab.commands import checks
from onpath.app.lab.external_forces import displaced
from onpath.app.lab.lab import Command, Lab
from onpath.app.lab.simulation import Simulation
from onpath.models.arrays import Array
from onpath.models.control.sides import RIGHT, SIDES


@dataclass(frozen=True, slots=True)
class Hold(Command):
    """Hold end-points back, or release them; None toggles.

    Attributes:
        side: whose end-point, and with `LabSettings.copy` the other, too; None means both.
    """

    on: bool | None = None
    side: str | None = None

    @override
    def apply(self, lab: Lab) -> None:
        lab.return_to_present()
        simulation, names = lab.simulation, list[str](SIDES)
        if self.side is not None:
            names = simulation.targets(checks.side(self.side))
        on = not simulation.forces.held.intersection(names) if self.on is None else self.on
        direction = simulation.settings.hold_direction
        simulation.forces.hold(names, on, simulation.editor.curve, direction)


@dataclass(frozen=True, slots=True, eq=False)
class Grab(Command):
    """Pull a robot's end-point towards a target.

    Attributes:
        target: in the robot's output space, shape (p,), [m]; not in the path's plane,
            because the flexible arm can also be pulled within a horizontal plane.
    """

    side: str
    target: Array

    @override
    def apply(self, lab: Lab) -> None:
        name = checks.side(self.side)
        target = checks.point(self.target, lab.simulation.robot.system.p)
        lab.return_to_present()
        _grab(lab, name, target)


@dataclass(frozen=True, slots=True)
class Release(Command):
    """Release the end-points; with a side, only if that robot's is being pulled."""

    side: str | None = None

    @override
    def apply(self, lab: Lab) -> None:
        if self.side is None or checks.side(self.side) == lab.simulation.forces.grabbed:
            lab.simulation.forces.release()


@dataclass(frozen=True, slots=True)
class MoveHand(Command):
    """Move the pulling hand by a small step in the path's plane, [m]; grab first if necessary."""

    right: float
    up: float

    @override
    def apply(self, lab: Lab) -> None:
        by = np.array([checks.finite(self.right), checks.finite(self.up)])
        lab.return_to_present()
        simulation, forces = lab.simulation, lab.simulation.forces
        name = forces.grabbed or RIGHT
        target = forces.hands.get(name, simulation.runs[name].shown()["y"])
        _grab(lab, name, displaced(simulation.robot.frame, target, by))


def _grab(lab: Lab, name: str, target: Array) -> None:
    simulation = lab.simulation
    simulation.forces.grab(name, target, simulation.targets(name))
    if not simulation.running:
        locked = lab.locked
        text = lab.words.sentence(locked) if locked else lab.words("say.pull_paused")
        lab.show_message(text, holds=lambda: _pulls_in_vain(simulation))


def _pulls_in_vain(simulation: Simulation) -> bool:
    return bool(simulation.forces.hands) and not simulation.running
