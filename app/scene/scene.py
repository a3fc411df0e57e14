"""The 3D scene of one client, which displays a lab. For the mouse, see mouse.py.

The cost of an update depends on the number of assigned properties, not on their size, so robots
share their nodes (robot_nodes.py, path_nodes.py).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING

import numpy as np

from onpath.app.lab.snapshots.snapshot import Motion, PathSnapshot, Snapshot
from onpath.app.scene.contact_nodes import ContactNodes
from onpath.app.scene.hand_nodes import HandNodes
from onpath.app.scene.mouse import Mouse, SceneCallbacks
from onpath.app.scene.path_nodes import PathNodes
from onpath.app.scene.plane_picture import PlaneNodes
from onpath.app.scene.pointer import Pointer
from onpath.app.scene.poses import poses_of
from onpath.app.scene.robot_nodes import RobotNodes
from onpath.app.scene.stage import (
    FIELD_OF_VIEW,
    ChangingText,
    Stage,
    Titles,
    build_stage,
    view_of,
)
from onpath.app.scene.start_nodes import StartNodes
from onpath.app.scene.strokes.freehand import FreehandSheets
from onpath.app.scene.tip_nodes import TipNodes
from onpath.app.scene.wall_nodes import WallNodes
from onpath.app.view.captions import Captions
from onpath.app.viser_adapter.camera import place_camera
from onpath.lessons.words import ENGLISH, Words
from onpath.models.arrays import Array
from onpath.models.robot_files.file_chain import TipAt

if TYPE_CHECKING:
    import viser

UP = np.array([0.0, 0.0, 1.0])
"""Direction that is upwards in the picture."""


class Scene:
    """The 3D scene of one client.

    Args:
        client: owner of the scene; no other client and no shared scene is modified.
        stage: where the robots stand.
        hooks: callbacks of the scene.
        words: message catalogue for titles and sizes.
        titled: whether titles and the sizes of forces are drawn; else the page shows them.
        is_narrow: whether the page is so narrow that markers must be larger.

    Attributes:
        mouse: the mouse on end-points and control points.
    """

    def __init__(
        self,
        client: viser.ClientHandle,
        stage: Stage,
        hooks: SceneCallbacks | None = None,
        words: Words = ENGLISH,
        titled: bool = True,
        is_narrow: bool = False,
    ) -> None:
        self._client, self._titled, self._is_narrow = client, titled, is_narrow
        self._stage, self._words = stage, words
        self._sides = list(stage.bases)
        self._origins = stage.origins
        hooks, pointer = hooks or SceneCallbacks(), Pointer(stage)
        self.mouse = Mouse(stage, pointer, hooks)
        self._path: PathSnapshot | None = None
        self._path_nodes = PathNodes(
            client.scene, self._origins, self.mouse.connect_points, stage.tones
        )
        self._wall = WallNodes(
            scene=client.scene,
            origins=self._origins,
            pointer=pointer,
            on_move=hooks.on_wall_moved,
            on_turn=hooks.on_wall_turned,
            tones=stage.tones,
        )
        self._start = StartNodes(client.scene, self._origins, pointer, hooks.on_start_moved)
        self._tips: TipNodes | None = None
        self._on_tip_chosen = hooks.on_tip_chosen
        self._freehand: FreehandSheets | None = None
        self._captions = Captions(words)
        self._zone: PlaneNodes | None = None

    @property
    def stage(self) -> Stage:
        """Where the robots stand."""
        return self._stage

    def build(self, snapshot: Snapshot) -> None:
        """Create all nodes once, with the snapshot's numbers of bars, joints and points."""
        motion = snapshot.motion
        self._bases = build_stage(self._client.scene, self._stage)
        self._titles = (
            Titles(self._client.scene, self._stage, self._words) if self._titled else None
        )
        self._machine = RobotNodes(
            scene=self._client.scene,
            stage=self._stage,
            counts=motion.counts,
            laws=snapshot.laws,
            poses=poses_of(self._stage, motion),
            is_narrow=self._is_narrow,
        )
        self._contacts = ContactNodes(
            self._client.scene, self._stage, self._words, labelled=self._titled
        )
        self._hands = HandNodes(self._client.scene, self._stage)
        self.mouse.connect_grips(self._machine.grips)
        self._notes = [
            ChangingText(self._client.scene, f"/notes/{name}", base + self._stage.note)
            for name, base in self._stage.bases.items()
        ]
        self.update(motion)
        self.update_traces(snapshot)

    def update(self, motion: Motion) -> None:
        """Update all poses, and the path if its version has changed; called at about 30 Hz.

        Non-finite poses are not drawn.
        """
        self.mouse.motion = motion
        poses = poses_of(self._stage, motion)
        self._machine.update(poses)
        if self._tips is not None:
            self._tips.follow(poses)
        if self._hands.pulled:
            self._hands.move(poses["tips"])
        if self._path is None or motion.path.version != self._path.version:
            self._path = motion.path
            self._path_nodes.draw(motion.path)
        self._wall.draw(motion.wall)
        self._start.draw(motion.start)

    def update_traces(self, snapshot: Snapshot) -> None:
        """Redraw traces, titles, markers, force labels and a stroke; called at 5 to 10 Hz."""
        if self._titles is not None:
            self._titles.show(snapshot.laws, self._captions.follow(snapshot))
        self._machine.update_laws(snapshot.laws)
        self._machine.update_traces([snapshot.robots[side] for side in self._sides])
        self._contacts.update(snapshot)
        self._hands.show(snapshot)
        freehand = self._freehand  # another thread may end the stroke
        drawing = self.is_drawing
        if freehand is not None:
            freehand.draw()
        for note in self._notes:
            note.show(Words(snapshot.key.language)("scene.draw") if drawing else snapshot.note)

    def show_singular_zone(self, visible: bool = True) -> None:
        """Shade the nearly singular points in the path's plane, or remove the shading."""
        if visible == (self._zone is not None):
            return
        if self._zone is not None:
            self._zone.remove()
            self._zone = None
        else:
            picture = self._stage.zone()
            self._zone = PlaneNodes(self._client.scene, "/zone", self._stage, picture)

    def show_start(self, visible: bool) -> None:
        """Show the start of the next run, which can be dragged, or hide it.

        While it is shown, it can also be moved by the links of a robot from a file.
        """
        if visible != self._start.is_shown:
            self._start.show(visible)
            self.mouse.connect_bodies(self._machine.bodies, visible)

    def show_tips(self, tips: Mapping[str, TipAt], motion: Motion, reach: float) -> None:
        """Show tips that can be chosen by a press, or hide them if there are none.

        Args:
            reach: of the robot, [m].
        """
        if bool(tips) == (self._tips is not None):
            return
        if self._tips is not None:
            self._tips.remove()
            self._tips = None
        else:
            self._tips = TipNodes(
                scene=self._client.scene,
                stage=self._stage,
                tips=tips,
                poses=poses_of(self._stage, motion),
                reach=reach,
                on_choose=self._on_tip_chosen,
            )

    def frame_camera(self, top: float, path: Array | None = None) -> None:
        """Point the client's camera so that both robots fill the canvas below a margin [px].

        Args:
            path: the points of a path that is to be seen from above; see `view_of`.
        """
        camera = self._client.camera
        size = (max(camera.image_width, 1), max(camera.image_height, 1))
        pose = view_of(self._stage, size, top, path)
        place_camera(self._client, pose.position, pose.look_at, UP, float(FIELD_OF_VIEW))

    def begin_freehand(self, on_stroke: Callable[[np.ndarray], None]) -> None:
        """Let the user draw one stroke on a robot's plane.

        Args:
            on_stroke: called with its points in the robot's frame, shape (n, 3), [m].
        """
        self.end_freehand()
        self._freehand = FreehandSheets(self._client.scene, self._stage, on_stroke)

    @property
    def is_drawing(self) -> bool:
        """Whether the user may draw a stroke now."""
        freehand = self._freehand  # another thread may end the stroke
        return freehand is not None and freehand.active

    def end_freehand(self) -> None:
        """Cancel drawing; no effect when no stroke is active."""
        if self._freehand is not None:
            self._freehand.cancel()
            self._freehand = None
