"""Optional drawings in the scene: labels, tube, coordinate curves, rank test, and more.

They belong to the page alone: they send no command and have no state in the lab, so that they also
work on a teacher's page that shows a student's lab.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable
from typing import Generic, TypeVar

import viser

from onpath.app.common.background import Background, Submit
from onpath.app.lab.snapshots.page_snapshot import PageSnapshot, parameters_of
from onpath.app.lab.snapshots.snapshot import Motion
from onpath.app.scene.error_nodes import ErrorNodes
from onpath.app.scene.mark_nodes import MarkNodes
from onpath.app.scene.mass_nodes import MassNodes
from onpath.app.scene.plane_picture import PlaneNodes
from onpath.app.scene.rank_nodes import RankPicture, rank_picture
from onpath.app.scene.robot_labels import LARGE, LETTERS, RobotLabels
from onpath.app.scene.stage import Stage
from onpath.app.scene.tube_nodes import TubeNodes, TubeShape, tube_shape
from onpath.lessons.action_schema import SceneMark
from onpath.models.control.rank_test import RankGrid
from onpath.models.systems.robots import Robot

Node = TypeVar("Node", RobotLabels, TubeNodes, PlaneNodes, ErrorNodes, MassNodes, MarkNodes)


class Drawn(Generic[Node]):
    """Nodes of one kind, redrawn when their key changes.

    Attributes:
        nodes: the drawn ones, or None.
    """

    def __init__(self) -> None:
        self.nodes: Node | None = None
        self._key: Hashable = None

    def show(self, key: Hashable, draw: Callable[[], Node]) -> None:
        """Draw the nodes, unless they are drawn with this key already."""
        if self.nodes is None or key != self._key:
            self.remove()
            self._key, self.nodes = key, draw()

    def remove(self) -> None:
        """Remove the nodes, if they are drawn."""
        if self.nodes is not None:
            self.nodes.remove()
            self.nodes = None


class Overlays:
    """The nodes that are drawn on demand. Called on the simulation thread, like the page.

    Args:
        scene: the client's scene, without earlier overlays.
        stage: where the robots stand.
        robot: their model.
        switches: names of the drawings to show, among `SWITCHES`; changed by other objects.
        submit: runs a function in another thread.
        is_narrow: whether the page is so narrow that letters must be larger.

    Attributes:
        stage, switches: see above.
        marks: the marks of a lesson's step.
    """

    def __init__(
        self,
        scene: viser.SceneApi,
        stage: Stage,
        robot: Robot,
        switches: set[str],
        submit: Submit,
        is_narrow: bool = False,
    ) -> None:
        self._letters = LARGE if is_narrow else LETTERS
        self._scene, self.stage, self._robot = scene, stage, robot
        self.switches = switches
        self._labels = Drawn[RobotLabels]()
        self._tube = Drawn[TubeNodes]()
        self._rank = Drawn[PlaneNodes]()
        self._errors = Drawn[ErrorNodes]()
        self._mass = Drawn[MassNodes]()
        self._marks = Drawn[MarkNodes]()
        self.marks: tuple[SceneMark, ...] = ()
        self._shape: Background[TubeShape] = Background(submit)
        self._map: Background[RankPicture] = Background(submit)

    @property
    def shape(self) -> TubeShape | None:
        """The tube that is drawn, or None."""
        return self._shape.value if self._tube.nodes is not None else None

    @property
    def rank_map(self) -> RankGrid | None:
        """The map that is drawn, or None."""
        picture = self._map.value if self._rank.nodes is not None else None
        return None if picture is None else picture.grid

    def update(self, motion: Motion) -> None:
        """Move the drawings that move with the robots."""
        if self._labels.nodes is not None:
            self._labels.nodes.update(motion)
        if self._errors.nodes is not None:
            self._errors.nodes.follow(motion)

    def follow(self, snapshot: PageSnapshot) -> None:
        """Draw and remove nodes according to the switches and the snapshot."""
        self._follow_labels(snapshot)
        self._follow_tube(snapshot)
        self._follow_map(snapshot)
        self._follow_errors(snapshot)
        self._follow_mass(snapshot)
        self._follow_marks()

    def _follow_labels(self, snapshot: PageSnapshot) -> None:
        if "labels" not in self.switches:
            self._labels.remove()
            return
        self._labels.show(
            True,
            lambda: RobotLabels(
                scene=self._scene,
                stage=self.stage,
                robot=self._robot,
                motion=snapshot.motion,
                letters=self._letters,
            ),
        )

    def _follow_tube(self, snapshot: PageSnapshot) -> None:
        fill, grid, path = "tube" in self.switches, "grid" in self.switches, snapshot.path
        if fill or grid:
            self._shape.ask(path.version, lambda: tube_shape(self._robot, path))
        if (shape := self._shape.value) is None or not (fill or grid):
            self._tube.remove()
        else:
            self._tube.show(
                (self._shape.key, fill, grid),
                lambda: TubeNodes(self._scene, self.stage, shape, fill=fill, grid=grid),
            )

    def _follow_map(self, snapshot: PageSnapshot) -> None:
        if "rank" in self.switches:
            parameters = parameters_of(snapshot)
            key = self._robot.plant(parameters).tobytes()
            self._map.ask(key, lambda: rank_picture(self.stage, self._robot, parameters))
        if (picture := self._map.value) is None or "rank" not in self.switches:
            self._rank.remove()
        else:
            key = self._map.key
            self._rank.show(key, lambda: PlaneNodes(self._scene, "/show/rank", self.stage, picture))

    def _follow_errors(self, snapshot: PageSnapshot) -> None:
        if "errors" in self.switches:
            self._errors.show(True, lambda: ErrorNodes(self._scene, self.stage, snapshot.motion))
        else:
            self._errors.remove()

    def _follow_mass(self, snapshot: PageSnapshot) -> None:
        if "mass" not in self.switches:
            self._mass.remove()
            return
        motion, parameters = snapshot.motion, parameters_of(snapshot)
        self._mass.show(
            True,
            lambda: MassNodes(
                scene=self._scene,
                stage=self.stage,
                robot=self._robot,
                motion=motion,
                parameters=parameters,
            ),
        )
        if self._mass.nodes is not None:
            self._mass.nodes.follow(motion, parameters)

    def _follow_marks(self) -> None:
        if not self.marks:
            self._marks.remove()
            return
        self._marks.show(
            self.marks,
            lambda: MarkNodes(
                scene=self._scene,
                stage=self.stage,
                robot=self._robot,
                marks=self.marks,
                letters=self._letters,
            ),
        )
