"""A planar arm with three joints, from the file assets/robots/planar_arm.urdf.

Two coordinates of its tip leave one to its posture.
"""

from __future__ import annotations

from onpath.models.systems.own_file import own_robot

ROBOT = own_robot(
    "planar_arm",
    label="Planar three-link arm",
    text="Three motors in a vertical plane: one more than its path needs holds a posture.",
    home=(2.0, -1.3, -0.9),
)
