"""Time-optimal path following: the fastest speed as a function of the place, without a clock."""

from __future__ import annotations

from dataclasses import replace

from onpath.models.control.laws.law import ControlAction, Law, View
from onpath.models.control.laws.path_following import path_following
from onpath.models.control.laws.planned_speed import planned, speed_plan


def time_optimal_following(view: View) -> ControlAction:
    """Commanded y'' of path following, (p, 1), [m/s²], with the fastest speed at the robot's place.

        v_perp as in (18),   v_par = ω'(θ) θ' - K5 (θ' - ω(θ)),

    where ω(θ) is the fastest speed for which the torques, with viscous friction and gravity, are at
    most 90 % of their limit (models/control/fastest_speed.py), and ω' = dω/dθ. So δ = θ' - ω(θ)
    obeys δ' = -K5 δ. A robot that is held asks for no acceleration but that of K5, and wherever
    it is let go it goes on at the speed that is planned there.

    The position task is that of path following. Without a torque limit, ω is the wanted speed.

    Source: eqs. (16)-(19) with the plan of `time_optimal_tracking`.
    """
    theta, rate, clock = view.output.theta, view.output.theta_rate, view.clock
    task = planned(clock.plan, theta, view.task, clock.closed, rate)
    return path_following(replace(view, task=task))


LAW = Law(
    name="time_optimal_following",
    label="Time-optimal following",
    text="Path following at the speed, place by place, that is as fast as the torque limits allow.",
    source="Hladio, Nielsen and Wang, eqs. (16)-(19); plan as in Verscheure et al.",
    command=time_optimal_following,
    aim="theta",
    gains=("K1", "K2", "K3", "K4", "K5"),
    plan=speed_plan,
    square=True,
    linear=True,
    good="It goes as fast as the torque limits allow, and held back and let go it stays near the"
    " curve.",
    limits="It is as good as its model: with a payload that it does not know, its torques reach"
    " their limits.",
    objection="A speed that depends on the place alone cannot make use of torque that a disturbance"
    " leaves.",
)
