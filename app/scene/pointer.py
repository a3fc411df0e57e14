"""The mouse on the plane of the path, in the frame of the robot that it is at."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from onpath.app.scene.pointer_projection import DragPlane, pointer_on_plane
from onpath.app.scene.stage import Stage

if TYPE_CHECKING:
    import viser

    DragEvent = viser.SceneNodeDragEvent[viser.BatchedMeshHandle]


class Pointer:
    """Where the mouse is.

    Args:
        stage: where the robots stand.
    """

    def __init__(self, stage: Stage) -> None:
        self._plane, self._bases = stage.path_plane, list(stage.bases.values())
        self._reachable = stage.reachable

    def place(
        self,
        event: DragEvent,
        pointer: tuple[float, float, float],
        robot: int,
        plane: DragPlane | None = None,
    ) -> np.ndarray | None:
        """A position of the pointer on a plane, by default that of the path.

        Args:
            event: that tells it.
            pointer: any point of the world under it, [m].
            robot: number of the robot at which it is.

        Returns:
            The place in the robot's frame, shape (3,), [m], or None if there is none.
        """
        camera, plane = event.client.camera.position, plane or self._plane
        return pointer_on_plane(camera, pointer, self._bases[robot], plane, self._reachable)


class DragByOffset:
    """A drag that keeps the offset of the press from the middle of what is dragged, so no jump."""

    def __init__(self, pointer: Pointer) -> None:
        self._pointer = pointer
        self._offset = np.zeros(3)

    def press(self, event: DragEvent, robot: int, middle: np.ndarray) -> None:
        """The drag begins.

        Args:
            robot: number of the robot at which it is.
            middle: of what is dragged, in the robot's frame, shape (3,), [m].
        """
        pressed = self._pointer.place(event, event.start_position, robot)
        self._offset = np.zeros(3) if pressed is None else middle - pressed

    def target(self, event: DragEvent, robot: int) -> np.ndarray | None:
        """Where the middle is dragged to, in the robot's frame, shape (3,), [m], or None."""
        place = self._pointer.place(event, event.end_position, robot)
        return None if place is None else place + self._offset
