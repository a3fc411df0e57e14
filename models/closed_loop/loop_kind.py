"""The structural choices of a closed loop, beyond its robot."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Kind:
    """The choices that need a kernel of their own; everything else is a run-time setting.

    Attributes:
        controller: one of `laws.NAMES`.
        closed: whether the path is a closed curve.
        level_set: whether λ is the paper's s(y) instead of the signed distance.
        encoder: whether the controller gets quantised angles and filtered velocities instead of the
            exact state.
        free: whether the loop may omit external forces, torque limits, dry friction and held
            torques, for speed. It is equivalent to the full loop while none of these act.
        law: the controlled output of a flexible robot: "redefined" (with a share α of the
            deflection) or "composite" (the tip, see models/control/composite_control.py).
    """

    controller: str
    closed: bool = True
    level_set: bool = False
    encoder: bool = False
    free: bool = False
    law: str = "redefined"
