"""Snapshot for the scene: one lab at one instant, as plain data."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import prod
from typing import NamedTuple

import numpy as np

from onpath.models.paths.curves import Curve

MARKER, TIP, END, FORCE = -4, -3, -2, -1  # indices of these in a robot's points


def _nothing() -> np.ndarray:
    return np.zeros((0, 3))


class PoseShapes(NamedTuple):
    """Shapes of the fields of `RobotSnapshot.poses`, in their order.

    Attributes:
        bars: beginnings of the link meshes, in their layers, [m]; then, for each mark, that of the
            strip if it were straight.
        quaternions: orientations of the link meshes, scalar first.
        parts: positions of bearings, pen, two marker discs and further points, [m].
        tips: drawn end-point, [m].
        bodies: origins of the frames of moving bodies, [m].
        attitudes: their orientations, scalar first.
        lengths: of the bars, [m].
        turns: rotations of the parts about the vertical axis, scalar first.
        forces: on the end-point, [N].
    """

    bars: tuple[int, ...]
    quaternions: tuple[int, ...]
    parts: tuple[int, ...]
    tips: tuple[int, ...]
    bodies: tuple[int, ...]
    attitudes: tuple[int, ...]
    lengths: tuple[int, ...]
    turns: tuple[int, ...]
    forces: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class Counts:
    """Numbers of parts of a robot; the last `strip` bars are pieces of one flexible strip.

    A robot with bodies is drawn by these instead of its bars.
    """

    bars: int
    joints: int
    marks: int
    strip: int = 0
    bodies: int = 0

    @property
    def links(self) -> int:
        """Number of bars that are rigid links."""
        return self.bars - self.strip

    @property
    def behind(self) -> list[bool]:
        """Whether each bar is in the back layer: every other link, no piece of a strip."""
        return [i < self.links and i % 2 == 0 for i in range(self.bars)]

    @property
    def points(self) -> int:
        """Number of points: ends of bars, joints, marks, marker, drawn tip, end-point and force."""
        return 2 * self.bars + self.joints + self.marks + 4

    @property
    def pose_shapes(self) -> PoseShapes:
        """Shapes in `RobotSnapshot.poses`; parts are bearings, pen, two marker discs, and marks."""
        bars, parts = self.bars + self.marks, self.joints + 3 + self.marks
        return PoseShapes(
            bars=(bars, 3),
            quaternions=(bars, 4),
            parts=(parts, 3),
            tips=(1, 3),
            bodies=(self.bodies, 3),
            attitudes=(self.bodies, 4),
            lengths=(bars,),
            turns=(parts, 4),
            forces=(1, 3),
        )

    @property
    def size(self) -> int:
        """Number of all coordinates of points and poses."""
        return 3 * self.points + sum(prod(shape) for shape in self.pose_shapes)


@dataclass(frozen=True, slots=True)
class RobotSnapshot:
    """One robot as it is drawn; positions in the robot's own frame (x right, y away, z up), [m].

    Attributes:
        law: name of its control law.
        points: the values of the properties below, in their order, shape (counts.points, 3).
        poses: of the meshes, flat; see `Counts.pose_shapes`.
        counts: numbers of parts.
        trace: the end-point's recent positions, never exaggerated, oldest first, shape (n, 3);
            empty if not requested.
        distance: from the end-point to the path, [m].
        max_distance: largest distance since reset, [m].
        speed: along the path, [m/s].
        torque: shape (m,), [N m].
        far: share of its law's command that returns to the path from far away, 0 to 1.
        integral_used: share of its bound that its law's integral takes, 0 to 1.
        deflection: of the end-point from its position with rigid links, [m]; NaN if they are rigid.
    """

    law: str
    points: np.ndarray
    poses: np.ndarray
    counts: Counts
    trace: np.ndarray
    distance: float
    max_distance: float
    speed: float
    torque: np.ndarray
    far: float = 0.0
    integral_used: float = 0.0
    deflection: float = float("nan")

    @property
    def bars(self) -> np.ndarray:
        """Straight pieces of the links, shape (counts.bars, 2, 3)."""
        return self.points[: 2 * self.counts.bars].reshape(-1, 2, 3)

    @property
    def joints(self) -> np.ndarray:
        """Centres of the bearings, shape (counts.joints, 3)."""
        begin = 2 * self.counts.bars
        return self.points[begin : begin + self.counts.joints]

    @property
    def marks(self) -> np.ndarray:
        """Further marked points (a rigid tip, for instance), shape (counts.marks, 3)."""
        begin = 2 * self.counts.bars + self.counts.joints
        return self.points[begin : begin + self.counts.marks]

    @property
    def marker(self) -> np.ndarray:
        """What the law aims at: its reference point or the closest point, shape (3,)."""
        return self.points[MARKER]

    @property
    def tip(self) -> np.ndarray:
        """End of the last bar as drawn, with an exaggerated deflection, shape (3,)."""
        return self.points[TIP]

    @property
    def end(self) -> np.ndarray:
        """The actual end-point, shape (3,)."""
        return self.points[END]

    @property
    def force(self) -> np.ndarray:
        """External force on the end-point, shape (3,), [N]."""
        return self.points[FORCE]


@dataclass(frozen=True, slots=True)
class PathSnapshot:
    """The drawn path, in the robot's own frame, [m]. The same for both robots.

    Attributes:
        version: changes whenever anything here does; bytes while the past is viewed.
        curve: the path itself.
        points: at evenly spaced θ from -π to π, shape (n, 3); a closed curve repeats its first one.
        dashes: of the links where the pen is raised, shape (k, 2, 3).
        control_points: shape (k, 3); empty when the curve has none.
        selected: index of the selected control point, or None.
        refused: positions of the errors of the last refused edit, shape (n, 3); usually empty.
        given: the line of a file or a stroke, if the path is far from it, shape (n, 3), else empty.
    """

    version: int | bytes
    curve: Curve
    points: np.ndarray
    control_points: np.ndarray
    selected: int | None
    refused: np.ndarray
    given: np.ndarray = field(default_factory=lambda: np.zeros((0, 3)))
    dashes: np.ndarray = field(default_factory=lambda: np.zeros((0, 2, 3)))

    @property
    def drawn(self) -> np.ndarray:
        """The straight lines between `points` where the pen is down, shape (k, 2, 3)."""
        lines = np.stack([self.points[:-1], self.points[1:]], axis=1)
        theta = np.linspace(-np.pi, np.pi, len(self.points))
        return lines[self.curve.draws((theta[1:] + theta[:-1]) / 2)]


@dataclass(frozen=True, slots=True)
class PageKey:
    """Key of a page: when it changes, the page is rebuilt.

    Attributes:
        robot: name of the robot.
        fields: names and sizes of the plotted fields; see `app.lab.plot_samples`.
        motors: units of its motors; see `MechanicalSystem.motor_units`.
        language: of the interface and the texts.
        in_lesson: whether a lesson is open.
        presenting: whether large type for a projector is on.
        student: number in the class of the student whose lab a teacher follows; 0 for the user's
            own lab.
        plane: where the path's plane is; see `models.paths.frames.Frame.numbers`.
    """

    robot: str = "five_bar"
    fields: tuple[tuple[str, int], ...] = ()
    motors: tuple[str, ...] = ("N m",)
    language: str = "en"
    in_lesson: bool = False
    presenting: bool = False
    student: int = 0
    plane: tuple[float, float, float] = (0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class Motion:
    """Where everything in the scene is at one instant: what is shown most often.

    Attributes:
        key: see `PageKey`.
        path: followed by both robots.
        counts: numbers of parts of each robot.
        drawn: `RobotSnapshot.points` and `RobotSnapshot.poses` of each robot, left first, shape
            (robots, counts.size).
        wall, start: see `Snapshot`.
    """

    key: PageKey
    path: PathSnapshot
    counts: Counts
    drawn: np.ndarray
    wall: np.ndarray = field(default_factory=_nothing)
    start: np.ndarray = field(default_factory=_nothing)

    def point(self, robot: int, index: int) -> np.ndarray:
        """A point of one robot, shape (3,); see `RobotSnapshot.points`."""
        return self.drawn[robot, : 3 * self.counts.points].reshape(-1, 3)[index]


@dataclass(frozen=True, slots=True)
class Snapshot:
    """Everything that the scene of a lab shows at one instant.

    Attributes:
        time: simulated, [s].
        running: whether simulated time advances.
        achieved_speed: simulated seconds per wall second over the last second.
        robots: by side, left first.
        path: followed by both robots.
        held: whether a robot is held back.
        held_back: sides of the robots that are held back.
        brakes: of the robots that are held back, by side: where the end-point was held [m], the
            unit vector along which it cannot move, and the one along which it can, shape (3, 3);
            the latter is 0 if it cannot move at all. Empty while the past is viewed.
        stopped: sides of the robots that have diverged by then and stand still.
        remedy: see `Breakdown.remedy`; empty if no robot is stopped.
        grabbed: side of the robot whose end-point is being pulled, or None.
        pulled: sides of the robots at which a hand pulls now; empty while the past is viewed.
        message: message to the user (a divergence, a refusal), plain text, or "".
        message_level, messages: see `Lab`.
        note: remark on the scale of the drawing, or "".
        key: see `PageKey`.
        wall: a point of the wall's surface [m], and two unit vectors: along the wall in the path's
            plane, and its normal towards the free side, shape (3, 3); (0, 3) if there is none.
        start: where the next run starts, and that place moved by a second's velocity [m], shape
            (2, 3); (0, 3) if it is not known.
    """

    time: float
    running: bool
    achieved_speed: float
    robots: dict[str, RobotSnapshot]
    path: PathSnapshot
    held: bool
    grabbed: str | None
    message: str
    message_level: str
    messages: int = 0
    note: str = ""
    key: PageKey = PageKey()
    wall: np.ndarray = field(default_factory=_nothing)
    start: np.ndarray = field(default_factory=_nothing)
    held_back: tuple[str, ...] = ()
    pulled: tuple[str, ...] = ()
    brakes: dict[str, np.ndarray] = field(default_factory=dict)
    stopped: tuple[str, ...] = ()
    remedy: dict[str, float | int | str] = field(default_factory=dict)

    @property
    def laws(self) -> dict[str, str]:
        """Control law of each side."""
        return {side: robot.law for side, robot in self.robots.items()}

    @property
    def motion(self) -> Motion:
        """The part of it that is shown most often."""
        robots = list(self.robots.values())
        drawn = np.stack([np.concatenate([robot.points.ravel(), robot.poses]) for robot in robots])
        return Motion(
            key=self.key,
            path=self.path,
            counts=robots[0].counts,
            drawn=drawn,
            wall=self.wall,
            start=self.start,
        )
