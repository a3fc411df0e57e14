"""The ellipse of the effective mass at each end-point, on demand."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from onpath.app.common import palette
from onpath.app.lab.snapshots.snapshot import END, Motion
from onpath.app.scene.moving_lines import MovingLines
from onpath.app.scene.stage import Stage
from onpath.models.control.effective_mass import effective_masses
from onpath.models.systems.parameters import Parameters
from onpath.models.systems.robots import Robot

if TYPE_CHECKING:
    import viser

OF_A_KILOGRAM = 0.06
"""Radius for 1 kg [m]; radii go with the square root of the mass."""
LARGEST = 0.15
"""Largest radius that is drawn, near a singular configuration [m]."""
SIDES = 48
THICKNESS = 0.0022
COLOUR = palette.GREEN


class MassNodes:
    """An ellipse at each end-point; made when it is to be shown, and then removed."""

    def __init__(
        self,
        scene: viser.SceneApi,
        stage: Stage,
        robot: Robot,
        motion: Motion,
        parameters: Parameters,
    ) -> None:
        self._robot, self._origins, self._toward = robot, stage.origins, -0.004 * stage.away
        turn = np.linspace(0, 2 * np.pi, SIDES + 1)
        self._ways = np.column_stack([np.cos(turn), np.sin(turn)])
        lines = self._drawn(motion, parameters)
        self._lines = MovingLines(scene, "/show/mass", lines, COLOUR, THICKNESS)

    def follow(self, motion: Motion, parameters: Parameters) -> None:
        """Move the ellipses with the robots; sends nothing while they stand still."""
        self._lines.follow(self._drawn(motion, parameters))

    def remove(self) -> None:
        """Remove the node."""
        self._lines.remove()

    def _drawn(self, motion: Motion, parameters: Parameters) -> np.ndarray:
        """Segments of all ellipses, shape (n, 2, 3), in the world."""
        each = [
            origin
            + self._toward
            + ellipse(self._robot, motion.point(i, END), parameters, self._ways)
            for i, origin in enumerate(self._origins)
        ]
        points = np.stack(each)
        return np.stack([points[:, :-1], points[:, 1:]], axis=2).reshape(-1, 2, 3)


def ellipse(robot: Robot, end: np.ndarray, parameters: Parameters, ways: np.ndarray) -> np.ndarray:
    """Points of the ellipse at an end-point, in the robot's own frame, shape (k, 3), [m].

    The robot is taken as it rests there, with flexible links straight. Where that is not possible,
    all points are the end-point.

    Args:
        end: shape (3,).
        ways: unit vectors of the path's plane, shape (k, 2).
    """
    y = robot.unplace(end)
    try:
        masses = effective_masses(robot, robot.rest(y), parameters, ways)
    except ValueError:
        masses = np.zeros(len(ways))
    radii = np.minimum(OF_A_KILOGRAM * np.sqrt(np.maximum(masses, 0.0)), LARGEST)
    frame = robot.frame
    lifted = frame.lift(ways) - frame.lift(np.zeros(2))
    return robot.place(y + radii[:, None] * lifted)
