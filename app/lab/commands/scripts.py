"""Converts actions of a lesson's text or script to commands."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np
from typing_extensions import override

from onpath.app.lab.commands.checks import point
from onpath.app.lab.commands.forces import Release
from onpath.app.lab.commands.laws import ChooseLaw
from onpath.app.lab.commands.path import ChoosePath, MovePoint
from onpath.app.lab.commands.robots import ChooseRobot, Identify
from onpath.app.lab.commands.settings import Set
from onpath.app.lab.commands.time import Reset, SetRunning
from onpath.app.lab.external_forces import displaced
from onpath.app.lab.lab import Command, Lab
from onpath.app.lab.script_player import ScriptPlayer
from onpath.lessons.action_schema import Action, Laws, RobotName, RunStart, Script
from onpath.lessons.sides import SIDE_OF
from onpath.models.closed_loop.lab_settings import RATES, settings_of_start
from onpath.models.closed_loop.start import Start
from onpath.models.control.sides import SIDES, checked_laws
from onpath.models.errors import CodedError


@dataclass(frozen=True, slots=True)
class ScriptHold(Command):
    """Hold end-points back or release them, regardless of `LabSettings.copy`.

    Attributes:
        only: one robot; empty for both.
    """

    on: bool
    only: RobotName | Literal[""] = ""

    @override
    def apply(self, lab: Lab) -> None:
        lab.simulation.forces.hold(_sides(self.only), self.on, lab.simulation.editor.curve)


@dataclass(frozen=True, slots=True)
class ScriptPull(Command):
    """Pull end-points away from their current position, regardless of `LabSettings.copy`.

    Attributes:
        by: displacement in the path's plane, [mm].
        only: one robot; empty for both, with the follower's displacement.
    """

    by: tuple[float, float]
    only: RobotName | Literal[""] = ""

    @override
    def apply(self, lab: Lab) -> None:
        simulation, name = lab.simulation, SIDE_OF[self.only or "follower"]
        by = point(np.array(self.by), 2) / 1e3
        target = displaced(simulation.robot.frame, simulation.runs[name].shown()["y"], by)
        simulation.forces.grab(name, target, _sides(self.only))


@dataclass(frozen=True, slots=True)
class ScriptLaws(Command):
    """Change control laws at once, even if their loops are not ready."""

    laws: Laws

    @override
    def apply(self, lab: Lab) -> None:
        for side, law in checked_laws(self.laws.named, lab.simulation.entry).items():
            lab.simulation.change_law(side, law)


@dataclass(frozen=True, slots=True)
class ScriptRate(Command):
    """Set the speed of simulated time, relative to the rate that the user had chosen."""

    rate: float

    @override
    def apply(self, lab: Lab) -> None:
        wanted = self.rate * lab.lessons.rate_before
        lab.simulation.set(rate=min(max(wanted, RATES[0]), RATES[-1]))


@dataclass(frozen=True, slots=True)
class ScriptStart(Command):
    """Restart both robots at a given start."""

    start: RunStart

    @override
    def apply(self, lab: Lab) -> None:
        start = Start(**self.start.numbers)
        lab.simulation.check_start(start)
        lab.simulation.set(**settings_of_start(start))
        lab.simulation.reset()


@dataclass(frozen=True, slots=True)
class ScriptMove(Command):
    """Move a control point by a displacement, [mm]."""

    index: int
    right: float
    up: float

    @override
    def apply(self, lab: Lab) -> None:
        points = lab.simulation.editor.design.points
        if not 0 <= self.index < len(points):
            raise CodedError("error.no_point", index=self.index, count=len(points))
        by = np.array([self.right, self.up]) / 1e3
        MovePoint(self.index, points[self.index] + by).apply(lab)


def commands_of(action: Action) -> list[Command]:
    """The commands of an action in a text, which the user starts."""
    if action.laws is not None:
        return [ChooseLaw(side, law) for side, law in action.laws.named.items()]
    return _COMMANDS[action.what](action)


def player_of(script: Script) -> ScriptPlayer[Command]:
    """A player for a script."""
    timed = [(a.at, command) for a in script.do for command in _COMMANDS[a.what](a)]
    return ScriptPlayer(timed, script.until)


def _sides(only: RobotName | Literal[""]) -> list[str]:
    return [SIDE_OF[only]] if only else list(SIDES)


def _laws(action: Action) -> list[Command]:
    assert action.laws is not None
    return [ScriptLaws(action.laws)]


def _move(action: Action) -> list[Command]:
    assert action.move is not None
    index, right, up = action.move
    return [ScriptMove(index, right, up)]


def _pull(action: Action) -> list[Command]:
    assert action.pull is not None
    return [ScriptPull(action.pull, action.only)]


_COMMANDS: dict[str, Callable[[Action], list[Command]]] = {
    "hold": lambda action: [ScriptHold(bool(action.hold), action.only)],
    "pull": _pull,
    "release": lambda _: [Release()],
    "set": lambda action: [Set(name, value) for name, value in (action.set or {}).items()],
    "path": lambda action: [ChoosePath(action.path or "")],
    "move": _move,
    "robot": lambda action: [ChooseRobot(action.robot or "")],
    "laws": _laws,
    "reset": lambda _: [Reset()],
    "run": lambda action: [SetRunning(action.run)],
    "identify": lambda _: [Identify()],
    "start": lambda action: [ScriptStart(action.start or RunStart())],
    "rate": lambda action: [ScriptRate(action.rate or 1.0)],
}
