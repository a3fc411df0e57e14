"""Sliding mode: pull back onto the path as hard as it takes, on whichever side the robot is."""

from __future__ import annotations

import casadi as ca

from onpath.models.control.laws.law import ControlAction, Law, View, own_gain
from onpath.models.control.laws.path_following import followed, tangential

SLOPE = 20.0  # c, [1/s]


def sliding_mode(view: View) -> ControlAction:
    """Path following with v_perp = -c ξ' - reach sign(s) min(|s| / boundary, 1), s = ξ' + c ξ."""
    reach, boundary = view.own_gains["reach"], view.own_gains["boundary"]
    sliding = view.output.xi_rate + SLOPE * view.output.xi
    pull = reach * ca.sign(sliding) * ca.fmin(ca.fabs(sliding) / boundary, 1)
    across = -SLOPE * view.output.xi_rate - pull
    return followed(view, tangential(view), across)


LAW = Law(
    name="sliding_mode",
    label="Sliding mode",
    text="Pulls back onto the curve with the same force, however near it is.",
    source="Slotine and Li, Applied Nonlinear Control, chapter 7",
    command=sliding_mode,
    aim="theta",
    gains=("K4", "K5"),
    own_gains=(
        own_gain("reach", 2.0, "m/s²", (0, 20, 0.1), "how hard it pulls", label="Reach"),
        own_gain("boundary", 0.02, "m/s", (0.01, 1, 0.01), "pulls less below", label="Boundary"),
    ),
    good="A constant force of less than its reach does not move it off the curve.",
    limits="With a narrow boundary its torque trembles.",
    objection="Its authors would choose the reach from a bound of the disturbance.",
)
