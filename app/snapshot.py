"""What one session shows at one instant: everything the scene and the plots read, nothing else."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

FollowerName = "path_following"
TrackerName = "trajectory_tracking"


@dataclass(frozen=True, slots=True)
class RobotView:
    """One robot as it is drawn; positions in the robot's own frame (x right, y away, z up), [m].

    Attributes:
        bars: straight pieces of the links, shape (n_bars, 2, 3).
        joints: bearing centres, shape (n_joints, 3).
        tip: the end-point as drawn, a deflection perhaps exaggerated, shape (3,).
        marker: what the controller aims at: the tracker's moving reference point, the follower's
            closest point, shape (3,).
        force: external force on the end-point, shape (3,), [N].
        trace: the end-point's recent positions, never exaggerated, oldest first, shape (n, 3).
        distance: of the end-point to the path, [m].
        max_distance: the same, largest since reset, [m].
        speed: along the path, [m/s].
        torque: shape (m,), [N m].
        extra_points: further marked points (a rigid tip, for instance), shape (n, 3).
        deflection: of the end-point from where rigid links would have it, [m]; NaN for those.
    """

    bars: np.ndarray
    joints: np.ndarray
    tip: np.ndarray
    marker: np.ndarray
    force: np.ndarray
    trace: np.ndarray
    distance: float
    max_distance: float
    speed: float
    torque: np.ndarray
    extra_points: np.ndarray = field(default_factory=lambda: np.zeros((0, 3)))
    deflection: float = float("nan")


@dataclass(frozen=True, slots=True)
class PathView:
    """The path as it is drawn, in the robot's own frame, [m]. The same for both robots.

    Attributes:
        version: changes whenever anything here does.
        points: samples of the curve, shape (n, 3); a closed curve repeats its first point.
        control_points: shape (k, 3); empty when the curve has none.
        selected: index of the selected control point, or None.
        refused: places where the last refused edit was wrong, shape (n, 3); usually empty.
    """

    version: object
    points: np.ndarray
    control_points: np.ndarray
    selected: int | None
    refused: np.ndarray


@dataclass(frozen=True, slots=True)
class Snapshot:
    """A session at one instant.

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
