"""Contouring: track by the clock, stiff across the path and soft along it."""

from __future__ import annotations

import casadi as ca

from onpath.models.control.laws.law import ControlAction, Law, View, own_gain
from onpath.models.control.laws.references import (
    clock_acceleration,
    clock_ahead,
    clock_rate,
    tracking_error,
)
from onpath.models.control.place import Place
from onpath.models.control.poles import Channel, channel, turning_channel
from onpath.models.control.space_output import normals
from onpath.models.paths.projection import LocalCurve
from onpath.models.systems.parameters import Parameters

RATIO = own_gain(
    "contour_ratio",
    0.1,
    "",
    (0.01, 1, 0.01),
    "contouring: how stiff it is along the path, as a share of across",
    label="Along / across",
)


def contouring(view: View) -> ControlAction:
    """Commanded y'', (p, 1), [m/s²], from the error in the frame (T, N) at the reference point.

    With e = e_t T + e_n N, the frame turning at φ' = (angle of σ')' θ_r', and the ratio κ,

        e_n'' = -K1 e_n - K2 e_n' - K3 ∫e_n dt,   e_t'' = -κ K1 e_t - √κ K2 e_t',
        y'' = y_r'' + (e_t'' - 2 φ' e_n' - φ'' e_n - φ'² e_t) T
                    + (e_n'' + 2 φ' e_t' + φ'' e_t - φ'² e_n) N.

    On a space curve there are two normals, see `_in_space`.

    κ is `contour_ratio`; √κ keeps the damping ratio. The frame is that of the reference point, as
    in the source, so that the law is meant for errors that are small against the radius of
    curvature. With larger ones it pushes sideways: held back on a circle at 2π rad/s, κ = 0.1, the
    five-bar stops after 0.26 s, when its reference point is 1.6 rad ahead.

    Source: Chiu and Tomizuka, reference [1].
    """
    reference, frame, gains = view.reference, view.frame, view.gains
    assert reference is not None
    rate, ratio = clock_rate(view.clock), view.own_gains["contour_ratio"]
    acceleration = clock_acceleration(view.clock)
    error, error_rate, feedforward = tracking_error(
        reference, frame, view.y, view.y_rate, rate, acceleration
    )
    if reference.sigma.numel() == 3:
        return _in_space(view, (rate, acceleration), error, error_rate, feedforward)
    (gap, off), (gap_rate, off_rate) = frame.split(error, rate=True), frame.split(error_rate, True)
    axes, turn, turn_rate = _turning_frame(reference, rate, acceleration)
    e = axes.T @ gap
    swapped = ca.vertcat(e[1], -e[0])
    e_rate = axes.T @ gap_rate + turn * swapped
    integral = axes.T @ frame.split(view.integral, rate=True)[0]
    wanted = ca.vertcat(
        -ratio * gains.k1 * e[0] - ca.sqrt(ratio) * gains.k2 * e_rate[0],
        -gains.k1 * e[1] - gains.k2 * e_rate[1] - gains.k3 * integral[1],
    )
    swapped_rate = ca.vertcat(e_rate[1], -e_rate[0])
    planar = axes @ (wanted - 2 * turn * swapped_rate - turn_rate * swapped - turn**2 * e)
    residual = -gains.k1 * off - gains.k2 * off_rate
    across = frame.join(axes[:, 1] * e[1], off, rate=True)
    return ControlAction(feedforward + frame.join(planar, residual, rate=True), error=across)


def _turning_frame(
    reference: LocalCurve, rate: ca.SX, acceleration: ca.SX
) -> tuple[ca.SX, ca.SX, ca.SX]:
    """The axes (T, N), (2, 2), and rate [rad/s] and acceleration [rad/s²] of their angle φ.

    With φ the angle of σ', dφ/dθ = (σ' x σ'') / |σ'|² and

        d²φ/dθ² = (σ' x σ''') / |σ'|² - 2 (σ' x σ'') (σ' · σ'') / |σ'|⁴.

    Args:
        reference: the curve about θ_r.
        rate, acceleration: θ_r' and θ_r'', [rad/s], [rad/s²].
    """
    first, second, third = reference.first, reference.second, reference.third
    length2 = ca.dot(first, first)
    tangent = first / ca.sqrt(length2)
    per_theta = _cross(first, second) / length2
    second_per_theta = (_cross(first, third) - 2 * per_theta * ca.dot(first, second)) / length2
    axes = ca.horzcat(tangent, ca.vertcat(-tangent[1], tangent[0]))
    return axes, per_theta * rate, second_per_theta * rate**2 + per_theta * acceleration


def _in_space(
    view: View, rates: tuple[ca.SX, ca.SX], error: ca.SX, error_rate: ca.SX, feedforward: ca.SX
) -> ControlAction:
    """The law on a space curve, with the axes A = (T, n1, n2) of `normals` at the reference point.

    A' = A Ω with the skew matrix Ω of the frame's angular velocity. With ε = A^T e,

        y'' = y_r'' + A (ε'' + 2 Ω ε' + Ω' ε + Ω² ε),   ε' = A^T e' - Ω ε,

    where the first component of ε'' is along the path, and the other two are across it.

    Args:
        rates: θ_r' [rad/s] and θ_r'' [rad/s²].
    """
    assert view.reference is not None
    gains, ratio = view.gains, view.own_gains["contour_ratio"]
    rate, acceleration = rates
    axes, turn, turn_rate = _turning_axes(view.reference, rate, acceleration)
    e = axes.T @ error
    e_rate = axes.T @ error_rate - turn @ e
    stiffness = gains.k1 * ca.vertcat(ratio, 1, 1)
    damping = gains.k2 * ca.vertcat(ca.sqrt(ratio), 1, 1)
    lasting = gains.k3 * ca.vertcat(0, (axes.T @ view.integral)[1:])
    wanted = -stiffness * e - damping * e_rate - lasting
    moving = 2 * (turn @ e_rate) + turn_rate @ e + turn @ (turn @ e)
    return ControlAction(feedforward + axes @ (wanted + moving), error=axes[:, 1:] @ e[1:])


def _turning_axes(
    reference: LocalCurve, rate: ca.SX, acceleration: ca.SX
) -> tuple[ca.SX, ca.SX, ca.SX]:
    """The axes A of a space curve, Ω [rad/s] and Ω' [rad/s²], each (3, 3)."""
    step, here = ca.SX.sym("step"), normals(reference)
    bend, rise = normals(reference.moved(step)).bends
    slopes = [ca.substitute(ca.jacobian(each, step), step, ca.SX(0)) for each in (bend, rise)]
    per_theta = _skew(here.bends[0], here.bends[1], here.twist)
    second = _skew(slopes[0], slopes[1], here.twist_rate)
    axes = ca.horzcat(here.tangent, here.left, here.up)
    return axes, per_theta * rate, second * rate**2 + per_theta * acceleration


def _skew(bend: ca.SX, rise: ca.SX, twist: ca.SX) -> ca.SX:
    """Ω of T' = bend n1 + rise n2, n1' = -bend T + twist n2, n2' = -rise T - twist n1."""
    return ca.blockcat([[0, -bend, -rise], [bend, 0, -twist], [rise, twist, 0]])


def contouring_channels(parameters: Parameters, place: Place) -> tuple[Channel, Channel]:
    """The channels of the error in the frame (T, N) at the reference point.

    Along: κ K1 and √κ K2. Across: K1 and K2 on every path, and with the integral also K3. The
    integral is kept in axes that do not turn, so that its poles depend on the turning of the path.
    """
    ratio, k1, k2 = RATIO.of(parameters), parameters.K1, parameters.K2
    along = channel("along", parameters, (ratio * k1, ratio**0.5 * k2, 0.0), "xva")
    if parameters.K3 == 0 or parameters.tracker_integral == "off":
        return channel("across", parameters, (k1, k2, 0.0), "xva"), along
    rate = place.speed
    at = float("nan") if place.turns_evenly or rate == 0 else place.theta
    gains = k1, k2, parameters.K3
    if not (place.turn * rate).any():
        return channel("across", parameters, gains, "xvia"), along
    return turning_channel("across", parameters, gains, place.turn * rate, at), along


def _cross(a: ca.SX, b: ca.SX) -> ca.SX:
    return a[0] * b[1] - a[1] * b[0]


LAW = Law(
    name="contouring",
    label="Contouring",
    text="Tracks by the clock, but stiffly across the curve and softly along it.",
    source="Chiu and Tomizuka, a task coordinate frame approach, reference [1]",
    command=contouring,
    reference=clock_ahead,
    by_clock=True,
    small_errors=True,
    channels=contouring_channels,
    own_gains=(RATIO,),
    good="It is on time and yields along the curve while it is stiff across it, as long as its"
    " error is small.",
    limits="Its axes are those of its reference point, meant for errors that are small against the"
    " radius of curvature: held back, it is off its curve at once, and a hold that other laws"
    " stand may stop it in a quarter of a second.",
    objection="Its authors would keep its error small, by a slower clock or a stiffer machine, and"
    " choose the ratio for the machine.",
)
