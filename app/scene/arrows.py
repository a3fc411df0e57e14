"""Arrows drawn to length, even where they are shorter than their heads."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from onpath.app.common.palette import Colour
from onpath.app.viser_adapter.frame_channel import update_node

if TYPE_CHECKING:
    import viser

SHORTEST = 2e-3
"""Arrows shorter than this are usually not drawn [m]."""


@dataclass(frozen=True, slots=True)
class ArrowShape:
    """Dimensions of an arrow that is longer than its head, and the shortest that is drawn, [m]."""

    shaft_radius: float
    head_radius: float
    head_length: float
    shortest: float = SHORTEST

    def sizes(self, length: float) -> dict[str, float]:
        """viser's sizes for an arrow of this length, [m]; a short one is a smaller head alone."""
        share = min(1.0, length / self.head_length)
        return {
            "shaft_radius": share * self.shaft_radius,
            "head_radius": share * self.head_radius,
            "head_length": share * self.head_length,
        }


class Arrows:
    """Some arrows of one colour.

    viser draws all heads of a node equally long, even where the arrow is shorter than its head, so
    each arrow is a node of its own.

    Args:
        points: beginning and end of each arrow, shape (n, 2, 3), [m].
    """

    def __init__(
        self,
        scene: viser.SceneApi,
        name: str,
        points: np.ndarray,
        colour: Colour,
        shape: ArrowShape,
    ) -> None:
        self._shape = shape
        self.nodes = [
            scene.add_arrows(
                f"{name}_{i}",
                arrow[None],
                colour.linear,
                visible=_length(arrow) >= shape.shortest,
                shaft_radius=size["shaft_radius"],
                head_radius=size["head_radius"],
                head_length=size["head_length"],
            )
            for i, arrow in enumerate(points)
            for size in [shape.sizes(_length(arrow))]
        ]

    def draw(self, points: np.ndarray) -> None:
        """Draw the arrows, see `points`; one that is not finite is hidden."""
        for node, arrow in zip(self.nodes, points, strict=True):
            length = _length(arrow)
            seen = length >= self._shape.shortest  # false for NaN
            if seen:
                update_node(node, points=arrow[None], **self._shape.sizes(length))
            if node.visible != seen:
                node.visible = seen

    def remove(self) -> None:
        """Remove all nodes."""
        for node in self.nodes:
            node.remove()


def _length(arrow: np.ndarray) -> float:
    return float(np.linalg.norm(arrow[1] - arrow[0]))
