"""What holds the robots of a lab back, and what pulls at them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Protocol

import numpy as np

from onpath.app.lab.closed_loop_run import ClosedLoopRun
from onpath.models.arrays import Array
from onpath.models.closed_loop.simulation import FREE, Push, brake_at
from onpath.models.control.laws import NAMES
from onpath.models.paths.curves import Curve
from onpath.models.paths.frames import Frame
from onpath.models.systems.robots import Robot

REACH = 0.4  # [m], a hand's target stays within this of the middle


class Note(Protocol):
    """Told what has begun or ended, and who it concerns."""

    def __call__(self, name: str, /, *, controllers: tuple[str, ...]) -> None: ...


def displaced(frame: Frame, y: Array, by: Array) -> Array:
    """A point of the output space, (p,), moved along the path's plane by `by`, (2,), [m]."""
    z = frame.planar(y)
    return y + frame.lift(z + by) - frame.lift(z)


class ExternalForces:
    """Of one run, from reset to reset.

    Args:
        robot: whose end-points are taken.
        runs: by controller.
        note: see `Note`.

    Attributes:
        held: who is held back.
        hands: where hands pull, by controller, in output coordinates, [m].
        grabbed: whose end-point has been taken, or None.
        pushes: what acts on each robot from outside; the same object while nothing changes.
    """

    def __init__(self, robot: Robot, runs: Mapping[str, ClosedLoopRun], note: Note) -> None:
        self._robot, self._runs, self._note = robot, runs, note
        self.held: set[str] = set()
        self.hands: dict[str, Array] = {}
        self.grabbed: str | None = None
        self.pushes: dict[str, Push] = dict.fromkeys(NAMES, FREE)
        self._offsets: dict[str, Array] = {}

    def hold(self, names: Sequence[str], on: bool, curve: Curve) -> None:
        """Begin or end holding robots back, each where it is now along the path."""
        changed = tuple(name for name in names if on != (name in self.held))
        if changed:
            self._note("hold" if on else "let_go", controllers=changed)
        for name in changed:
            (self.held.add if on else self.held.discard)(name)
            brake = None
            if on:
                row = self._runs[name].shown()
                brake = brake_at(self._robot, curve, row["y"], float(row["theta"][0]))
            self.pushes[name] = Push(self.hands.get(name), brake)

    def grab(self, controller: str, target: Array, together: Sequence[str]) -> None:
        """Pull an end-point towards a target, and others by the same displacement.

        Args:
            target: shape (p,), [m].
            together: all of them; what was taken already stays so until it is released.

        Raises:
            ValueError: the target is not finite.
        """
        if not np.isfinite(target).all():
            raise ValueError("the hand's target is not a point")
        if self.grabbed != controller:
            self.release()
            own = self._runs[controller].shown()["y"].copy()
            self.grabbed = controller
            self._offsets = {name: self._runs[name].shown()["y"] - own for name in together}
            self._note("pull", controllers=tuple(self._offsets))
        home = self._robot.frame.lift(np.zeros(2))
        for name, offset in self._offsets.items():
            self.hands[name] = (target + offset).clip(home - REACH, home + REACH)
            self.pushes[name] = Push(self.hands[name], self.pushes[name].hold)

    def release(self) -> None:
        """Let all end-points go; who is held back stays so."""
        if self.hands:
            self._note("release", controllers=tuple(self.hands))
        for name in self.hands:
            self.pushes[name] = Push(None, self.pushes[name].hold)
        self.hands.clear()
        self.grabbed = None
