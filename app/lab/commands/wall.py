"""Commands that move and turn the wall by mouse and keys, in the path's plane."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from typing_extensions import override

from onpath.app.lab.commands.checks import finite, point
from onpath.app.lab.lab import Command, Lab
from onpath.models.arrays import Array
from onpath.models.closed_loop.lab_settings import settings_of_wall
from onpath.models.closed_loop.obstacles import FARTHEST, Wall
from onpath.models.paths.curves import Curve

CUT = 0.2  # share of the path's height that a new wall cuts off
TURN = math.radians(5.0)  # [rad] per press of a key


def first_wall(curve: Curve) -> Wall:
    """A wall that cuts off the top of a path, solid above."""
    z = curve.plan.at(curve.sample(64))
    low, high = z.min(axis=0), z.max(axis=0)
    middle = (low[0] + high[0]) / 2
    return _wall(np.array([middle, high[1] - CUT * (high[1] - low[1])]), -math.pi / 2)


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
            _put(lab, _wall(target, now.angle))


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
            angle = math.atan2(ahead[1], ahead[0]) - math.pi / 2
            _put(lab, _wall(now.place, angle))


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
            _put(lab, first_wall(lab.simulation.editor.curve))
            return
        _put(lab, _wall(now.place + by, now.angle + turn))


def _put(lab: Lab, wall: Wall) -> None:
    """Put a wall in the robots' way, in the present."""
    lab.return_to_present()
    lab.simulation.set(**settings_of_wall(wall))


def _wall(place: Array, angle: float) -> Wall:
    """A wall as near to a place as it may be, with its angle from -π to π."""
    z1, z2 = np.clip(place, -FARTHEST, FARTHEST).tolist()
    return Wall(z1, z2, math.remainder(angle, 2 * math.pi))
