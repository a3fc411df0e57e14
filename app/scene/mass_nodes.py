"""The optional ellipse of the effective mass at each end-point."""

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
"""Radius for 1 kg [m]; radii are proportional to the square root of the mass."""
LARGEST = 0.15
"""Largest radius that is drawn, near a singular configuration [m]."""
SIDES = 48
THICKNESS = 0.0022
COLOUR = palette.GREEN


class MassNodes:
    """An ellipse at each end-point; the node exists only while it is shown."""

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
        self._directions = np.column_stack([np.cos(turn), np.sin(turn)])
        self._lines = MovingLines(
            scene,
            "/show/mass",
            lines=self._segments(motion, parameters),
            colour=COLOUR,
            thickness=THICKNESS,
        )

    def follow(self, motion: Motion, parameters: Parameters) -> None:
        """Move the ellipses with the robots; sends nothing while they stand still."""
        self._lines.follow(self._segments(motion, parameters))

    def remove(self) -> None:
        """Remove the node."""
        self._lines.remove()

    def _segments(self, motion: Motion, parameters: Parameters) -> np.ndarray:
        """Segments of all ellipses, shape (n, 2, 3), in the world."""
        ellipses = [
            origin
            + self._toward
            + ellipse(self._robot, motion.point(i, END), parameters, self._directions)
            for i, origin in enumerate(self._origins)
        ]
        points = np.stack(ellipses)
        return np.stack([points[:, :-1], points[:, 1:]], axis=2).reshape(-1, 2, 3)


def ellipse(
    robot: Robot, end: np.ndarray, parameters: Parameters, directions: np.ndarray
) -> np.ndarray:
    """Points of the ellipse at an end-point, in the robot's own frame, shape (k, 3), [m].

    The robot is assumed at rest there, with straight flexible links. Where it cannot rest, all
    points are the end-point.

    Args:
        end: shape (3,).
        directions: unit vectors of the path's plane, shape (k, 2).
    """
    y = robot.output_at(end)
    try:
        masses = effective_masses(robot, robot.rest(y), parameters, directions)
    except ValueError:
        masses = np.zeros(len(directions))
    radii = np.minimum(OF_A_KILOGRAM * np.sqrt(np.maximum(masses, 0.0)), LARGEST)
    frame = robot.frame
    lifted = frame.lift(directions) - frame.lift(np.zeros(2))
    return robot.position(y + radii[:, None] * lifted)
