"""A planar arm with three motors, one more than a path needs, from a file in `assets/robots`."""

from __future__ import annotations

from onpath.models.systems.robot_file import packaged_robot

ROBOT = packaged_robot(
    "planar_arm",
    label="Planar arm with three joints",
    text="Three motors, one more than the path needs: the arm also holds a posture.",
    pose={"joint1": 2.0, "joint2": -1.3, "joint3": -0.9},
)
