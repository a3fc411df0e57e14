"""A test pulse: a short pull across the path, which shows what the gains do."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from typing_extensions import override

from onpath.app.lab.commands.forces import Release
from onpath.app.lab.external_forces import displaced
from onpath.app.lab.lab import Command, Lab
from onpath.app.lab.script_player import ScriptPlayer
from onpath.app.lab.simulation import Simulation
from onpath.models.arrays import Array

ASIDE = 0.008  # [m], from the end-point to the hand, which pulls with 2.4 N on the rigid robots
FRAMES, FRAME = 8, 1 / 60  # the hand moves along with the end-point [s]


@dataclass(frozen=True, slots=True)
class _PullAcross(Command):
    """Pull both end-points outwards, each across the path at its own closest point."""

    @override
    def apply(self, lab: Lab) -> None:
        simulation = lab.simulation
        rows = {name: run.shown() for name, run in simulation.runs.items()}
        simulation.forces.pull({name: self._hand(simulation, row) for name, row in rows.items()})

    @staticmethod
    def _hand(simulation: Simulation, row: dict[str, Array]) -> Array:
        right, up = simulation.editor.curve.at(row["theta"][0], 1)
        outwards = np.array([up, -right]) / np.hypot(right, up)  # of a path that turns to the left
        return displaced(simulation.robot.frame, row["y"], ASIDE * outwards)


@dataclass(frozen=True, slots=True)
class Pulse(Command):
    """Pull both end-points across the path for 0.13 s, unless a script or a hand is acting."""

    lets_time_run: ClassVar[bool] = True

    @override
    def apply(self, lab: Lab) -> None:
        lab.return_to_present()
        simulation = lab.simulation
        if lab.script is not None or simulation.forces.grabbed is not None:
            return
        simulation.running = True
        begin, end = simulation.time, simulation.time + FRAMES * FRAME
        pulls = [(begin + i * FRAME, _PullAcross()) for i in range(FRAMES)]
        lab.script = ScriptPlayer[Command]([*pulls, (end, Release())], end, stop=False)
