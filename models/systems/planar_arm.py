"""A planar arm with three motors, one more than a path needs, from a file in `assets/robots`."""

from __future__ import annotations

from onpath.models.systems.robot_file import own_robot

ROBOT = own_robot(
    "planar_arm",
    label="Planar arm with three joints",
    text="Three motors, one more than the path needs: a posture is held beside the path.",
    pose={"joint1": 2.0, "joint2": -1.3, "joint3": -0.9},
)
