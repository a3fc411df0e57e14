"""A spatial arm with seven axes, from the file assets/robots/seven_axes.urdf.

Its joints turn by turns along the links and across them, as in many arms that work beside people:
three coordinates of its tip leave four to its posture.
"""

from __future__ import annotations

from onpath.models.systems.own_file import own_robot

ROBOT = own_robot(
    "seven_axes",
    label="Seven-axis arm",
    text="Seven motors for a tip in space: four more than its path needs hold a posture.",
    home=(0.0, 0.35, 0.0, 1.45, 0.0, 1.34, 0.0),
)
