"""Orbital stabilization: to and fro along the path, so that a pendulum without a motor swings."""

from __future__ import annotations

from dataclasses import replace

import casadi as ca

from onpath.models.arrays import Array
from onpath.models.control.laws.law import Clock, ControlAction, Law, View, own_gain
from onpath.models.control.laws.path_following import followed, tangential, transversal
from onpath.models.control.pendulum_orbit import LENGTHS, ORDER, Pendulum, orbit_plan
from onpath.models.paths.curves import Curve
from onpath.models.systems.parameters import Parameters
from onpath.models.systems.robots import Robot
from onpath.models.systems.system import GRAVITY

SWING = own_gain(
    "orbit_swing",
    0.1,
    "rad",
    (0.02, 0.3, 0.01),
    "amplitude of the pendulum on the orbit",
    label="Swing",
)
LEVEL, STEEP = 0.7, 0.4  # |dx/ds| of the path: the orbit alone above, the position task below
NARROW, WIDE = 0.85, 0.75  # cos φ, likewise


def plan(robot: Robot, parameters: Parameters, _curve: Curve) -> Array:
    """The gains along the orbit; see `orbit_plan`."""
    names, model = robot.system.parameter_names, robot.model(parameters)
    moment, inertia, friction = (
        float(model[names.index(name)]) for name in ("moment", "inertia", "pivot")
    )
    return orbit_plan(Pendulum(moment, inertia, friction), SWING.of(parameters))


def middle(clock: Clock) -> ca.SX:
    """The place about which the orbit is, θ_ref, [rad]."""
    return clock.task.target


def orbital_stabilization(view: View) -> ControlAction:
    """Commanded y'', (p, 1), [m/s²]: the pen stays on the path and goes to and fro about a place.

    The pendulum's equation has no motor: S cos φ x'' + J φ'' + g S sin φ + p φ' = 0. The cart is
    bound to the pendulum by the virtual constraint x = x_m + X(φ), X = a sin φ, with an error e:

        x'' = X' φ'' + X'' φ'² + e'',
        α φ'' + ½ α' φ'² + g S sin φ + p φ' + S cos φ e'' = 0,   α(φ) = J + S a cos² φ.

    Without friction and with e = 0 it conserves E = ½ α φ'² + g S (1 - cos φ): every level of E is
    a periodic orbit, with an upright pendulum (S < 0), too, because α < 0 then. One of them, E* of
    the amplitude `orbit_swing`, is made attractive, by

        e'' = -k(ψ) · (E - E*, e - e_r, e' - e_r') - p φ' / (S cos φ),   ψ = atan2(-φ' / ω0, φ),

    with the gains k of the periodic Riccati equation along the orbit (`orbit_plan` in
    models/control/pendulum_orbit.py), where e_r(ψ) is what the last term does to e. x'' is attained
    by v_par, eq. (16), and (18) holds across the path. x_m is the x of the path at `target`. Where
    the path is too steep to move x along it, |dx/ds| < 0.4, or the pendulum has fallen, cos φ <
    0.75, the position task (19) leads to that place. Above |dx/ds| = 0.7 and cos φ = 0.85 it has no
    part in the motion; in between, the two are blended.

    Cart with a pendulum of 0.1 kg, default settings, circle of 50 mm: period 0.82 s upright and
    1.32 s hanging; multipliers of the linearized motion across the orbit 0, 0, 0.05 and 0, 0, 0.21.
    From rest at the top of the circle E is within 0.1 % of E* after 3 s and 9 s, and stays there.

    Source: Shiriaev, Perram and Canudas-de Wit, Constructive tool for orbital stabilization of
    underactuated nonlinear systems, IEEE Transactions on Automatic Control 50 (2005), 1164-1176,
    reference [8]; the transverse linearization as in Shiriaev, Freidovich and Gusev, IEEE
    Transactions on Automatic Control 55 (2010), 893-906.
    """
    assert view.reference is not None
    model, names = view.model, view.system.parameter_names
    moment, inertia, friction = (model[names.index(n)] for n in ("moment", "inertia", "pivot"))
    phi, rate = view.q[2], view.v[2]
    reach = LENGTHS * inertia / ca.fabs(moment)
    still = inertia + moment * reach
    swing = view.own_gains[SWING.name]
    cosine = ca.fmax(ca.cos(phi), WIDE)
    error = view.y[0] - view.reference.sigma[0] - reach * ca.sin(phi)
    error_rate = view.y_rate[0] - reach * ca.cos(phi) * rate
    alpha = inertia + moment * reach * cosine**2
    energy = alpha * rate**2 / 2 + GRAVITY * moment * (ca.cos(swing) - ca.cos(phi))
    psi = ca.atan2(-rate / ca.sqrt(GRAVITY * moment / still), phi)
    waves = [ca.SX(1), *(ca.cos(k * psi) for k in range(1, ORDER + 1))]
    waves += [ca.sin(k * psi) for k in range(1, ORDER + 1)]
    size = 2 * ORDER + 1
    k1, k2, k3, drift = (
        ca.dot(view.clock.plan[size * i : size * (i + 1)], ca.vertcat(*waves)) for i in range(4)
    )
    drift_rate = -friction / moment * ca.atanh(ca.fmin(ca.fmax(ca.sin(phi), -WIDE), WIDE))
    w = -k1 * energy - k2 * (error - drift) - k3 * (error_rate - drift_rate)
    bent = w - friction * rate / (moment * cosine)  # e''
    second = -reach * ca.sin(phi) * rate**2 + bent
    swung = -(moment * cosine * second + GRAVITY * moment * ca.sin(phi) + friction * rate) / alpha
    wanted = second + reach * cosine * swung
    output = view.output
    direction = output.acceleration_per_along
    level = direction[0] / ca.sqrt(ca.dot(direction, direction))
    held = replace(view, task=replace(view.task, position=ca.SX(1)))
    resting = output.acceleration(ca.SX(0), transversal(view))
    slope = ca.if_else(ca.fabs(level) > STEEP, direction[0], 1)
    along = (wanted - resting[0]) / slope
    share = ca.fmin(
        ca.fmin(ca.fmax((ca.fabs(level) - STEEP) / (LEVEL - STEEP), 0), 1),
        ca.fmin(ca.fmax((ca.cos(phi) - WIDE) / (NARROW - WIDE), 0), 1),
    )
    along = share * along + (1 - share) * tangential(held)
    return replace(
        followed(view, along, transversal(view), wanted=ca.fabs(output.theta_rate)),
        theta_ref=output.theta,
    )


LAW = Law(
    name="orbital_stabilization",
    label="Orbital stabilization",
    text="Moves to and fro along the curve so that a pendulum without a motor keeps swinging.",
    source="Shiriaev, Perram and Canudas-de Wit [8]; Mettin et al. [7]",
    command=orbital_stabilization,
    reference=middle,
    aim="theta",
    gains=("K1", "K2", "K3", "K4", "K5"),
    own_gains=(SWING,),
    plan=plan,
    robots=("cart_pendulum",),
    stabilizes=True,
    pace="energy",
    good="It keeps a pendulum upright that has no motor, on an orbit to which it returns after a"
    " push, and stays on the curve.",
    limits="It never goes round, and an upright pendulum falls where the curve is too short or too"
    " steep for its swing.",
    objection="Its authors treat any robot that lacks one motor, and this law is written for one"
    " cart.",
)
