"""Texts and arrows that a lesson's step puts into the scene, at both robots."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from onpath.app.scene.arrows import Arrows, ArrowShape
from onpath.app.scene.stage import Stage, add_text
from onpath.lessons.action_schema import SceneMark
from onpath.models.systems.robots import Robot

if TYPE_CHECKING:
    import viser

BEYOND = 0.014
"""Distance of an arrow's text behind its tail [m]."""
SHAPE = ArrowShape(shaft_radius=0.0016, head_radius=0.005, head_length=0.012)


class MarkNodes:
    """The nodes of some marks."""

    def __init__(
        self,
        scene: viser.SceneApi,
        stage: Stage,
        robot: Robot,
        marks: Sequence[SceneMark],
        letters: float,
    ) -> None:
        self._nodes: list[viser.SceneNodeHandle] = []
        arrows = list[np.ndarray]()
        for side, base in stage.bases.items():
            front = base - 0.008 * stage.away
            for i, mark in enumerate(marks):
                tip = front + _placed(robot, mark.at)
                place = tip
                if mark.tail is not None:
                    tail = front + _placed(robot, mark.tail)
                    arrows.append(np.stack([tail, tip]))
                    place = tail + BEYOND * (tail - tip) / np.linalg.norm(tail - tip)
                if mark.text:
                    name = f"/show/marks/{side}/{i}"
                    self._nodes.append(add_text(scene, name, mark.text, place, letters))
        if arrows:
            drawn_arrows = Arrows(
                scene,
                "/show/mark_arrows",
                points=np.stack(arrows),
                colour=stage.tones.line,
                shape=SHAPE,
            )
            self._nodes.extend(drawn_arrows.nodes)

    def remove(self) -> None:
        """Remove all nodes."""
        for node in self._nodes:
            node.remove()


def _placed(robot: Robot, at: tuple[float, float]) -> np.ndarray:
    """A point of the path's plane, [mm], in the robot's own frame, shape (3,), [m]."""
    return robot.position(robot.frame.lift(1e-3 * np.array(at)))
