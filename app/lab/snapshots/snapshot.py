"""What one lab shows at one instant: all that its scene reads, as plain data."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

FollowerName = "path_following"
TrackerName = "trajectory_tracking"
MARKER, TIP, END, FORCE = -4, -3, -2, -1  # where a robot's points have these


class PoseShapes(NamedTuple):
    """Shapes of the fields of `RobotView.poses`, in their order.

    Attributes:
        bars: where the link meshes begin, in their layers, [m].
        quaternions: how they are turned, scalar first.
        lengths: of the bars, [m].
        parts: bearings, pen, two marker discs, further points, [m].
        turns: how these are turned about the vertical, scalar first.
        tips: end-point as drawn, [m].
        forces: on the end-point, [N].
    """

    bars: tuple[int, ...]
    quaternions: tuple[int, ...]
    lengths: tuple[int, ...]
    parts: tuple[int, ...]
    turns: tuple[int, ...]
    tips: tuple[int, ...]
    forces: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class Counts:
    """How many parts a robot's drawing has; the last `strip` bars are pieces of one strip."""

    bars: int
    joints: int
    marks: int
    strip: int = 0

    @property
    def links(self) -> int:
        """Bars that are links."""
        return self.bars - self.strip

    @property
    def behind(self) -> list[bool]:
        """Which bars lie in the back layer: every other link, no piece of a strip."""
        return [i < self.links and i % 2 == 0 for i in range(self.bars)]

    @property
    def points(self) -> int:
        """Bars' begins and ends, joints, marks, marker, drawn tip, end-point and force."""
        return 2 * self.bars + self.joints + self.marks + 4

    @property
    def pose_shapes(self) -> PoseShapes:
        """What `RobotView.poses` holds: bearings, pen, two discs of a marker, marks are parts."""
        bars, parts = self.bars, self.joints + 3 + self.marks
        return PoseShapes((bars, 3), (bars, 4), (bars,), (parts, 3), (parts, 4), (1, 3), (1, 3))


@dataclass(frozen=True, slots=True)
class RobotView:
    """One robot as it is drawn; positions in the robot's own frame (x right, y away, z up), [m].

    Attributes:
        points: all that the properties below give, in their order, shape (counts.points, 3).
        poses: of the meshes, flat, as `Counts.pose_shapes` says.
        counts: of the parts.
        trace: the end-point's recent positions, never exaggerated, oldest first, shape (n, 3); of
            no length when nobody wants to know.
        distance: of the end-point to the path, [m].
        max_distance: the same, largest since reset, [m].
        speed: along the path, [m/s].
        torque: shape (m,), [N m].
        deflection: of the end-point from where rigid links would have it, [m]; NaN for those.
    """

    points: np.ndarray
    poses: np.ndarray
    counts: Counts
    trace: np.ndarray
    distance: float
    max_distance: float
    speed: float
    torque: np.ndarray
    deflection: float = float("nan")

    @property
    def bars(self) -> np.ndarray:
        """Straight pieces of the links, shape (counts.bars, 2, 3)."""
        return self.points[: 2 * self.counts.bars].reshape(-1, 2, 3)

    @property
    def joints(self) -> np.ndarray:
        """Bearing centres, shape (counts.joints, 3)."""
        begin = 2 * self.counts.bars
        return self.points[begin : begin + self.counts.joints]

    @property
    def marks(self) -> np.ndarray:
        """Further marked points (a rigid tip, for instance), shape (counts.marks, 3)."""
        begin = 2 * self.counts.bars + self.counts.joints
        return self.points[begin : begin + self.counts.marks]

    @property
    def marker(self) -> np.ndarray:
        """What the controller aims at: the tracker's moving reference point, the follower's
        closest point, shape (3,)."""
        return self.points[MARKER]

    @property
    def tip(self) -> np.ndarray:
        """Where the last bar ends, a deflection perhaps exaggerated, shape (3,)."""
        return self.points[TIP]

    @property
    def end(self) -> np.ndarray:
        """The end-point as it is, shape (3,)."""
        return self.points[END]

    @property
    def force(self) -> np.ndarray:
        """External force on the end-point, shape (3,), [N]."""
        return self.points[FORCE]


@dataclass(frozen=True, slots=True)
class PathView:
    """The path as it is drawn, in the robot's own frame, [m]. The same for both robots.

    Attributes:
        version: changes whenever anything here does; bytes while the past is looked at.
        points: samples of the curve, shape (n, 3); a closed curve repeats its first point.
        control_points: shape (k, 3); empty when the curve has none.
        selected: index of the selected control point, or None.
        refused: places where the last refused edit was wrong, shape (n, 3); usually empty.
    """

    version: int | bytes
    points: np.ndarray
    control_points: np.ndarray
    selected: int | None
    refused: np.ndarray


@dataclass(frozen=True, slots=True)
class PageKey:
    """What a whole page depends on: when it changes, the page is built anew.

    Attributes:
        robot: name of the robot.
        fields: names and sizes of what there is to plot; see `app.lab.plot_samples`.
        language: of all that is written.
        in_lesson: whether a lesson is open.
        presenting: large type for a projector.
        student: number in the class of the student whose lab it is, for a teacher who looks at
            it; 0 for one's own lab.
    """

    robot: str = "five_bar"
    fields: tuple[tuple[str, int], ...] = ()
    language: str = "en"
    in_lesson: bool = False
    presenting: bool = False
    student: int = 0


@dataclass(frozen=True, slots=True)
class Snapshot:
    """A lab at one instant: all that its scene shows. Plain data, see `app.lab.snapshot_codec`.

    Attributes:
        time: simulated, [s].
        running: whether simulated time advances.
        achieved_speed: simulated seconds per wall second over the last second.
        robots: by controller name, tracker first.
        path: the path both follow.
        held: whether Hold is on.
        grabbed: controller name of the robot whose end-point the hand holds, or None.
        message: what the lab says now (a divergence, a refusal), plain text, or "".
        message_level: "info", "warning" or "error".
        note: what the drawing itself must say of its scale, or "".
        key: see `PageKey`.
    """

    time: float
    running: bool
    achieved_speed: float
    robots: dict[str, RobotView]
    path: PathView
    held: bool
    grabbed: str | None
    message: str
    message_level: str
    note: str = ""
    key: PageKey = PageKey()
