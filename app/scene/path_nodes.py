"""The path at every robot: its curve, its control points, and the position of a rejected edit."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from onpath.app.common import palette
from onpath.app.lab.snapshots.snapshot import PathSnapshot
from onpath.app.scene import meshes
from onpath.app.scene.stage import add_copies
from onpath.app.scene.tones import LIGHT, Tones

if TYPE_CHECKING:
    import viser

POINT_RADIUS = 0.0065
CURVE_THICKNESS = 0.0025
MARK_SIZE = 0.02


class PathNodes:
    """Nodes of one path, drawn once for each robot.

    Args:
        scene: the client's scene.
        bases: origins of the robots' frames in the world, shape (k, 3), [m].
        connect: called with every new node of the control points, to add callbacks. Its
            instances are all points of the first robot, then all of the next.
        tones: colours of the path and of its points.
    """

    def __init__(
        self,
        scene: viser.SceneApi,
        bases: np.ndarray,
        connect: Callable[[viser.BatchedMeshHandle], None],
        tones: Tones = LIGHT,
    ) -> None:
        self._tones = tones
        self._scene = scene
        self._bases = bases
        self._connect = connect
        self._curve: viser.LineSegmentsHandle | None = None
        self._dashes: viser.LineSegmentsHandle | None = None
        self._points: viser.BatchedMeshHandle | None = None
        self._marks: viser.BatchedMeshHandle | None = None
        self._given: viser.LineSegmentsHandle | None = None

    def draw(self, path: PathSnapshot) -> None:
        """Update the nodes to show a path."""
        self._draw_curve(path)
        self._draw_points(path)
        self._draw_marks(path.refused)
        self._draw_given(path.given)

    def _everywhere(self, points: np.ndarray) -> np.ndarray:
        """Points of a robot's frame at each robot, in the world, shape (k n, 3), [m]."""
        return (self._bases[:, None] + points).reshape(-1, 3)

    def _draw_curve(self, path: PathSnapshot) -> None:
        segments = self._everywhere(path.drawn.reshape(-1, 3)).reshape(-1, 2, 3)
        if self._curve is None:
            self._curve = self._scene.add_line_segments(
                "/path/curve", segments, self._tones.path.rgb, thickness=CURVE_THICKNESS
            )
        else:
            self._curve.points = segments.astype(np.float32)
        if self._dashes is not None:
            self._dashes.remove()
            self._dashes = None
        if len(path.dashes):
            dashes = self._everywhere(path.dashes.reshape(-1, 3)).reshape(-1, 2, 3)
            self._dashes = self._scene.add_line_segments(
                "/path/raised", dashes, self._tones.path.rgb, thickness=CURVE_THICKNESS / 2
            )

    def _draw_points(self, path: PathSnapshot) -> None:
        one = np.tile(self._tones.point.linear, (len(path.control_points), 1))
        if path.selected is not None and path.selected < len(one):
            one[path.selected] = palette.SELECTED.linear
        positions = self._everywhere(path.control_points)
        colours = np.tile(one, (len(self._bases), 1))
        if self._points is not None and len(self._points.batched_positions) != len(positions):
            self._points.remove()
            self._points = None
        if self._points is not None:
            self._points.batched_positions = positions
            self._points.batched_colors = colours
        elif len(positions):
            # Not a scaled unit ball: viser keeps an unscaled, invisible copy of a clickable mesh at
            # its origin, which would take presses meant for the camera.
            ball = meshes.ball(POINT_RADIUS)
            self._points = add_copies(
                self._scene, "/path/points", ball, positions, colours, shadow=False
            )
            self._connect(self._points)

    def _draw_given(self, points: np.ndarray) -> None:
        """Draw the line that the path was fitted to, if it is far from it."""
        if self._given is not None:
            self._given.remove()
            self._given = None
        if len(points) > 1:
            pieces = np.stack([points[:-1], points[1:]], axis=1).reshape(-1, 3)
            segments = self._everywhere(pieces).reshape(-1, 2, 3)
            segments = segments[np.isfinite(segments).all(axis=(1, 2))]  # not between strokes
            colour = palette.WARNING.rgb
            self._given = self._scene.add_line_segments("/path/given", segments, colour)

    def _draw_marks(self, refused: np.ndarray) -> None:
        if self._marks is not None:
            self._marks.remove()
            self._marks = None
        if len(refused):
            positions = self._everywhere(refused - [0.0, 0.012, 0.0])
            scales = np.full(len(positions), MARK_SIZE)
            self._marks = add_copies(
                self._scene,
                "/path/refused",
                meshes.part("cross"),
                positions,
                palette.WARNING,
                scales=scales,
                shadow=False,
            )
