"""The hand that holds an end-point while its user pulls at it."""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from onpath.app.common import palette
from onpath.app.lab.snapshots.snapshot import Snapshot
from onpath.app.scene.meshes import Mesh, crisp, extruded
from onpath.app.scene.poses import UNSEEN, difference
from onpath.app.scene.stage import Stage, add_copies
from onpath.app.viser_adapter.frame_channel import update_node

if TYPE_CHECKING:
    import viser

ARC = 10
"""Points of a round end."""
SMALLER = 0.85
"""So that the path is seen beside the hand."""
Place = tuple[float, float]
"""x and z from the end-point [m]."""


class HandNodes:
    """A hand for each robot, seen while it is pulled; without a pull nothing is done."""

    def __init__(self, scene: viser.SceneApi, stage: Stage) -> None:
        self._bases = stage.bases
        self._places = stage.origins.copy()
        self.pulled: tuple[str, ...] = ()
        self._node = add_copies(scene, "/hands", hand(), self._places, palette.SELECTED)
        self._node.visible = False

    def show(self, snapshot: Snapshot) -> None:
        """Show the hands of the robots that are pulled, and hide the others."""
        if snapshot.pulled == self.pulled:
            return
        self.pulled = snapshot.pulled
        sizes = np.array([float(bench in self.pulled) for bench in self._bases])
        update_node(self._node, batched_scales=np.repeat(sizes[:, None], 3, axis=1))
        if self.pulled:
            robots = snapshot.robots
            self.move(np.stack([base + robots[bench].tip for bench, base in self._bases.items()]))
        self._node.visible = bool(self.pulled)

    def move(self, tips: np.ndarray) -> None:
        """Put the hands at the end-points, shape (robots, 3), in the world [m]."""
        if UNSEEN < difference(tips, self._places) < np.inf:  # false for NaN
            self._places = tips.astype(float)
            update_node(self._node, batched_positions=tips)


@lru_cache
def hand() -> Mesh:
    """A hand that comes from below and takes what is at the origin between thumb and finger."""
    palm = _finger((0.034, -0.030), (0.050, -0.046), 0.017, 0.016, (-0.046, -0.024))
    wrist = _finger((0.050, -0.046), (0.074, -0.070), 0.0125, 0.0135, (-0.043, -0.027))
    thumb = _finger((0.024, -0.036), (0.004, -0.006), 0.0085, 0.0055, (-0.042, -0.026))
    index = _finger((0.040, -0.020), (0.027, 0.004), 0.0075, 0.0068, (-0.042, -0.028))
    pointed = _finger((0.027, 0.004), (0.006, 0.004), 0.0068, 0.0052, (-0.042, -0.028))
    others = [
        _finger((0.046, -0.024), (0.046 + right, -0.024 + up), 0.0072, 0.0064, (-0.040, -0.026))
        for right, up in ((-0.004, 0.030), (0.009, 0.027), (0.019, 0.017))
    ]
    return crisp(*others, palm, wrist, thumb, index, pointed)


def _finger(
    begin: Place, end: Place, first: float, last: float, layers: tuple[float, float]
) -> Mesh:
    """A plate with round ends of these radii, between two depths y [m]."""
    a, b = np.array(begin), np.array(end)
    along = np.arctan2(*(b - a)[::-1])
    half = np.linspace(-np.pi / 2, np.pi / 2, ARC)

    def arc(centre: np.ndarray, radius: float, angle: np.ndarray) -> np.ndarray:
        return centre + radius * np.column_stack([np.cos(angle), np.sin(angle)])

    outline = np.concatenate([arc(b, last, along + half), arc(a, first, along + np.pi + half)])
    return extruded(SMALLER * outline, *layers, 0.0022)
