"""Line segments that follow the robots; they are sent only when they have moved visibly."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from onpath.app.common.palette import Colour
from onpath.app.viser_adapter.frame_channel import update_node

if TYPE_CHECKING:
    import viser

MOVED = 1e-4
"""Movements below this are not drawn [m]."""


def have_moved(points: np.ndarray, drawn: np.ndarray) -> bool:
    """Whether points must be redrawn; never for a robot that has diverged."""
    return bool(np.isfinite(points).all() and np.abs(points - drawn).max(initial=0.0) > MOVED)


class MovingLines:
    """A node of line segments.

    Args:
        lines: in the world, shape (n, 2, 3), [m].
        thickness: [m].
    """

    def __init__(
        self,
        scene: viser.SceneApi,
        name: str,
        lines: np.ndarray,
        colour: Colour,
        thickness: float,
    ) -> None:
        self._lines = lines
        self._node = scene.add_line_segments(name, lines, colour.rgb, thickness=thickness)

    def follow(self, lines: np.ndarray) -> None:
        """Draw the lines where they are now."""
        if have_moved(lines, self._lines):
            self._lines = lines
            update_node(self._node, points=lines)

    def remove(self) -> None:
        """Remove the node."""
        self._node.remove()
