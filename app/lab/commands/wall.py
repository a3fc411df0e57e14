"""Commands that place, move, turn and remove the wall, in the path's plane."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from typing_extensions import override

from onpath.app.lab.commands.checks import finite, point
from onpath.app.lab.lab import Command, Lab
from onpath.models.arrays import Array
from onpath.models.closed_loop.obstacles import FARTHEST, Wall
from onpath.models.paths.curves import Curve

CUT = 0.2  # share of the path's height that a new wall cuts off
TURN = math.radians(5.0)  # [rad], step of a key


def first_wall(curve: Curve) -> Wall:
    """A wall that cuts off the top of a path, solid above."""
    z = curve.plan.at(curve.sample(64))
    low, high = z.min(axis=0), z.max(axis=0)
    middle = (low[0] + high[0]) / 2
    return _wall(np.array([middle, high[1] - CUT * (high[1] - low[1])]), -math.pi / 2)


@dataclass(frozen=True, slots=True)
class SetWall(Command):
    """Put a wall across the top of the path, or remove the wall; None toggles."""

    on: bool | None = None

    @override
    def apply(self, lab: Lab) -> None:
        simulation = lab.simulation
        on = simulation.wall is None if self.on is None else bool(self.on)
        if on != (simulation.wall is not None):
            lab.return_to_present()
            simulation.set_wall(first_wall(simulation.editor.curve) if on else None)


@dataclass(frozen=True, slots=True, eq=False)
class MoveWall(Command):
    """Move the wall, if there is one, without turning it.

    Attributes:
        target: new place of its middle, shape (2,), [m].
    """

    target: Array

    @override
    def apply(self, lab: Lab) -> None:
        target, now = point(self.target, 2), lab.simulation.wall
        if now is not None:
            lab.return_to_present()
            lab.simulation.set_wall(_wall(target, now.angle))


@dataclass(frozen=True, slots=True, eq=False)
class SwingWall(Command):
    """Turn the wall, if there is one, about its middle until one end points at a target.

    Attributes:
        end: 1 for the end to the left of its normal, -1 for the other.
        target: shape (2,), [m].
    """

    end: int
    target: Array

    @override
    def apply(self, lab: Lab) -> None:
        target, now = point(self.target, 2), lab.simulation.wall
        if now is None:
            return
        ahead = (target - now.place) * (1 if self.end > 0 else -1)
        if np.linalg.norm(ahead) > 1e-3:
            lab.return_to_present()
            angle = math.atan2(ahead[1], ahead[0]) - math.pi / 2
            lab.simulation.set_wall(_wall(now.place, angle))


@dataclass(frozen=True, slots=True)
class NudgeWall(Command):
    """Move and turn the wall by small steps; put one there first if there is none.

    Attributes:
        right, up: [m].
        turn: counter-clockwise, [rad].
    """

    right: float = 0.0
    up: float = 0.0
    turn: float = 0.0

    @override
    def apply(self, lab: Lab) -> None:
        by, turn = np.array([finite(self.right), finite(self.up)]), finite(self.turn)
        now = lab.simulation.wall
        if now is None:
            SetWall(True).apply(lab)
            return
        lab.return_to_present()
        lab.simulation.set_wall(_wall(now.place + by, now.angle + turn))


@dataclass(frozen=True, slots=True)
class PlaceWall(Command):
    """Give the wall a place, [m], and the angle of its normal, [rad]; None leaves one unchanged."""

    first: float | None = None
    second: float | None = None
    angle: float | None = None

    @override
    def apply(self, lab: Lab) -> None:
        now = lab.simulation.wall
        if now is None:
            return
        old, new = (now.z1, now.z2, now.angle), (self.first, self.second, self.angle)
        values = [o if n is None else finite(n) for o, n in zip(old, new, strict=True)]
        lab.return_to_present()
        lab.simulation.set_wall(_wall(np.array(values[:2]), values[2]))


def _wall(place: Array, angle: float) -> Wall:
    """A wall as near to a place as it may be, with its angle from -π to π."""
    z1, z2 = np.clip(place, -FARTHEST, FARTHEST).tolist()
    return Wall(z1, z2, math.remainder(angle, 2 * math.pi))
