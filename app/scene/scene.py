"""The 3D scene of one client: display of a lab, and callbacks for the mouse.

Cost depends on the number of property assignments, not their size, so robots share their nodes
(robot_nodes.py, path_nodes.py).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from onpath.app.common import palette
from onpath.app.lab.snapshots.snapshot import END, TIP, Motion, PathView, Snapshot
from onpath.app.scene import meshes
from onpath.app.scene.captions import Captions
from onpath.app.scene.freehand import Freehand
from onpath.app.scene.path_nodes import PathNodes
from onpath.app.scene.pointer_projection import DragPlane, pointer_on_plane
from onpath.app.scene.poses import poses_of
from onpath.app.scene.robot_nodes import RobotNodes
from onpath.app.scene.stage import (
    FIELD_OF_VIEW,
    ChangingText,
    Insets,
    Stage,
    Titles,
    add_copies,
    build_stage,
    view_of,
)
from onpath.app.scene.start_nodes import StartNodes
from onpath.app.scene.wall_nodes import WallNodes
from onpath.app.viser_adapter.camera import place_camera
from onpath.lessons.words import ENGLISH, Words

if TYPE_CHECKING:
    import viser

    DragEvent = viser.SceneNodeDragEvent[viser.BatchedMeshHandle]
    ClickEvent = viser.SceneNodePointerEvent[viser.BatchedMeshHandle]

ZONE_DEPTH = 0.052
"""y of the shading of singular places [m]: behind the links."""
ZONE_WIDTH = 0.02
"""Width of the shading at a singular circle [m]."""
UP = np.array([0.0, 0.0, 1.0])
"""Direction that is upwards in the picture."""
WITHIN = 0.01
"""Picking radius of a control point that the end-point covers [m]."""


def _ignore(*_: object) -> None:
    """Default callback; does nothing."""


@dataclass(frozen=True, slots=True)
class SceneCallbacks:
    """Callbacks of the scene. They run on viser's event loop, so they must only enqueue.

    Attributes:
        on_grab: the end-point on the named bench is pulled to a target, shape (3,), in the robot's
            frame [m]; called again whenever the target moves.
        on_release: the robot on the named bench is released.
        on_point_dragged: a control point has a new position, shape (3,), in the robot's frame [m].
        on_point_drag_end: the control point is released.
        on_point_selected: a control point was clicked or grabbed.
        on_wall_moved: the wall's middle has a new place, shape (3,), in the robot's frame [m].
        on_wall_turned: an end of the wall, 1 or -1, must point at a place, shape (3,), [m].
        on_start_moved: the start of the next run has a new place, shape (3,), [m].
    """

    on_grab: Callable[[str, np.ndarray], None] = _ignore
    on_release: Callable[[str], None] = _ignore
    on_point_dragged: Callable[[int, np.ndarray], None] = _ignore
    on_point_drag_end: Callable[[int], None] = _ignore
    on_point_selected: Callable[[int], None] = _ignore
    on_wall_moved: Callable[[np.ndarray], None] = _ignore
    on_wall_turned: Callable[[int, np.ndarray], None] = _ignore
    on_start_moved: Callable[[np.ndarray], None] = _ignore


class Scene:
    """The 3D scene of one client.

    Args:
        client: owner of the scene; no other client and no shared scene is modified.
        stage: where the robots stand.
        hooks: callbacks of the scene.
        words: message catalogue for the labels.

    Attributes:
        pull: name of the plane in which an end-point is pulled, one of the stage's.
        path_first: whether a press where an end-point covers a control point takes the latter; the
            selected one is always taken.
    """

    def __init__(
        self,
        client: viser.ClientHandle,
        stage: Stage,
        hooks: SceneCallbacks | None = None,
        words: Words = ENGLISH,
    ) -> None:
        self._client = client
        self._stage, self._words = stage, words
        self._benches = list(stage.bases)
        self._origins = stage.origins
        self._hooks = hooks or SceneCallbacks()
        self.pull = next(iter(stage.pulls))
        self.path_first = False
        self._motion: Motion | None = None
        self._grip: tuple[DragPlane, np.ndarray] | None = None
        self._path: PathView | None = None
        self._path_nodes = PathNodes(client.scene, self._origins, self._connect_points)
        self._wall = WallNodes(
            client.scene,
            self._origins,
            self._at_robot,
            self._hooks.on_wall_moved,
            self._hooks.on_wall_turned,
        )
        self._start = StartNodes(
            client.scene, self._origins, self._at_robot, self._hooks.on_start_moved
        )
        self._point_offset = np.zeros(3)
        self._covered: int | None = None
        self._freehand: Freehand | None = None
        self._captions = Captions(words)
        self._zone: viser.BatchedMeshHandle | None = None

    @property
    def stage(self) -> Stage:
        """Where the robots stand."""
        return self._stage

    def build(self, snapshot: Snapshot) -> None:
        """Creates all nodes once, with the snapshot's numbers of bars, joints and points."""
        motion = snapshot.motion
        build_stage(self._client.scene, self._stage)
        self._titles = Titles(self._client.scene, self._stage, self._words)
        poses = poses_of(self._stage, motion)
        self._machine = RobotNodes(
            self._client.scene, self._stage, motion.counts, snapshot.laws, poses, self._words
        )
        self._machine.grips.on_drag("left")(self._tip_dragged)
        self._notes = [
            ChangingText(self._client.scene, f"/notes/{name}", base + self._stage.note)
            for name, base in self._stage.bases.items()
        ]
        self.update(motion)
        self.update_traces(snapshot)

    def update(self, motion: Motion) -> None:
        """Updates all poses, and the path if its version changed; called at about 30 Hz.

        Non-finite poses are not drawn.
        """
        self._motion = motion
        self._machine.update(poses_of(self._stage, motion))
        if self._path is None or motion.path.version != self._path.version:
            self._path = motion.path
            self._path_nodes.draw(motion.path)
        self._wall.draw(motion.wall)
        self._start.draw(motion.start)

    def update_traces(self, snapshot: Snapshot) -> None:
        """Redraws traces, titles, markers, force labels and a stroke; called at 5 to 10 Hz."""
        self._titles.show(snapshot.laws, self._captions.of(snapshot))
        self._machine.update_laws(snapshot.laws)
        self._machine.update_traces([snapshot.robots[bench] for bench in self._benches])
        freehand = self._freehand  # another thread may end the stroke
        drawing = self.is_drawing
        if freehand is not None:
            freehand.draw()
        for note in self._notes:
            note.show(self._words("scene.draw") if drawing else snapshot.note)

    def show_singular_zone(self, visible: bool = True) -> None:
        """Shades the neighbourhood of the singular circles about the base pivot."""
        if self._zone is not None:
            self._zone.remove()
            self._zone = None
        if not visible:
            return
        half = float(np.ptp(self._origins[:, 0])) / 2 or 0.6
        inner, outer = self._stage.reach
        middle = float(self._stage.low[0] + self._stage.high[0]) / 2
        box = ((middle - half, self._stage.floor), (middle + half, outer + 0.2))
        inside = max(0.0, inner - ZONE_WIDTH)
        core = meshes.ring(inside, inner + ZONE_WIDTH, *box, ZONE_DEPTH)
        rim = meshes.ring(outer - ZONE_WIDTH, outer, *box, ZONE_DEPTH)
        zone = meshes.joined(core, rim)
        self._zone = add_copies(
            self._client.scene, "/zone", zone, self._origins, palette.WARNING, opacity=0.16
        )

    def show_start(self, visible: bool) -> None:
        """Shows the start of the next run, to be dragged, or hides it."""
        self._start.show(visible)

    def show_titles(self, visible: bool) -> None:
        """Shows or hides the titles, which are drawn on top of everything else."""
        self._titles.hide(not visible)

    def frame_camera(self, insets: Insets | None = None) -> None:
        """Points the client's camera so that both robots fill the canvas left free by panels."""
        camera = self._client.camera
        size = (max(camera.image_width, 1), max(camera.image_height, 1))
        pose = view_of(self._stage, size, insets or Insets())
        place_camera(self._client, pose.position, pose.look_at, UP, float(FIELD_OF_VIEW))

    def begin_freehand(self, on_stroke: Callable[[np.ndarray], None]) -> None:
        """Lets the user draw one stroke on a robot's plane; calls back with (n, 3), [m]."""
        self.end_freehand()
        self._freehand = Freehand(self._client.scene, self._stage, on_stroke)

    @property
    def is_drawing(self) -> bool:
        """Whether the user may draw a stroke now."""
        freehand = self._freehand  # another thread may end the stroke
        return freehand is not None and freehand.active

    def end_freehand(self) -> None:
        """Cancels drawing; without effect when no stroke is active."""
        if self._freehand is not None:
            self._freehand.cancel()
            self._freehand = None

    # Mouse callbacks. Coroutines without await, because viser runs those in order.

    async def _tip_dragged(self, event: DragEvent) -> None:
        index = event.instance_index
        if index is None or index >= len(self._benches):  # a browser may send any
            return
        bench = self._benches[index]
        if event.phase == "start":
            self._covered = self._covered_point(event, bench)
        if self._covered is not None:
            self._drag_point(event, bench, self._covered)
            return
        if event.phase == "end":
            self._hooks.on_release(bench)
            return
        if event.phase == "start" or self._grip is None:
            self._grip = self._grip_of(bench)
        plane, offset = self._grip
        target = self._on_plane(event, event.end_position, bench, plane)
        if target is not None:
            self._hooks.on_grab(bench, target + offset)

    def _grip_of(self, bench: str) -> tuple[DragPlane, np.ndarray]:
        """Plane of a new pull, and offset from the drawn end-point to the actual one, [m]."""
        assert self._motion is not None
        robot, normal = self._benches.index(bench), self._stage.pulls[self.pull].normal
        tip, end = self._motion.point(robot, TIP), self._motion.point(robot, END)
        return DragPlane(tip, normal), end - tip

    def _covered_point(self, event: DragEvent, bench: str) -> int | None:
        """The control point to select when an end-point that covers it is pressed, if any."""
        path, pressed = self._path, self._on_plane(event, event.start_position, bench)
        if path is None or pressed is None or not len(path.control_points):
            return None
        distances = np.linalg.norm(path.control_points - pressed, axis=1)
        nearest = int(distances.argmin())
        meant = self.path_first or nearest == path.selected
        return nearest if meant and distances[nearest] < WITHIN else None

    def _connect_points(self, points: viser.BatchedMeshHandle) -> None:
        points.on_drag("left")(self._point_dragged)
        points.on_click()(self._point_clicked)

    async def _point_dragged(self, event: DragEvent) -> None:
        if (found := self._robot_and_point(event.instance_index)) is not None:
            self._drag_point(event, *found)

    def _drag_point(self, event: DragEvent, bench: str, index: int) -> None:
        if event.phase == "start":  # keep the press's offset from the centre, so no jump
            assert self._path is not None
            pressed = self._on_plane(event, event.start_position, bench)
            centre = self._path.control_points[index]
            self._point_offset = np.zeros(3) if pressed is None else centre - pressed
            self._hooks.on_point_selected(index)
        target = self._on_plane(event, event.end_position, bench)
        if target is not None:
            self._hooks.on_point_dragged(index, target + self._point_offset)
        if event.phase == "end":
            self._hooks.on_point_drag_end(index)

    async def _point_clicked(self, event: ClickEvent) -> None:
        if (found := self._robot_and_point(event.instance_index)) is not None:
            self._hooks.on_point_selected(found[1])

    def _robot_and_point(self, instance: int | None) -> tuple[str, int] | None:
        """Robot and index of a control point that is drawn; None if there is no such instance.

        The path may have changed since the browser drew it, and a browser may send any number.
        """
        count = 0 if self._path is None else len(self._path.control_points)
        if instance is None or instance >= count * len(self._benches):
            return None
        robot, index = divmod(instance, count)
        return self._benches[robot], index

    def _at_robot(
        self, event: DragEvent, pointer: tuple[float, float, float], robot: int
    ) -> np.ndarray | None:
        """Pointer position on the path's plane in the frame of a robot, by its number."""
        return self._on_plane(event, pointer, self._benches[robot])

    def _on_plane(
        self,
        event: DragEvent,
        pointer: tuple[float, float, float],
        bench: str,
        plane: DragPlane | None = None,
    ) -> np.ndarray | None:
        """Pointer position in a robot's frame on a plane, by default the path's plane."""
        camera, stage = event.client.camera.position, self._stage
        place, base = np.array(pointer), stage.bases[bench]
        return pointer_on_plane(camera, place, base, plane or stage.path_plane, stage.reachable)
