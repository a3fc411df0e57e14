"""External forces on the robots of a lab: holding them back, pulling at them, and a wall."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Protocol

import numpy as np

from onpath.app.lab.closed_loop_run import ClosedLoopRun
from onpath.models.arrays import Array
from onpath.models.closed_loop.obstacles import ALONG, Wall, brake_in
from onpath.models.closed_loop.simulation import FREE, Push
from onpath.models.control.sides import SIDES
from onpath.models.paths.curves import Curve
from onpath.models.paths.frames import Frame
from onpath.models.systems.robots import Robot


class Note(Protocol):
    """Callback for events: what began or ended, and on which sides."""

    def __call__(self, name: str, /, *, sides: tuple[str, ...]) -> None: ...


def displaced(frame: Frame, y: Array, by: Array) -> Array:
    """Move a point of the output space, (p,), by `by`, (2,), in the path's plane, [m]."""
    z = frame.planar(y)
    return y + frame.lift(z + by) - frame.lift(z)


class ExternalForces:
    """The external forces of one run, from reset to reset.

    Args:
        robot: the model of the robots.
        runs: by side.
        note: see `Note`.
        wall: in the way of both end-points, or None.

    Attributes:
        held: sides whose robots are held back.
        hands: targets of the pulling hands, by side, in output coordinates, [m].
        grabbed: side of the end-point that was grabbed, or None.
        pushes: external force on each robot; the same object until something changes.
    """

    def __init__(
        self,
        robot: Robot,
        runs: Mapping[str, ClosedLoopRun],
        note: Note,
        wall: Wall | None = None,
    ) -> None:
        self._robot, self._runs, self._note = robot, runs, note
        self.held: set[str] = set()
        self.hands: dict[str, Array] = {}
        self.grabbed: str | None = None
        self.pushes: dict[str, Push] = dict.fromkeys(SIDES, FREE)
        self._offsets: dict[str, Array] = {}
        home, reach = robot.frame.lift(np.zeros(2)), robot.reach
        self._lowest, self._highest = home - reach, home + reach  # of targets
        if wall is not None:
            self.set_wall(wall)

    def set_wall(self, wall: Wall | None) -> None:
        """Place, move or remove the wall of both sides."""
        lifted = None if wall is None else wall.lifted(self._robot.frame)
        for name, push in self.pushes.items():
            self.pushes[name] = replace(push, wall=lifted)

    def hold(self, names: Sequence[str], on: bool, curve: Curve, direction: str = ALONG) -> None:
        """Begin or end holding robots back, each at its current position.

        Args:
            direction: in which the brake acts, one of `DIRECTIONS`.
        """
        changed = tuple(name for name in names if on != (name in self.held))
        if changed:
            self._note("hold" if on else "let_go", sides=changed)
        for name in changed:
            (self.held.add if on else self.held.discard)(name)
            brake, brake_normal = None, None
            if on:
                row = self._runs[name].shown()
                theta = float(row["theta"][0])
                brake, brake_normal = brake_in(self._robot, curve, row["y"], theta, direction)
            self.pushes[name] = replace(self.pushes[name], hold=brake, hold_normal=brake_normal)

    def grab(self, side: str, target: Array, together: Sequence[str]) -> None:
        """Pull an end-point towards a target, and others by the same displacement.

        Args:
            target: shape (p,), finite: the command has checked it, [m].
            together: all sides concerned; they stay the same until `release`.
        """
        if self.grabbed != side:
            self.release()
            origin = self._runs[side].shown()["y"].copy()
            self.grabbed = side
            self._offsets = {name: self._runs[name].shown()["y"] - origin for name in together}
            self._note("pull", sides=tuple(self._offsets))
        self.pull({name: target + offset for name, offset in self._offsets.items()})

    def pull(self, targets: Mapping[str, Array]) -> None:
        """Pull end-points, each towards a target of its own, until `release`.

        Args:
            targets: by side, each (p,), [m].
        """
        if self.grabbed is None:
            self.grabbed = next(iter(targets))
            self._offsets = {}
            self._note("pull", sides=tuple(targets))
        for name, target in targets.items():
            self.hands[name] = np.minimum(np.maximum(target, self._lowest), self._highest)
            self.pushes[name] = replace(self.pushes[name], hand=self.hands[name])

    def release(self) -> None:
        """Release all end-points; robots that are held back stay so."""
        if self.hands:
            self._note("release", sides=tuple(self.hands))
        for name in self.hands:
            self.pushes[name] = replace(self.pushes[name], hand=None)
        self.hands.clear()
        self.grabbed = None
