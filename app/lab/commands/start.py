"""Commands that choose where a run starts, by mouse and button."""

from __future__ import annotations

from dataclasses import dataclass

from typing_extensions import override

from onpath.app.lab.commands.checks import point
from onpath.app.lab.lab import Command, Lab
from onpath.models.arrays import Array
from onpath.models.closed_loop.lab_settings import settings_of_start
from onpath.models.closed_loop.start import ON_PATH, Start, nearest_start


@dataclass(frozen=True, slots=True, eq=False)
class MoveStart(Command):
    """Move the start of the next run to a point of the path's plane.

    Attributes:
        target: shape (2,), [m].
    """

    target: Array

    @override
    def apply(self, lab: Lab) -> None:
        simulation = lab.simulation
        target = point(self.target, 2)
        _take(lab, nearest_start(simulation.editor.curve, target, simulation.start))


@dataclass(frozen=True, slots=True)
class StartOnPath(Command):
    """Start on the path at θ = 0, at rest, as a new lab does."""

    @override
    def apply(self, lab: Lab) -> None:
        _take(lab, ON_PATH)


def _take(lab: Lab, start: Start) -> None:
    """Start there at the next reset.

    Raises:
        ValueError: the start is not possible; nothing has changed.
    """
    lab.simulation.check_start(start)
    lab.simulation.set(**settings_of_start(start))
    lab.clear_message()
