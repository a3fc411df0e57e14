"""Path following (16)-(19): regulate the distance to the path and the speed along it."""

from __future__ import annotations

import casadi as ca
import numpy as np

from onpath.models.control.laws.law import Along, ControlAction, Law, View
from onpath.models.control.laws.references import fading
from onpath.models.paths.projection import wrap

NEAR_SPREAD, FAR_SPREAD = 0.5, 0.2  # of 1 - λκ
NEAR_TURN, FAR_TURN = 0.15, 0.3  # [rad], beyond the wanted turn in the time `View.lag`
STILL = 1e-6  # [m/s]
NEAR_END, FAR_END = 0.005, 0.02  # [m], beyond an end of an open path


def path_following(view: View) -> ControlAction:
    """Commanded y'' of path following, (p, 1), [m/s²].

        v_perp = -K1 λ - K2 λ' - K3 ∫λ dt                     (18)
        v_par  = -K4 (θ - θ_ref) - K5 θ'    (position task)   (19)
        v_par  = ω_ref' - K5 (θ' - ω_ref)   (speed task)      (19) with K4 = 0

    λ = ξ_1 is `output.xi`. θ - θ_ref is taken modulo 2π on a closed curve. |ω_ref| is at most
    `task.limit`; on an open curve it is reduced near the ends, without a feedforward.
    `VirtualOutput.acceleration` turns (v_par, v_perp) into y''.

    This is the paper's law within two bounds: the integral of every law is limited,
    |K3 ∫λ dt| <= K1 ρ with ρ = 10 mm or half the radius of the bend (`bounded` in
    models/closed_loop/controller_tick.py), and far from the path the command becomes a straight
    return (`far_from_path`).

    Source: eqs. (16), (18), (19).
    """
    along = tangential(view)
    return followed(view, along, transversal(view), direction=view.output.acceleration_per_along)


def followed(
    view: View,
    along: ca.SX,
    across: ca.SX,
    direction: ca.SX | None = None,
    wanted: ca.SX | None = None,
) -> ControlAction:
    """The command for θ'' = v_par and λ'' = v_perp near the path, and for a return from far away.

    Args:
        along: v_par, (1, 1), [rad/s²].
        across: v_perp, (p - 1, 1), [m/s²].
        direction: dy''/dv_par, (p, 1), if a torque limit may reduce v_par.
        wanted: how fast θ is to turn, [rad/s]; None: as the task says.

    Source: eq. (16) near the path.
    """
    output = view.output
    far = far_from_path(view, wanted_turn(view) if wanted is None else wanted)
    near = output.acceleration(along, across)
    home = -view.gains.k1 * (output.gap + beyond_end(view)) - view.gains.k2 * view.y_rate
    return ControlAction(
        acceleration=(1 - far) * near + far * home,
        error=ca.vertcat(output.xi, 0),
        error_per_metre=output.xi_per_metre,
        far=far,
        along=None if direction is None else Along(along, (1 - far) * direction),
    )


def far_from_path(view: View, wanted: ca.SX) -> ca.SX:
    """The share s of the return to the path in the command, from 0 to 1.

        y'' = (1 - s) y''_(16) + s (-K1 (y - σ) - K2 y')

    (16) divides by 1 - λκ, which is 0 at the centre of curvature, where the closest point is not
    unique; a hand that lets go may throw the arm there. And (16) cancels θ'² as it was up to a time
    `lag` ago, during which neither θ nor the tangent may turn far: by (|θ'| - wanted) lag, times
    κ |σ'| where that exceeds 1, as in bends. So s goes smoothly from 0 to 1 while

        1 - λκ                     falls from 0.5 to 0.2, or
        the turn beyond the wanted rises from 0.15 to 0.3 rad, or
        the way past an open end   rises from 5 to 20 mm, where σ is the end.

    With a level set it also does so where ∇s·N falls to such a share of its value on the path: at
    the centre of an ellipse it is 0, although 1 - λκ need not be; see `VirtualOutput.spread`.

    Elsewhere s is exactly 0. Where it is 1, ½ K1 |y - σ|² + ½ |y'|² never rises in continuous time
    without an external force, whichever of several closest points is taken: |y - σ|² is the least
    of the squared distances, and the pull is the same towards each of them.

    Args:
        wanted: how fast θ is to turn, [rad/s].
    """
    output = view.output
    if view.drawing:
        turn = (_turning(view) - wanted * view.closest.turning) * view.lag
    else:
        turn = (ca.fabs(output.theta_rate) - wanted) * view.lag * ca.fmax(view.closest.turning, 1)
    inside = _risen((NEAR_SPREAD - output.spread) / (NEAR_SPREAD - FAR_SPREAD))
    fast = _risen((turn - NEAR_TURN) / (FAR_TURN - NEAR_TURN))
    share = ca.fmax(inside, fast)
    if view.clock.closed:
        return share
    past = beyond_end(view)
    past = (ca.sqrt(ca.dot(past, past)) - NEAR_END) / (FAR_END - NEAR_END)
    return ca.fmax(share, _risen(past))


def _turning(view: View) -> ca.SX:
    """|y''| / |y'| while the speed along the path and λ' stay as they are, [1/s].

    On the path it is the rate at which the tangent turns. Beside it (16) also has to cancel the
    change of 1 - λκ, which is fast where a bend begins.
    """
    output, closest = view.output, view.closest
    speed2 = output.per_radian**2
    steady = -(output.theta_rate**2) * ca.dot(closest.first, closest.second) / speed2
    kept = output.acceleration(steady, ca.SX.zeros(view.frame.p - 1, 1))
    moved2 = ca.fmax(ca.dot(view.y_rate, view.y_rate), STILL**2)
    return ca.sqrt(ca.dot(kept, kept) / moved2)


def wanted_turn(view: View) -> ca.SX:
    """The rate of θ that the task allows, [rad/s].

    It is |ω_ref| in the speed task, and √K4 |θ - θ_ref| in the position task, which (19) does not
    exceed from rest.
    """
    task, theta = view.task, view.output.theta
    left = ca.fabs(wrap(theta - task.target, view.clock.closed))
    return ca.if_else(task.position, ca.sqrt(view.gains.k4) * left, ca.fabs(task.speed))


def beyond_end(view: View) -> ca.SX:
    """The vector from an end of an open path to the closest point on its tangent, (p, 1), [m].

    It is 0 on the path, and on a closed one.
    """
    closest, frame = view.closest, view.frame
    if view.clock.closed:
        return ca.SX.zeros(frame.p, 1)
    past = closest.theta - ca.fmin(ca.fmax(closest.theta, -np.pi), np.pi)
    none = ca.SX.zeros(frame.p - closest.first.numel(), 1)
    return frame.join(past * closest.first, none, rate=True)


def _risen(x: ca.SX) -> ca.SX:
    """A smooth step from 0 at x <= 0 to 1 at x >= 1: 3 x² - 2 x³."""
    x = ca.fmin(ca.fmax(x, 0), 1)
    return x * x * (3 - 2 * x)


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
    " haste; with K5 = 0 it is a guiding virtual fixture: a hand alone moves the robot along.",
    limits="Time that is lost stays lost: let go, it is late by as long as it was held.",
    objection="Its authors bound neither the integral nor the distance from which (16)"
    " leads back, as is done here.",
)
