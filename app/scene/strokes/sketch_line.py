"""A line drawn by hand, with a bounded number of points and a limited redraw rate.

The mouse reports up to 500 positions a second on the shared event loop, where points are only
stored. The simulation thread sends the line together with the other slow updates of a page.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from onpath.app.common import palette

if TYPE_CHECKING:
    import viser

MOST = 1000
"""Maximum number of points; beyond it, every second one is dropped and the spacing doubles."""


class SketchLine:
    """A line in the scene. Thread-safe.

    Args:
        scene: the scene that contains it.
        name: name of its node.
        look: colour and thickness [m].
        closest: minimum distance between two points.
        place: maps points, shape (n, k), to the world, shape (n, 3), [m].
    """

    def __init__(
        self,
        scene: viser.SceneApi,
        name: str,
        look: tuple[palette.Colour, float],
        closest: float,
        place: Callable[[np.ndarray], np.ndarray],
    ) -> None:
        self._scene, self._name, self._look, self._place = scene, name, look, place
        self._apart = closest
        self._points: list[np.ndarray] = []
        self._handle: viser.LineSegmentsHandle | None = None
        self._changed = self._removed = False
        self._lock = threading.Lock()

    @property
    def points(self) -> np.ndarray:
        """Points of the line, shape (n, k)."""
        with self._lock:
            return np.array(self._points)

    def add(self, point: np.ndarray) -> None:
        """Append a point unless it is too close to the end of the line."""
        with self._lock:
            if self._points and np.linalg.norm(point - self._points[-1]) <= self._apart:
                return
            self._points.append(point)
            self._changed = True
            if len(self._points) > MOST:
                self._points, self._apart = self._points[::2], 2 * self._apart

    def draw(self) -> None:
        """Redraw the line if points have been added."""
        with self._lock:
            if self._removed or not self._changed or len(self._points) < 2:
                return
            self._changed = False
            line = self._place(np.array(self._points))
            segments = np.stack([line[:-1], line[1:]], axis=1).astype(np.float32)
            if self._handle is None:
                colour, thickness = self._look
                self._handle = self._scene.add_line_segments(
                    self._name, segments, colour.rgb, thickness=thickness
                )
            else:
                self._handle.points = segments

    def remove(self) -> None:
        """Remove the line permanently."""
        with self._lock:
            self._removed = True
            if self._handle is not None:
                self._handle.remove()
                self._handle = None
