"""The tips that a robot's file suggests besides its own: balls with names; a press chooses one."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING

import numpy as np

from onpath.app.common import palette
from onpath.app.scene import meshes
from onpath.app.scene.poses import UNSEEN, Poses, difference
from onpath.app.scene.stage import Stage, add_copies, add_text
from onpath.app.viser_adapter.frame_channel import move_node, update_node
from onpath.models.arrays import Array
from onpath.models.robot_files.file_chain import TipAt
from onpath.models.robot_files.xml_elements import shown

if TYPE_CHECKING:
    import viser

    ClickEvent = viser.SceneNodePointerEvent[viser.BatchedMeshHandle]

RADIUS, LETTERS = 0.03, 0.036
"""Radius of the balls, and height of the names over them, as shares of the robot's reach."""


class TipNodes:
    """A ball at each tip of each robot, with names at the last one; only while they are shown.

    Args:
        scene: the client's scene.
        stage: where the robots stand.
        tips: the suggested tips, and where they are.
        poses: of the robots.
        reach: of the robot, [m].
        on_choose: called with the name of the tip that is pressed.
    """

    def __init__(
        self,
        *,
        scene: viser.SceneApi,
        stage: Stage,
        tips: Mapping[str, TipAt],
        poses: Poses,
        reach: float,
        on_choose: Callable[[str], None],
    ) -> None:
        self._names, self._at = list(tips), list(tips.values())
        self._origins, self._on_choose = stage.origins, on_choose
        self._places, letters = self._placed(poses), LETTERS * reach
        steps = np.arange(1, len(tips) + 1) * letters  # tips may coincide
        self._above = np.outer(steps, [0.0, 0.0, 1.0])
        ball = meshes.ball(RADIUS * reach)
        self._balls = add_copies(
            scene, "/tips/balls", ball, self._places, palette.SELECTED, shadow=False
        )
        self._balls.on_click()(self._pressed)
        self._texts = [
            add_text(scene, f"/tips/{i}", shown(self._names[i]), place, letters)
            for i, place in enumerate(self._name_places)
        ]

    def follow(self, poses: Poses) -> None:
        """Move with the robots; sends nothing while they stand still."""
        places = self._placed(poses)
        if UNSEEN < difference(places, self._places) < np.inf:  # false for NaN
            self._places = places
            update_node(self._balls, batched_positions=places)
            for text, place in zip(self._texts, self._name_places, strict=True):
                move_node(text, place)

    def remove(self) -> None:
        """Remove all nodes."""
        for node in (self._balls, *self._texts):
            node.remove()

    @property
    def _name_places(self) -> Array:
        """Where the names stand, (tips, 3), [m]."""
        count = len(self._origins)
        return self._places[count - 1 :: count] + self._above

    def _placed(self, poses: Poses) -> Array:
        """Places in the world, first those of the first tip of all robots, (k, 3), [m]."""
        places, count = list[Array](), len(self._origins)
        for at in self._at:
            if not at.body:
                places += [origin + at.place for origin in self._origins]
                continue
            rows = slice((at.body - 1) * count, at.body * count)
            turns = zip(poses["bodies"][rows], poses["attitudes"][rows], strict=True)
            places += [origin + _turned(turn, np.array(at.place)) for origin, turn in turns]
        return np.array(places, dtype=float)

    async def _pressed(self, event: ClickEvent) -> None:
        """Mouse callback; a coroutine without await, because viser runs those in order."""
        number = event.instance_index
        if number is not None and number < len(self._places):  # a browser may send any number
            self._on_choose(self._names[number // len(self._origins)])


def _turned(quaternion: Array, vector: Array) -> Array:
    """A vector turned by a unit quaternion, its scalar first."""
    across = np.cross(quaternion[1:], vector)
    return vector + 2 * (quaternion[0] * across + np.cross(quaternion[1:], across))
