"""What viser shows in one browser tab: the scene of a lab, its camera and its drawings."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import viser

from onpath.app.common.robot_files import other_tips
from onpath.app.common.work_thread import WorkThread
from onpath.app.lab import commands as c
from onpath.app.lab.snapshots.page_snapshot import PageSnapshot, robot_of
from onpath.app.lab.snapshots.snapshot import Motion, PageKey
from onpath.app.scene.build_queue import in_turn, one_at_a_time
from onpath.app.scene.mouse import SceneCallbacks
from onpath.app.scene.overlays import Overlays
from onpath.app.scene.pointer_projection import plane_coordinates
from onpath.app.scene.projection import seen_by, seen_from
from onpath.app.scene.scene import Scene
from onpath.app.scene.stage import view_of
from onpath.app.scene.stage_catalogue import IN_PATH_PLANE, stage_of
from onpath.app.scene.step_drawings import StepDrawings
from onpath.app.scene.tones import DARK, LIGHT
from onpath.app.view.state_message import Projection
from onpath.app.viser_adapter.frame_channel import FrameChannel
from onpath.app.viser_adapter.scene_release import clear_scene
from onpath.lessons.course import Course
from onpath.models.arrays import Array
from onpath.models.systems.robots import Robot

SETTLING = 30
"""Slow updates during which the camera is fitted repeatedly, after the canvas has changed."""
REFIT = 10
"""Slow updates from one such fit to the next."""
TITLES, MOST_TITLES = 44.0, 0.1
"""Height of the robots' titles over the scene [px], and its largest share of the canvas."""
NEAR = 1e-3
"""How far from its place a camera counts as there, relative to its distance from the robots."""

Post = Callable[[c.Command], None]
"""Takes a command."""


@dataclass(slots=True)
class Look:
    """How a browser's scene is drawn.

    Attributes:
        dark: whether the browser asks for dark pages; this may change.
        plain: whether it draws in software, so that the scene must be simple.
        upright: whether the window is, so that letters must be larger; this may change.
    """

    dark: bool = False
    plain: bool = False
    upright: bool = False


class ClientScene:
    """The scene of one client of viser; built in a thread, then updated by the simulation thread.

    Args:
        first: the initial snapshot.
        number: tells this client from the others that the page has asked for.
        look: how it is drawn.
        course: the lessons, whose steps switch drawings on.
        post: takes the commands of the mouse; those on another's lab are ignored.
        choose_tip: gives the lab the named robot from a file with another tip.
        switches: names of the drawings that are switched on; see `Overlays`.

    Attributes:
        client, number, switches: see above.
        is_outdated: whether it must be rebuilt, which takes a complete snapshot.
        pull: name of the plane in which the mouse pulls end-points; the stage's first if it has
            none of this name.
    """

    def __init__(
        self,
        client: viser.ClientHandle,
        first: PageSnapshot,
        number: int,
        look: Look,
        course: Course,
        post: Post,
        choose_tip: Callable[[str, str], None],
        switches: set[str],
    ) -> None:
        self._choose_tip = choose_tip
        self.client, self.number, self.switches = client, number, switches
        self._look, self._post = look, post
        self.pull = IN_PATH_PLANE
        self._channel = FrameChannel(client)
        self._rebuilds = WorkThread("rebuild")
        self._framed, self._settling = 0.0, SETTLING  # width / height, to which the camera fits
        self._is_placed = False  # whether the camera is where it was put
        self._on_path = False  # whether it looks at the path
        self._steps = StepDrawings(switches, course)
        self._building, self.is_outdated = True, False
        with in_turn(), client.atomic():
            self._build(first)

    def close(self) -> None:
        """Release resources after the tab has closed."""
        self._rebuilds.close()

    @property
    def is_ready(self) -> bool:
        """Whether the scene is built and its client is connected."""
        return not self._building and not self._channel.closed

    def show(self, snapshot: PageSnapshot | Motion) -> None:
        """Show a snapshot. Called on the simulation thread while the scene is ready."""
        if self._key(snapshot.key) != self._built:
            self._renew(snapshot)
            return
        with self._channel:
            if isinstance(snapshot, Motion):
                self._scene.update(snapshot)
                self._overlays.update(snapshot)
                return
            self._show_all(snapshot)

    def draw(self) -> None:
        """Take the next stroke around a robot as the path; called again, take none."""
        if self._scene.is_drawing:
            self._scene.end_freehand()
            return
        robot, post = self._robot, self._post
        self._scene.begin_freehand(
            lambda stroke: post(c.DrawPath(plane_coordinates(robot, stroke)))
        )

    def settle(self) -> None:
        """Refit the camera now and for a while, because the canvas has changed its size."""
        self._framed, self._settling = 0.0, SETTLING

    def reset_view(self) -> None:
        """Schedule a reset of the camera to its initial pose. Thread-safe."""
        self._on_path, self._framed = False, 0.0

    def look_at_path(self) -> None:
        """Look at the path from above, now and until the view is reset."""
        self._on_path = True
        self.settle()

    def send(self) -> None:
        """Send the frame to the browser."""
        self._channel.send()

    def seen(self, snapshot: PageSnapshot) -> Projection | None:
        """How the picture shows the robots, or how it will as soon as its camera is in place.

        Returns:
            None while the scene is being built.
        """
        if self._building or self.is_outdated:
            return None
        camera, robot, stage = self.client.camera, self._robot, self._scene.stage
        if self._is_placed:
            return seen_by(camera, stage, robot)
        width, height = max(camera.image_width, 1), max(camera.image_height, 1)
        path = snapshot.motion.path.points if self._on_path else None
        pose = view_of(stage, (width, height), _top(height), path)
        off, away = (np.linalg.norm(x - pose.position) for x in (camera.position, pose.look_at))
        self._is_placed = bool(off < NEAR * away) or not self._settling
        return seen_from(pose, stage, robot)

    @property
    def overlays(self) -> Overlays:
        """What is drawn on demand."""
        return self._overlays

    def _key(self, key: PageKey) -> tuple[object, ...]:
        """What the scene depends on; it is rebuilt when this changes."""
        return key.student, key.robot, key.plane, self._look.dark, self._look.upright

    def _renew(self, snapshot: PageSnapshot | Motion) -> None:
        """Rebuild the scene; nothing is shown until it is complete."""
        self.is_outdated, self._is_placed = True, False
        if isinstance(snapshot, PageSnapshot):
            self._building = True
            self._rebuilds.submit(lambda: self._rebuild(snapshot))

    def _rebuild(self, first: PageSnapshot) -> None:
        """Clear the scene and build it again, under the same names.

        viser 1.1 may draw a batched mesh once more after it has freed it and before it has put the
        new one in its place. WebGL refuses these draws with GL_INVALID_OPERATION; nothing is seen.
        """
        self._on_path &= self._robot == robot_of(first)
        with in_turn(), self.client.atomic():
            clear_scene(self.client)
            self.settle()
            self._build(first)

    def _build(self, first: PageSnapshot) -> None:
        look, robot = self._look, robot_of(first)
        self._built, self._robot = self._key(first.key), robot
        self._is_placed = False
        self.client.gui.configure_theme(dark_mode=look.dark)
        stage = stage_of(robot, DARK if look.dark else LIGHT, look.plain)
        is_shown = bool(first.key.student) or first.plant is not None
        callbacks = SceneCallbacks() if is_shown else self._callbacks(robot)
        self._scene = Scene(self.client, stage, callbacks, titled=False, is_narrow=look.upright)
        self._scene.build(first)
        one_at_a_time.rest()
        self._overlays = Overlays(
            scene=self.client.scene,
            stage=stage,
            robot=robot,
            switches=self.switches,
            submit=self._rebuilds.submit,
            is_narrow=look.upright,
        )
        self._building = self.is_outdated = False

    def _show_all(self, snapshot: PageSnapshot) -> None:
        motion, scene, overlays = snapshot.motion, self._scene, self._overlays
        scene.update(motion)
        scene.update_traces(snapshot)
        overlays.update(motion)
        self._steps.follow(snapshot)
        overlays.marks = self._steps.setup.marks
        scene.mouse.pull_in(self.pull)
        scene.mouse.path_first = "editor" in self._steps.setup.controls
        overlays.follow(snapshot)
        scene.show_singular_zone("zone" in self.switches and self._robot.frame.p == 2)
        scene.show_start("start" in self.switches)
        tips = other_tips(self._robot.name) if "tips" in self.switches else {}
        scene.show_tips(tips, motion, self._robot.reach)
        self._frame_camera(motion.path.points)

    def _frame_camera(self, path: Array) -> None:
        """Refit the camera to both robots when the aspect ratio of the view changes.

        The size in device pixels is ignored, because slow browsers change it on their own. While
        the canvas settles, a browser may not report its final shape until it is sent a camera.
        """
        if self._settling:
            self._settling -= 1
            if self._settling % REFIT == 0:
                self._framed = 0.0
        camera = self.client.camera
        width, height = camera.image_width, camera.image_height
        shape = width / max(height, 1)
        if width > 0 and abs(shape - self._framed) > 0.01 * shape:
            self._framed = shape
            self._scene.frame_camera(_top(height), path if self._on_path else None)

    def _callbacks(self, robot: Robot) -> SceneCallbacks:
        post, choose_tip = self._post, self._choose_tip  # self would keep the scene alive

        def move(index: int, at: Array) -> None:
            post(c.MovePoint(index, plane_coordinates(robot, at), finished=False))

        return SceneCallbacks(
            on_grab=lambda name, at: post(c.Grab(name, robot.output_at(at))),
            on_release=lambda name: post(c.Release(name)),
            on_point_dragged=move,
            on_point_drag_end=lambda _: post(c.EndMove()),
            on_point_selected=lambda index: post(c.SelectPoint(index)),
            on_wall_moved=lambda at: post(c.MoveWall(plane_coordinates(robot, at))),
            on_wall_turned=lambda end, at: post(c.SwingWall(end, plane_coordinates(robot, at))),
            on_tip_chosen=lambda tip: choose_tip(robot.name, tip),
            on_joint_dragged=lambda joint, at: post(c.DragJoint(joint, robot.output_at(at))),
            on_start_moved=lambda at: post(c.MoveStart(plane_coordinates(robot, at))),
        )


def _top(height: float) -> float:
    """How much of a canvas the robots' titles cover, [px]."""
    return min(TITLES, MOST_TITLES * height)
