"""The hand that holds an end-point while a user pulls it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from onpath.app.common import palette
from onpath.app.lab.snapshots.snapshot import Snapshot
from onpath.app.scene.meshes import part
from onpath.app.scene.poses import UNSEEN, difference
from onpath.app.scene.stage import Stage, add_copies
from onpath.app.viser_adapter.frame_channel import update_node

if TYPE_CHECKING:
    import viser


class HandNodes:
    """A hand for each robot, visible while the robot is pulled.

    Attributes:
        pulled: sides whose robot is pulled.
    """

    def __init__(self, scene: viser.SceneApi, stage: Stage) -> None:
        self._bases = stage.bases
        self._places = stage.origins.copy()
        self.pulled: tuple[str, ...] = ()
        self._node = add_copies(scene, "/hands", part("hand"), self._places, palette.SELECTED)
        self._node.visible = False

    def show(self, snapshot: Snapshot) -> None:
        """Show the hands of the robots that are pulled, and hide the others."""
        if snapshot.pulled == self.pulled:
            return
        self.pulled = snapshot.pulled
        sizes = np.array([float(side in self.pulled) for side in self._bases])
        update_node(self._node, batched_scales=np.repeat(sizes[:, None], 3, axis=1))
        if self.pulled:
            robots = snapshot.robots
            self.move(np.stack([base + robots[side].tip for side, base in self._bases.items()]))
        self._node.visible = bool(self.pulled)

    def move(self, tips: np.ndarray) -> None:
        """Put the hands at the end-points, shape (robots, 3), in the world [m]."""
        if UNSEEN < difference(tips, self._places) < np.inf:  # false for NaN
            self._places = tips.astype(float)
            update_node(self._node, batched_positions=tips)
