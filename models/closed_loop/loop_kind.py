"""What a closed loop is made of, beyond its robot."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Kind:
    """What a loop is made of; all else is a run-time setting.

    Attributes:
        controller: one of `controllers.NAMES`.
        closed: whether its path is a closed curve.
        level_set: lambda is the paper's s(y) instead of the distance.
        encoder: the controller sees encoder steps and filtered velocities, not the truth.
        free: nothing pushes, no limit or dry friction bears on the torque, and the controller
            acts in every tick; what these need is left out, for speed alone.
        law: what is put on the path, the "redefined" output, or by "composite" control the tip
            of a flexible link; see composite_control.py.
    """

    controller: str
    closed: bool = True
    level_set: bool = False
    encoder: bool = False
    free: bool = False
    law: str = "redefined"
