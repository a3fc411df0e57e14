"""What a page draws in its scene on demand: labels, tube, coordinate curves, rank test, and more.

Like the shading of the singular zone this concerns the page alone: no command, no state of the lab.
So it works in the same way on a teacher's page that shows a student's lab.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable
from dataclasses import dataclass
from typing import Generic, TypeVar

import viser

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

Submit = Callable[[Callable[[], None]], None]
Result = TypeVar("Result")
Node = TypeVar("Node", RobotLabels, TubeNodes, PlaneNodes, ErrorNodes, MassNodes, MarkNodes)


@dataclass(slots=True)
class Switches:
    """What a user wants to see; kept while a page is rebuilt.

    Attributes:
        labels: angles, lengths and axes of the robots.
        tube: the tube around the path.
        grid: curves of constant θ and of constant ξ.
        rank: the rank test as a map.
        errors: both errors, to the timetable's point and to the path, as arrows.
        mass: the ellipse of the effective mass at the end-points.
    """

    labels: bool = False
    tube: bool = False
    grid: bool = False
    rank: bool = False
    errors: bool = False
    mass: bool = False


class Background(Generic[Result]):
    """The latest result of a computation in another thread.

    Args:
        submit: runs something in another thread.

    Attributes:
        key, value: of the latest result; None before the first one.
    """

    def __init__(self, submit: Submit) -> None:
        self._submit, self._busy = submit, False
        self._asked: Hashable = None
        self.key: Hashable = None
        self.value: Result | None = None

    def ask(self, key: Hashable, compute: Callable[[], Result]) -> None:
        """Compute unless this was the last thing asked for, or something is being computed."""
        if self._busy or key == self._asked:
            return
        self._asked, self._busy = key, True

        def work() -> None:
            try:
                self.value, self.key = compute(), key
            finally:
                self._busy = False

        self._submit(work)


class Drawn(Generic[Node]):
    """Nodes of one kind, which are drawn anew when what they show changes.

    Attributes:
        nodes: those that are drawn, or None.
    """

    def __init__(self) -> None:
        self.nodes: Node | None = None
        self._key: Hashable = None

    def show(self, key: Hashable, draw: Callable[[], Node]) -> None:
        """Draw what has this key, unless it is drawn."""
        if self.nodes is None or key != self._key:
            self.remove()
            self._key, self.nodes = key, draw()

    def remove(self) -> None:
        """Remove what is drawn."""
        if self.nodes is not None:
            self.nodes.remove()
            self.nodes = None


class Overlays:
    """The nodes that are drawn on demand. Called on the simulation thread, like the page.

    Args:
        scene: the client's scene, without earlier overlays.
        stage: where the robots stand.
        robot: what kind of robot they are.
        switches: what is to be seen; others change it.
        submit: runs something in another thread.
        is_narrow: whether letters must be larger to be read.

    Attributes:
        stage, switches: see above.
        marks: what a lesson's step puts into the scene.
    """

    def __init__(
        self,
        scene: viser.SceneApi,
        stage: Stage,
        robot: Robot,
        switches: Switches,
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
        """Move what moves with the robots."""
        if self._labels.nodes is not None:
            self._labels.nodes.update(motion)
        if self._errors.nodes is not None:
            self._errors.nodes.follow(motion)

    def follow(self, snapshot: PageSnapshot) -> None:
        """Draw what is wanted, and remove what is not; nothing if that has not changed."""
        self._follow_labels(snapshot)
        self._follow_tube(snapshot)
        self._follow_map(snapshot)
        self._follow_errors(snapshot)
        self._follow_mass(snapshot)
        self._follow_marks()

    def _follow_labels(self, snapshot: PageSnapshot) -> None:
        parts = self._scene, self.stage, self._robot
        if self.switches.labels:
            self._labels.show(True, lambda: RobotLabels(*parts, snapshot.motion, self._letters))
        else:
            self._labels.remove()

    def _follow_tube(self, snapshot: PageSnapshot) -> None:
        fill, grid, path = self.switches.tube, self.switches.grid, snapshot.path
        if fill or grid:
            self._shape.ask(path.version, lambda: tube_shape(self._robot, path))
        if (shape := self._shape.value) is None or not (fill or grid):
            self._tube.remove()
        else:
            key = self._shape.key, fill, grid
            self._tube.show(key, lambda: TubeNodes(self._scene, self.stage, shape, fill, grid))

    def _follow_map(self, snapshot: PageSnapshot) -> None:
        if self.switches.rank:
            parameters = parameters_of(snapshot)
            key = self._robot.plant(parameters).tobytes()
            self._map.ask(key, lambda: rank_picture(self.stage, self._robot, parameters))
        if (picture := self._map.value) is None or not self.switches.rank:
            self._rank.remove()
        else:
            key = self._map.key
            self._rank.show(key, lambda: PlaneNodes(self._scene, "/show/rank", self.stage, picture))

    def _follow_errors(self, snapshot: PageSnapshot) -> None:
        if self.switches.errors:
            parts = self._scene, self.stage
            self._errors.show(True, lambda: ErrorNodes(*parts, snapshot.motion))
        else:
            self._errors.remove()

    def _follow_mass(self, snapshot: PageSnapshot) -> None:
        if not self.switches.mass:
            self._mass.remove()
            return
        motion, parameters = snapshot.motion, parameters_of(snapshot)
        parts = self._scene, self.stage, self._robot, motion, parameters
        self._mass.show(True, lambda: MassNodes(*parts))
        if self._mass.nodes is not None:
            self._mass.nodes.follow(motion, parameters)

    def _follow_marks(self) -> None:
        if self.marks:
            parts = self._scene, self.stage, self._robot, self.marks, self._letters
            self._marks.show(self.marks, lambda: MarkNodes(*parts))
        else:
            self._marks.remove()
