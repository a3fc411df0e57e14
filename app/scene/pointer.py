"""Position of the mouse on the path's plane, in a robot's frame."""

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
            event: the event of the drag.
            pointer: any point of the world under the mouse, [m].
            robot: number of the robot in whose frame the result is.

        Returns:
            The position in the robot's frame, shape (3,), [m], or None if there is none.
        """
        camera, plane = event.client.camera.position, plane or self._plane
        return pointer_on_plane(camera, pointer, self._bases[robot], plane, self._reachable)


class DragByOffset:
    """A drag that keeps the offset between the press and the dragged object's middle.

    So the object does not jump to the mouse.
    """

    def __init__(self, pointer: Pointer) -> None:
        self._pointer = pointer
        self._offset = np.zeros(3)

    def press(self, event: DragEvent, robot: int, middle: np.ndarray) -> None:
        """Begin a drag.

        Args:
            robot: number of the robot.
            middle: of the dragged object, in the robot's frame, shape (3,), [m].
        """
        pressed = self._pointer.place(event, event.start_position, robot)
        self._offset = np.zeros(3) if pressed is None else middle - pressed

    def target(self, event: DragEvent, robot: int) -> np.ndarray | None:
        """The dragged middle's new position in the robot's frame, shape (3,), [m], or None."""
        place = self._pointer.place(event, event.end_position, robot)
        return None if place is None else place + self._offset
