"""Both errors as optional arrows at each end-point: e to the timetable's point, d to the path."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from onpath.app.common import palette
from onpath.app.lab.snapshots.snapshot import END, MARKER, Motion
from onpath.app.scene.arrows import Arrows, ArrowShape
from onpath.app.scene.moving_lines import have_moved
from onpath.app.scene.stage import Stage

if TYPE_CHECKING:
    import viser

ARROWS = {"e": palette.VERMILLION, "d": palette.AZURE}
"""Name of each error, and the colour of the robot whose law makes it zero."""
SHAPE = ArrowShape(shaft_radius=0.0018, head_radius=0.0055, head_length=0.012)
CLOCK = 0
"""Index of the robot whose marker is the timetable's point."""


class ErrorNodes:
    """Both arrows at each robot; they exist only while they are shown."""

    def __init__(self, scene: viser.SceneApi, stage: Stage, motion: Motion) -> None:
        self._origins, self._toward = stage.origins, -0.012 * stage.away
        self._drawn = self._points(motion)
        self._arrows = [
            Arrows(
                scene,
                f"/show/errors/{name}",
                points=self._drawn[:, i],
                colour=colour,
                shape=SHAPE,
            )
            for i, (name, colour) in enumerate(ARROWS.items())
        ]

    def follow(self, motion: Motion) -> None:
        """Move the arrows with the robots; sends nothing while they stand still."""
        points = self._points(motion)
        if not have_moved(points, self._drawn):
            return
        self._drawn = points
        for i, arrow in enumerate(self._arrows):
            arrow.draw(points[:, i])

    def remove(self) -> None:
        """Remove all nodes."""
        for arrow in self._arrows:
            arrow.remove()

    def _points(self, motion: Motion) -> np.ndarray:
        """Beginning and end of each arrow, shape (robots, 2 errors, 2, 3), in the world."""
        clock = motion.point(CLOCK, MARKER)
        pairs = list[np.ndarray]()
        for robot, origin in enumerate(self._origins):
            end = motion.point(robot, END)
            goals = clock, nearest(motion.path.points, end)
            pairs.append(np.stack([(end, goal) for goal in goals]) + origin + self._toward)
        return np.stack(pairs)


def nearest(points: np.ndarray, place: np.ndarray) -> np.ndarray:
    """The point of a polyline that is nearest to a place, shape (3,)."""
    begin, step = points[:-1], np.diff(points, axis=0)
    length = np.maximum((step**2).sum(1), 1e-18)
    share = np.clip(((place - begin) * step).sum(1) / length, 0.0, 1.0)
    found = begin + share[:, None] * step
    return found[((found - place) ** 2).sum(1).argmin()]
