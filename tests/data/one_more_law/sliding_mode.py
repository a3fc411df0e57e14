"""Sliding mode: pull back onto the path as hard as it takes, on whichever side the robot is."""

from __future__ import annotations

import casadi as ca

from onpath.models.control.laws.law import ControlAction, Law, View, own_gain
from onpath.models.control.laws.path_following import followed, tangential


def sliding_mode(view: View) -> ControlAction:
    """Path following with v_perp = -slope ξ' - reach sign(s), s = ξ' + slope ξ, [m/s²]."""
    slope, reach = view.own_gains["slope"], view.own_gains["reach"]
    sliding = view.output.xi_rate + slope * view.output.xi
    across = -slope * view.output.xi_rate - reach * ca.sign(sliding)
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
        own_gain(
            "slope", 20.0, "1/s", (1, 100, 1), "how fast it slides to the path", label="Slope"
        ),
        own_gain("reach", 2.0, "m/s²", (0, 20, 0.1), "how hard it pulls", label="Reach"),
    ),
    good="A constant force of less than its reach does not move it off the curve.",
    limits="Its torque trembles by as much as it can pull.",
)
