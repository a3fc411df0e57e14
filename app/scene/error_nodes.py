"""Both errors as arrows at each end-point, on demand: e to the timetable's point, d to the path."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from onpath.app.common import palette
from onpath.app.lab.snapshots.snapshot import END, MARKER, Motion
from onpath.app.scene.moving_lines import have_moved
from onpath.app.scene.stage import Stage
from onpath.app.viser_adapter.frame_channel import update_node

if TYPE_CHECKING:
    import viser

ARROWS = {"e": palette.VERMILLION, "d": palette.AZURE}
"""Name of each error, and its colour: that of the robot whose law makes it zero."""
SHORTEST = 2e-3
"""Errors below this are drawn as nothing [m]."""
CLOCK = 0
"""Index of the robot whose marker is the timetable's point."""


class ErrorNodes:
    """Both arrows at each robot; made when they are to be shown, and then removed."""

    def __init__(self, scene: viser.SceneApi, stage: Stage, motion: Motion) -> None:
        self._origins, self._toward = stage.origins, -0.012 * stage.away
        self._drawn = self._points(motion)
        self._arrows = [
            scene.add_arrows(
                f"/show/errors/{name}",
                self._drawn[:, i],
                colour.linear,
                shaft_radius=0.0018,
                head_radius=0.0055,
                head_length=0.012,
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
            update_node(arrow, points=points[:, i])

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
            pairs.append(np.stack([_arrow(end, goal) for goal in goals]) + origin + self._toward)
        return np.stack(pairs)


def nearest(points: np.ndarray, place: np.ndarray) -> np.ndarray:
    """The point of a polyline that is nearest to a place, shape (3,)."""
    begin, step = points[:-1], np.diff(points, axis=0)
    length = np.maximum((step**2).sum(1), 1e-18)
    share = np.clip(((place - begin) * step).sum(1) / length, 0.0, 1.0)
    found = begin + share[:, None] * step
    return found[((found - place) ** 2).sum(1).argmin()]


def _arrow(begin: np.ndarray, end: np.ndarray) -> np.ndarray:
    """An arrow, or one too short to be seen if there is no error."""
    if np.linalg.norm(end - begin) >= SHORTEST:
        return np.stack([begin, end])
    return np.stack([begin, begin + [0.0, 0.0, 1e-6]])
