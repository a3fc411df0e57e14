"""Drawing a path with the mouse on a sheet in front of the robots."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from app import meshes, palette
from app.drag import pointer_on_plane
from app.stage import Stage, add_copies

if TYPE_CHECKING:
    import viser

CLOSEST = 0.002
"""Two points of a stroke are at least this far apart [m]."""


class Freehand:
    """Sheets that take one stroke. Removes itself at the stroke's end.

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
        self._plane = stage.path_plane
        self._on_stroke = on_stroke
        self._points: list[np.ndarray] = []
        self._ink: viser.LineSegmentsHandle | None = None
        self.active = True
        sheet = meshes.sheet(*stage.sheet)
        self._sheets = add_copies(
            scene, "/freehand/sheet", sheet, self._bases, palette.SELECTED, opacity=0.1
        )
        self._sheets.on_drag("left")(self._dragged)

    def cancel(self) -> None:
        """Takes the sheets away; without effect when they are gone."""
        if self.active:
            self.active = False
            self._sheets.remove()
            if self._ink is not None:
                self._ink.remove()

    async def _dragged(self, event: viser.SceneNodeDragEvent[viser.BatchedMeshHandle]) -> None:
        if not self.active or event.instance_index is None:
            return
        base = self._bases[event.instance_index]
        camera = event.client.camera.position
        seen = [event.start_position] if event.phase == "start" else []
        for pointer in (*seen, event.end_position):
            point = pointer_on_plane(camera, np.array(pointer), base, self._plane)
            if point is not None and self._is_new(point):
                self._points.append(point)
        if event.phase == "end":
            self.cancel()
            self._on_stroke(np.array(self._points).reshape(-1, 3))
        else:
            self._draw(base)

    def _is_new(self, point: np.ndarray) -> bool:
        return not self._points or float(np.linalg.norm(point - self._points[-1])) > CLOSEST

    def _draw(self, base: np.ndarray) -> None:
        if len(self._points) < 2:
            return
        line = np.array(self._points) + base - [0.0, 0.004, 0.0]
        segments = np.stack([line[:-1], line[1:]], axis=1)
        if self._ink is None:
            self._ink = self._scene.add_line_segments(
                "/freehand/ink", segments, palette.INK.rgb, thickness=0.003
            )
        else:
            self._ink.points = segments.astype(np.float32)
