"""Commands that choose where a run starts, by mouse and button."""

from __future__ import annotations

from dataclasses import dataclass

from typing_extensions import override

from onpath.app.lab.commands.checks import point
from onpath.app.lab.lab import Command, Lab
from onpath.models.arrays import Array
from onpath.models.closed_loop.lab_settings import settings_of_start
from onpath.models.closed_loop.simulation import raised
from onpath.models.closed_loop.start import ON_PATH, Start, nearest_start
from onpath.models.errors import CodedError
from onpath.models.systems.joint_drag import dragged_joint


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


@dataclass(frozen=True, slots=True, eq=False)
class DragJoint(Command):
    """Move the start of the next run as if a joint were turned there by its link.

    Attributes:
        joint: its number, from 0.
        target: where the link's end is dragged, in the output space, shape (p,), [m].
    """

    joint: int
    target: Array

    @override
    def apply(self, lab: Lab) -> None:
        simulation = lab.simulation
        robot, source = simulation.robot, simulation.entry.source
        if source is None or not 0 <= self.joint < source.chain.n:
            raise CodedError("error.no_such_joint")
        target = point(self.target, robot.frame.p)
        curve = raised(simulation.editor.curve, simulation.parameters)
        q = robot.rest(robot.frame.lift(simulation.start.place(curve)))
        place = robot.endpoint(dragged_joint(source, q, self.joint, target))
        z = robot.frame.planar(place)
        _take(lab, nearest_start(simulation.editor.curve, z, simulation.start))


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
