"""A line that a hand is drawing: of few points however long it takes, and drawn now and then.

The mouse tells its way up to 500 times a second, on the event loop of all; there points are only
noted. The line is sent by the simulation thread, with the other slow things of a page.
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
"""Points of a line; at more, every second one is left out, and from then on fewer are taken."""


class Ink:
    """A line on the screen. From any thread.

    Args:
        scene: where it is.
        name: of its node.
        look: colour, and thickness [m].
        closest: two points are at least this far apart.
        place: from points, shape (n, k), to the world, shape (n, 3), [m].
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
        self._closest = self._apart = closest
        self._points: list[np.ndarray] = []
        self._handle: viser.LineSegmentsHandle | None = None
        self._changed = self._removed = False
        self._lock = threading.Lock()

    @property
    def points(self) -> np.ndarray:
        """Of the line, shape (n, k)."""
        with self._lock:
            return np.array(self._points)

    def begin(self, points: np.ndarray | None = None) -> None:
        """Anew, with some points or none."""
        with self._lock:
            self._points = [] if points is None else list(points)
            self._apart, self._changed = self._closest, True

    def add(self, point: np.ndarray) -> None:
        """The line goes on to a point, unless that is very near its end."""
        with self._lock:
            if self._points and np.linalg.norm(point - self._points[-1]) <= self._apart:
                return
            self._points.append(point)
            self._changed = True
            if len(self._points) > MOST:
                self._points, self._apart = self._points[::2], 2 * self._apart

    def draw(self) -> None:
        """Show what has been added; without effect if nothing has."""
        with self._lock:
            if self._removed or not self._changed:
                return
            self._changed = False
            if len(self._points) < 2:
                self._erase()
                return
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
        """Take it away for good."""
        with self._lock:
            self._removed = True
            self._erase()

    def _erase(self) -> None:
        if self._handle is not None:
            self._handle.remove()
            self._handle = None
