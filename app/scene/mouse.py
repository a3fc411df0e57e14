"""The mouse on end-points and control points: pulling, dragging and selecting."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from onpath.app.lab.snapshots.snapshot import END, TIP, Motion
from onpath.app.scene.pointer import DragByOffset, Pointer
from onpath.app.scene.pointer_projection import DragPlane
from onpath.app.scene.stage import Stage

if TYPE_CHECKING:
    import viser

    from onpath.app.scene.pointer import DragEvent

    ClickEvent = viser.SceneNodePointerEvent[viser.BatchedMeshHandle]

WITHIN = 0.01
"""Picking radius of a control point that the end-point covers [m]."""


def _ignore(*_: object) -> None:
    """Default callback; does nothing."""


@dataclass(frozen=True, slots=True)
class SceneCallbacks:
    """Callbacks of the scene. They run on viser's event loop, so they must only enqueue.

    Attributes:
        on_grab: the end-point on the named side is pulled to a target, shape (3,), in the robot's
            frame [m]; called again whenever the target moves.
        on_release: the robot on the named side is released.
        on_point_dragged: a control point has a new position, shape (3,), in the robot's frame [m].
        on_point_drag_end: the control point is released.
        on_point_selected: a control point was clicked or grabbed.
        on_wall_moved: the wall's middle has a new position, shape (3,), in the robot's frame [m].
        on_wall_turned: an end of the wall, 1 or -1, must point at a position, shape (3,), [m].
        on_start_moved: the start of the next run has a new position, shape (3,), [m].
        on_tip_chosen: the tip with a name was pressed.
        on_joint_dragged: the link behind the joint with a number is dragged to a position, shape
            (3,), [m].
    """

    on_grab: Callable[[str, np.ndarray], None] = _ignore
    on_release: Callable[[str], None] = _ignore
    on_point_dragged: Callable[[int, np.ndarray], None] = _ignore
    on_point_drag_end: Callable[[int], None] = _ignore
    on_point_selected: Callable[[int], None] = _ignore
    on_wall_moved: Callable[[np.ndarray], None] = _ignore
    on_wall_turned: Callable[[int, np.ndarray], None] = _ignore
    on_start_moved: Callable[[np.ndarray], None] = _ignore
    on_joint_dragged: Callable[[int, np.ndarray], None] = _ignore
    on_tip_chosen: Callable[[str], None] = _ignore


class Mouse:
    """The mouse on the end-points and the control points of all robots.

    Its callbacks are coroutines without await, because viser runs those in order.

    Args:
        stage: where the robots stand.
        pointer: where the mouse is.
        hooks: the callbacks.

    Attributes:
        motion: the displayed motion.
        pull: name of the plane in which an end-point is pulled, one of the stage's.
        path_first: whether a press where an end-point covers a control point takes the latter; the
            selected one is always taken.
    """

    def __init__(self, stage: Stage, pointer: Pointer, hooks: SceneCallbacks) -> None:
        self._stage, self._pointer, self._hooks = stage, pointer, hooks
        self._sides = list(stage.bases)
        self.motion: Motion | None = None
        self.pull = next(iter(stage.pulls))
        self.path_first = False
        self._grip: tuple[DragPlane, np.ndarray] | None = None
        self._covered: int | None = None
        self._bodies = list[tuple[Any, Any]]()  # callbacks and their nodes
        self._point = DragByOffset(pointer)

    def pull_in(self, plane: str) -> None:
        """Pull end-points in the plane with this name, if the stage has it."""
        if plane in self._stage.pulls:
            self.pull = plane

    def connect_grips(self, grips: viser.BatchedMeshHandle) -> None:
        """Listen to the node by which end-points are pulled, with an instance for every robot."""
        grips.on_drag("left")(self._tip_dragged)

    def connect_points(self, points: viser.BatchedMeshHandle) -> None:
        """Listen to a node of control points; see `PathNodes`."""
        points.on_drag("left")(self._point_dragged)
        points.on_click()(self._point_clicked)

    def connect_bodies(self, bodies: Sequence[viser.BatchedMeshHandle], on: bool) -> None:
        """Listen to the nodes of moving bodies, by which joints are dragged, or no longer."""
        for handler, body in self._bodies:
            body.remove_drag_callback(handler)
        self._bodies = []
        for joint, body in enumerate(bodies) if on else ():
            handler = partial(self._body_dragged, joint)
            body.on_drag("left")(handler)
            self._bodies.append((handler, body))

    async def _body_dragged(self, joint: int, event: DragEvent) -> None:
        robot = event.instance_index
        if robot is None or robot >= len(self._sides):  # a browser may send any number
            return
        pressed = np.array(event.start_position) - self._stage.bases[self._sides[robot]]
        plane = DragPlane(pressed, self._stage.path_plane.normal)
        target = self._pointer.place(event, event.end_position, robot, plane)
        if target is not None:
            self._hooks.on_joint_dragged(joint, target)

    async def _tip_dragged(self, event: DragEvent) -> None:
        robot = event.instance_index
        if robot is None or robot >= len(self._sides):  # a browser may send any number
            return
        side = self._sides[robot]
        if event.phase == "start":
            self._covered = self._covered_point(event, robot)
        if self._covered is not None:
            self._drag_point(event, robot, self._covered)
            return
        if event.phase == "end":
            self._hooks.on_release(side)
            return
        if event.phase == "start" or self._grip is None:
            self._grip = self._grip_of(robot)
        plane, offset = self._grip
        target = self._pointer.place(event, event.end_position, robot, plane)
        if target is not None:
            self._hooks.on_grab(side, target + offset)

    def _grip_of(self, robot: int) -> tuple[DragPlane, np.ndarray]:
        """Plane of a new pull, and offset from the drawn end-point to the actual one, [m]."""
        assert self.motion is not None
        tip, end = self.motion.point(robot, TIP), self.motion.point(robot, END)
        return DragPlane(tip, self._stage.pulls[self.pull].normal), end - tip

    def _covered_point(self, event: DragEvent, robot: int) -> int | None:
        """The control point to select when an end-point that covers it is pressed, if any."""
        assert self.motion is not None
        path, pressed = self.motion.path, self._pointer.place(event, event.start_position, robot)
        if pressed is None or not len(path.control_points):
            return None
        distances = np.linalg.norm(path.control_points - pressed, axis=1)
        nearest = int(distances.argmin())
        meant = self.path_first or nearest == path.selected
        return nearest if meant and distances[nearest] < WITHIN else None

    async def _point_dragged(self, event: DragEvent) -> None:
        if (found := self._robot_and_point(event.instance_index)) is not None:
            robot, index = found
            self._drag_point(event, robot, index)

    def _drag_point(self, event: DragEvent, robot: int, index: int) -> None:
        if event.phase == "start":
            assert self.motion is not None
            self._point.press(event, robot, self.motion.path.control_points[index])
            self._hooks.on_point_selected(index)
        target = self._point.target(event, robot)
        if target is not None:
            self._hooks.on_point_dragged(index, target)
        if event.phase == "end":
            self._hooks.on_point_drag_end(index)

    async def _point_clicked(self, event: ClickEvent) -> None:
        if (found := self._robot_and_point(event.instance_index)) is not None:
            self._hooks.on_point_selected(found[1])

    def _robot_and_point(self, instance: int | None) -> tuple[int, int] | None:
        """Numbers of the robot and of the control point of an instance; None if there is none.

        The path may have changed since the browser drew it, and a browser may send any number.
        """
        count = 0 if self.motion is None else len(self.motion.path.control_points)
        if instance is None or instance >= count * len(self._sides):
            return None
        robot, index = divmod(instance, count)
        return robot, index
