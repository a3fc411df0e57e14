"""Drawing a path with the mouse on a sheet in front of the robots."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from onpath.app.common import palette
from onpath.app.scene import meshes
from onpath.app.scene.pointer_projection import pointer_on_plane
from onpath.app.scene.stage import Stage, add_copies
from onpath.app.scene.strokes.sketch_line import SketchLine

if TYPE_CHECKING:
    import viser

CLOSEST = 0.002
"""Minimum distance between consecutive points of a stroke [m]."""


class FreehandSheets:
    """Sheets that record one stroke and are removed when it ends.

    Args:
        scene: the client's scene.
        stage: where the robots stand.
        on_stroke: called with the points in the robot's frame, shape (n, 3), [m].
    """

    def __init__(
        self,
        scene: viser.SceneApi,
        stage: Stage,
        on_stroke: Callable[[np.ndarray], None],
    ) -> None:
        self._scene = scene
        self._bases = stage.origins
        self._plane, self._box = stage.path_plane, stage.reachable
        self._on_stroke = on_stroke
        self._base = self._bases[0]  # of the robot in front of which the stroke is drawn
        self._line = SketchLine(
            scene=scene,
            name="/freehand/line",
            look=(stage.tones.line, 0.003),
            closest=CLOSEST,
            place=self._before_the_robot,
        )
        self.active = True
        sheet = meshes.sheet(*stage.sheet)
        self._sheets = add_copies(
            scene, "/freehand/sheet", sheet, self._bases, palette.SELECTED, opacity=0.1
        )
        self._sheets.on_drag("left")(self._dragged)

    def cancel(self) -> None:
        """Remove the sheets. Idempotent."""
        if self.active:
            self.active = False
            self._sheets.remove()
            self._line.remove()

    def draw(self) -> None:
        """Redraw the stroke; called at about 10 Hz."""
        self._line.draw()

    async def _dragged(self, event: viser.SceneNodeDragEvent[viser.BatchedMeshHandle]) -> None:
        index = event.instance_index
        if (
            not self.active or index is None or index >= len(self._bases)
        ):  # a browser may send any number
            return
        self._base = self._bases[index]
        camera = event.client.camera.position
        seen = [event.start_position] if event.phase == "start" else []
        for pointer in (*seen, event.end_position):
            place = np.array(pointer)
            point = pointer_on_plane(camera, place, self._base, self._plane, self._box)
            if point is not None:
                self._line.add(point)
        if event.phase == "end":
            self.cancel()
            self._on_stroke(self._line.points.reshape(-1, 3))

    def _before_the_robot(self, points: np.ndarray) -> np.ndarray:
        return points + self._base - [0.0, 0.004, 0.0]
