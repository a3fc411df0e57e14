"""The wall at every robot: a solid side to move it, and two knobs to turn it."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np
from viser import transforms

from onpath.app.common import palette
from onpath.app.scene import meshes
from onpath.app.scene.pointer import DragByOffset, Pointer
from onpath.app.scene.stage import add_copies
from onpath.app.scene.tones import LIGHT, Tones
from onpath.app.viser_adapter.frame_channel import update_node

if TYPE_CHECKING:
    import viser

    from onpath.app.scene.pointer import DragEvent

KNOB = 0.009
"""Radius of the knobs [m]."""
ENDS = (1, -1)
"""The knobs of a wall: towards its end in the direction `along`, and towards the other end."""
ARM = 0.05
"""Distance of the knobs from the middle of the wall [m]."""


class WallNodes:
    """Nodes of the wall, drawn once for each robot, while there is one.

    Args:
        scene: the client's scene.
        origins: of the robots' frames in the world, shape (k, 3), [m].
        pointer: where the mouse is.
        on_move: called with the new position of the middle, shape (3,), in the robot's frame.
        on_turn: called with one of `ENDS` and the position at which it must point, shape (3,).
        tones: colours, of which its hatches have one.
    """

    def __init__(
        self,
        scene: viser.SceneApi,
        origins: np.ndarray,
        pointer: Pointer,
        on_move: Callable[[np.ndarray], None],
        on_turn: Callable[[int, np.ndarray], None],
        tones: Tones = LIGHT,
    ) -> None:
        self._tones = tones
        self._scene, self._origins, self._pointer = scene, origins, pointer
        self._drag, self._on_move, self._on_turn = DragByOffset(pointer), on_move, on_turn
        self._nodes: list[viser.BatchedMeshHandle] = []
        self._wall = np.zeros((0, 3))

    def draw(self, wall: np.ndarray) -> None:
        """Draw a wall, see `Snapshot.wall`; sends nothing if it is drawn already."""
        if wall is self._wall:
            return
        is_drawn, self._wall = np.array_equal(wall, self._wall), wall
        if is_drawn:
            return
        if not len(wall):
            for node in self._nodes:
                node.remove()
            self._nodes = []
            return
        if not self._nodes:
            self._add()
        for node, (positions, turns) in zip(self._nodes, self._poses(), strict=True):
            update_node(node, batched_positions=positions, batched_wxyzs=turns)

    def _add(self) -> None:
        (places, _), _, (knobs, _) = self._poses()
        body = add_copies(
            self._scene, "/wall/body", meshes.part("wall_body"), places, palette.STEEL, opacity=0.35
        )
        ink = self._tones.line
        lines = add_copies(self._scene, "/wall/lines", meshes.part("wall_lines"), places, ink)
        ends = add_copies(
            self._scene, "/wall/ends", meshes.ball(KNOB), knobs, palette.SELECTED, shadow=False
        )
        body.on_drag("left")(self._body_dragged)
        ends.on_drag("left")(self._end_dragged)
        self._nodes = [body, lines, ends]

    def _poses(self) -> list[tuple[np.ndarray, np.ndarray]]:
        """World positions and orientations of the copies of each node."""
        place, along, normal = self._wall
        turn = np.column_stack([along, np.cross(normal, along), normal])
        wxyz = transforms.SO3.from_matrix(turn).wxyz
        middles = self._origins + place
        ends = np.stack([end * ARM * along for end in ENDS])
        knobs = (middles[:, None] + ends).reshape(-1, 3)
        every = [(middles, np.tile(wxyz, (len(middles), 1)))] * 2
        return [*every, (knobs, np.tile(wxyz, (len(knobs), 1)))]

    # Mouse callbacks. Coroutines without await, because viser runs those in order.

    async def _body_dragged(self, event: DragEvent) -> None:
        robot = event.instance_index
        if robot is None or robot >= len(self._origins) or not len(self._wall):
            return  # a browser may send any number
        if event.phase == "start":
            self._drag.press(event, robot, self._wall[0])
        target = self._drag.target(event, robot)
        if target is not None:
            self._on_move(target)

    async def _end_dragged(self, event: DragEvent) -> None:
        instance = event.instance_index
        if instance is None or instance >= len(ENDS) * len(self._origins) or not len(self._wall):
            return
        robot, end = divmod(instance, len(ENDS))
        target = self._pointer.place(event, event.end_position, robot)
        if target is not None:
            self._on_turn(ENDS[end], target)
