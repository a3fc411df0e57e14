"""A spatial arm with seven motors, four more than a path needs, from a file in `assets/robots`."""

from __future__ import annotations

from onpath.models.systems.robot_file import packaged_robot

ANGLES = (0.0, 0.35, 0.0, 1.45, 0.0, 1.34, 0.0)  # at home, [rad]
ROBOT = packaged_robot(
    "seven_axes",
    label="Arm with seven joints",
    text="Seven motors: without its posture the arm falls, but its tip stays on the path.",
    pose={f"joint{i}": angle for i, angle in enumerate(ANGLES, 1)},
)
