"""Optional labels on the robots: joint angles with their arcs, lengths, and the axes of y."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from onpath.app.lab.snapshots.snapshot import END, Motion
from onpath.app.scene.arrows import Arrows, ArrowShape
from onpath.app.scene.moving_lines import MOVED, MovingLines
from onpath.app.scene.stage import Stage, add_text
from onpath.app.view.label_geometry import axes_of, label_function
from onpath.app.viser_adapter.frame_channel import move_node
from onpath.models.closed_loop.buffered import Buffered
from onpath.models.systems.robots import Robot

if TYPE_CHECKING:
    import viser

LETTERS, LARGE = 0.024, 0.036
"""Height of the letters, normally and on a narrow screen [m]."""
AXIS = ArrowShape(shaft_radius=0.0014, head_radius=0.005, head_length=0.013)
LINE = 0.0018
"""Thickness of the arcs [m]."""
PAST = 0.016
"""How far past its end the name of an axis stands [m]."""
SUBSCRIPTS = "₀₁₂₃₄₅₆₇₈₉"


class RobotLabels:
    """Nodes of the labels of all robots; they exist only while they are shown.

    Args:
        scene: the client's scene.
        stage: where the robots stand.
        robot: their model.
        motion: their current motion.
        letters: height of the letters, [m].
    """

    def __init__(
        self,
        scene: viser.SceneApi,
        stage: Stage,
        robot: Robot,
        motion: Motion,
        letters: float = LETTERS,
    ) -> None:
        self._robot, self._letters = robot, letters
        self._tones = stage.tones
        self._origins = stage.origins
        labels = label_function(robot, motion.counts.bars)
        self._names, self._function = labels.names, Buffered(labels.function)
        self._nodes: list[viser.SceneNodeHandle] = []
        self._texts: list[viser.LabelHandle] = []
        self._arcs: MovingLines | None = None
        places, lines = self._drawn(motion)
        self._places = places
        names = [f"{side}/{name}" for side in stage.bases for name in labels.names]
        for name, at in zip(names, places, strict=True):
            text = name.rpartition("/")[2]
            self._texts.append(add_text(scene, f"/show/labels/{name}", text, at, letters))
        if len(lines):
            self._arcs = MovingLines(
                scene, "/show/arcs", lines=lines, colour=stage.tones.arc, thickness=LINE
            )
        self._add_axes(scene)

    def update(self, motion: Motion) -> None:
        """Move labels and arcs with the robots; sends nothing while they stand still."""
        places, lines = self._drawn(motion)
        if not np.isfinite(places).all() or not np.isfinite(lines).all():
            return
        moved = np.abs(places - self._places).max(axis=1, initial=0.0) > MOVED
        for i in np.flatnonzero(moved).tolist():
            self._places[i] = places[i]
            move_node(self._texts[i], places[i])
        if self._arcs is not None:
            self._arcs.follow(lines)

    def remove(self) -> None:
        """Remove all nodes."""
        arcs = [] if self._arcs is None else [self._arcs]
        for node in (*self._texts, *self._nodes, *arcs):
            node.remove()

    def _drawn(self, motion: Motion) -> tuple[np.ndarray, np.ndarray]:
        """Places of all names, (k, 3), and all lines, (n, 2, 3), in the world."""
        bars, count = 6 * motion.counts.bars, len(self._names)
        points_of_robots = [
            self._function(drawn[:bars], motion.point(i, END))[0].reshape(-1, 3) + origin
            for i, (drawn, origin) in enumerate(zip(motion.drawn, self._origins, strict=True))
        ]
        places = np.concatenate([points[:count] for points in points_of_robots])
        lines = [points[count:].reshape(-1, 2, 3) for points in points_of_robots]
        return places, np.concatenate(lines)

    def _add_axes(self, scene: viser.SceneApi) -> None:
        axes = axes_of(self._robot)
        everywhere = (self._origins[:, None, None] + axes).reshape(-1, 2, 3)
        arrows = Arrows(scene, "/show/axes", points=everywhere, colour=self._tones.line, shape=AXIS)
        self._nodes.extend(arrows.nodes)
        for i, (begin, end) in enumerate(everywhere):
            direction = (end - begin) / np.linalg.norm(end - begin)
            number = i % len(axes) + 1
            name = f"/show/axis_names/{i // len(axes)}/{number}"
            place = end + PAST * direction
            self._nodes.append(
                add_text(scene, name, f"y{SUBSCRIPTS[number]}", place, self._letters)
            )
