"""The start of the next run at every robot: a ball to drag, and an arrow for the velocity."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from onpath.app.common import palette
from onpath.app.scene import meshes
from onpath.app.scene.arrows import Arrows, ArrowShape
from onpath.app.scene.pointer import DragByOffset, Pointer
from onpath.app.scene.stage import add_copies
from onpath.app.viser_adapter.frame_channel import update_node

if TYPE_CHECKING:
    import viser

    from onpath.app.scene.pointer import DragEvent

RADIUS = 0.01
"""Radius of the ball [m]."""
SECONDS = 0.15
"""The arrow is as long as the distance covered in this time [s]."""
SHAPE = ArrowShape(shaft_radius=0.0028, head_radius=0.007, head_length=0.014)
BEFORE = np.array([0.0, -0.012, 0.0])
"""Offset towards the viewer, so that no control point covers the ball [m]."""


class StartNodes:
    """Nodes of the start, drawn once for each robot, while they are shown.

    Args:
        scene: the client's scene.
        origins: of the robots' frames in the world, shape (k, 3), [m].
        pointer: where the mouse is.
        on_move: called with the new position, shape (3,), in the robot's frame [m].
    """

    def __init__(
        self,
        scene: viser.SceneApi,
        origins: np.ndarray,
        pointer: Pointer,
        on_move: Callable[[np.ndarray], None],
    ) -> None:
        self._scene, self._origins = scene, origins
        self._drag, self._on_move = DragByOffset(pointer), on_move
        self._ball: viser.BatchedMeshHandle | None = None
        self._arrows: Arrows | None = None
        self._start = np.zeros((2, 3))

    @property
    def is_shown(self) -> bool:
        """Whether the start is shown."""
        return self._ball is not None

    def show(self, visible: bool) -> None:
        """Show or hide the start."""
        if visible and self._ball is None:
            self._ball = add_copies(
                self._scene,
                "/start/ball",
                meshes.ball(RADIUS),
                self._places,
                palette.GREEN,
                shadow=False,
            )
            self._ball.on_drag("left")(self._dragged)
            self._arrows = Arrows(
                self._scene,
                "/start/velocity",
                points=self._arrow_points,
                colour=palette.GREEN,
                shape=SHAPE,
            )
        elif not visible and self._ball is not None and self._arrows is not None:
            self._ball.remove()
            self._arrows.remove()
            self._ball = self._arrows = None

    def draw(self, start: np.ndarray) -> None:
        """Draw a start, see `Snapshot.start`; sends nothing if it is drawn already."""
        if start is self._start or not len(start):
            return
        is_drawn, self._start = np.array_equal(start, self._start), start
        if not is_drawn and self._ball is not None and self._arrows is not None:
            update_node(self._ball, batched_positions=self._places)
            self._arrows.draw(self._arrow_points)

    @property
    def _places(self) -> np.ndarray:
        return self._origins + self._start[0] + BEFORE

    @property
    def _arrow_points(self) -> np.ndarray:
        offset = SECONDS * (self._start[1] - self._start[0])
        return np.stack([self._places, self._places + offset], axis=1)

    async def _dragged(self, event: DragEvent) -> None:
        """Mouse callback; a coroutine without await, because viser runs those in order."""
        robot = event.instance_index
        if robot is None or robot >= len(self._origins):  # a browser may send any number
            return
        if event.phase == "start":
            self._drag.press(event, robot, self._start[0])
        target = self._drag.target(event, robot)
        if target is not None:
            self._on_move(target)
