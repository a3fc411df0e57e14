"""Path following (16)-(19): regulate the distance to the path and the speed along it."""

from __future__ import annotations

import casadi as ca

from onpath.models.control.laws.law import Along, ControlAction, Law, View
from onpath.models.control.laws.references import fading
from onpath.models.paths.projection import wrap


def path_following(view: View) -> ControlAction:
    """Commanded y'' of path following, (p, 1), [m/s²].

        v_perp = -K1 λ - K2 λ' - K3 ∫λ dt                     (18)
        v_par  = -K4 (θ - θ_ref) - K5 θ'    (position task)   (19)
        v_par  = ω_ref' - K5 (θ' - ω_ref)   (speed task)      (19) with K4 = 0

    λ = ξ_1 is `output.xi`. θ - θ_ref is taken modulo 2π on a closed curve. |ω_ref| is at most
    `task.limit`; on an open curve it is reduced near the ends, without a feedforward.
    `VirtualOutput.acceleration` turns (v_par, v_perp) into y''.

    Source: eqs. (16), (18), (19).
    """
    output = view.output
    along = tangential(view)
    return ControlAction(
        acceleration=output.acceleration(along, transversal(view)),
        error=ca.vertcat(output.xi, 0),
        along=Along(along, output.acceleration_per_along),
    )


def transversal(view: View) -> ca.SX:
    """v_perp = -K1 λ - K2 λ' - K3 ∫λ dt, (p - 1, 1), [m/s²].

    Source: eq. (18).
    """
    gains, output = view.gains, view.output
    integral = view.integral[: view.frame.p - 1]
    return -gains.k1 * output.xi - gains.k2 * output.xi_rate - gains.k3 * integral


def tangential(view: View) -> ca.SX:
    """v_par, (1, 1), [rad/s²].

    Source: eq. (19).
    """
    gains, output, task, closed = view.gains, view.output, view.task, view.clock.closed
    holding = -gains.k4 * wrap(output.theta - task.target, closed) - gains.k5 * output.theta_rate
    speed = ca.fmin(ca.fmax(task.speed, -task.limit), task.limit)
    reference = speed if closed else fading(output.theta, speed, gains.k5)
    feedforward = task.acceleration * (reference == task.speed)
    moving = feedforward - gains.k5 * (output.theta_rate - reference)
    return ca.if_else(task.position, holding, moving)


LAW = Law(
    name="path_following",
    label="Path following",
    text="Stays on the curve and regulates the speed along it; it has no clock.",
    source="Hladio, Nielsen and Wang, eqs. (16)-(19)",
    command=path_following,
    aim="theta",
    gains=("K1", "K2", "K3", "K4", "K5"),
    linear=True,
    good="Held back and let go, it stays on the curve and goes on at the wanted speed without"
    " haste.",
    limits="Time that is lost stays lost: after the brake it is late by as long as it was held.",
)
