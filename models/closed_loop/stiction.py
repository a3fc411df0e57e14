"""Motors that stick: dry friction with a static level, by Karnopp's model.

The motors turn at the rates r = B^T v, and their friction λ has the generalized forces B λ; if B
selects coordinates, r are their velocities. A motor at rest stays exactly at rest as long as the
friction torque that holds it does not exceed the static level. Beyond that it slides against the
Coulomb level. It comes to rest where it slows down to less than `BAND`, or its rate changes its
sign during a tick, and the static level suffices to hold it there. Its friction is held constant
over a tick, like all forces.

Source: Karnopp, Computer simulation of stick-slip friction in mechanical dynamic systems, ASME
Journal of Dynamic Systems, Measurement, and Control 107, 1985, for one body. For several motors,
the torques λ that keep those in a set S at rest solve

    (r' + B^T M⁻¹ B λ)_i = 0 for i in S,   λ_i = 0 otherwise,   r' = B^T a + B'^T v.
"""

from __future__ import annotations

from dataclasses import dataclass

import casadi as ca

from onpath.models.layout import Fields
from onpath.models.systems.rigid_chain import solved
from onpath.models.systems.system import MechanicalSystem

BAND = 1e-4  # [rad/s]
AT_REST = 1e-12  # [rad/s]; where B selects no coordinates, r = 0 has a rounding error


@dataclass(frozen=True, slots=True)
class Friction:
    """Friction in the motors during a tick, each (m, 1).

    Attributes:
        torque: [N m].
        rests: 1 for motors that stay at rest.
        stops: 1 for motors that would stay at rest if they came to rest.
    """

    torque: ca.SX
    rests: ca.SX
    stops: ca.SX

    def applied(
        self, system: MechanicalSystem, before: Fields, after: Fields, parameters: ca.SX
    ) -> Fields:
        """(q, v) after the tick, with the motors at rest that stayed there or came to rest."""

        def turned(x: ca.SX) -> ca.SX:
            return system.input_rates(before["q"], x, parameters)

        old, new = turned(before["v"]), system.input_rates(after["q"], after["v"], parameters)
        slow = (ca.fabs(new) < BAND) * (ca.fabs(new) < ca.fabs(old))
        ends = self.stops * ca.fmax(slow, old * new < 0)
        places = ca.if_else(self.rests, turned(before["q"]), turned(after["q"]))
        rates = ca.if_else(ca.fmax(self.rests, ends), 0, new)
        replaced = _replacement(system)
        return {
            "q": replaced(before["q"], parameters, after["q"], places),
            "v": replaced(after["q"], parameters, after["v"], rates),
        }


def friction(
    system: MechanicalSystem,
    moving: Fields,
    tau: ca.SX,
    parameters: ca.SX,
    levels: tuple[ca.SX, ca.SX],
) -> Friction:
    """The friction in the motors, from the forces that act besides it.

    All motors at rest are first assumed to stay there. Those that would need more than the static
    level begin to slide, which changes what the others need; with m motors this is settled after m
    rounds.

    Args:
        moving: q and v, (n, 1).
        tau: all other generalized forces, (n, 1).
        parameters: of the plant, (k, 1).
        levels: static and Coulomb level, [N m]; the larger of the two is the static one.
    """
    m, (high, coulomb) = system.m, levels
    static = ca.fmax(high, coulomb)
    rates = system.input_rates(moving["q"], moving["v"], parameters)
    acceleration, compliance = _response(system)(moving["q"], moving["v"], tau, parameters)
    rests = ca.fabs(rates) < AT_REST
    direction = _sign(rates) * (1 - rests)
    needed = ca.SX.zeros(m, 1)
    for _ in range(m):
        sliding = -coulomb * direction
        needed = _holding(compliance, rests, acceleration + compliance @ sliding)
        breaks = rests * (ca.fabs(needed) > static)
        direction = direction - breaks * _sign(needed)
        rests = rests * (1 - breaks)
    torque = ca.if_else(rests, needed, -coulomb * direction)
    alone = torque - (acceleration + compliance @ torque) / ca.diag(compliance)
    return Friction(torque, rests, ca.fabs(alone) <= static)


def _response(system: MechanicalSystem) -> ca.Function:
    """(q, v, τ, parameters) -> r', (m, 1), and B^T M⁻¹ B, its derivative by λ, (m, m)."""
    q, v, actuation = system.q, system.v, system.actuation
    rates = actuation.T @ system.acceleration + ca.jtimes(actuation.T @ v, q, v)
    compliance = ca.jacobian(rates, system.tau) @ actuation
    inputs = [q, v, system.tau, system.parameters]
    return ca.Function("response", inputs, [rates, ca.densify(compliance)])


def _replacement(system: MechanicalSystem) -> ca.Function:
    """(q, parameters, x, c) -> the x nearest to the given one for which B^T x = c, (n, 1).

    If B selects coordinates, those of x are replaced by c.
    """
    actuation, x, c = system.actuation, ca.SX.sym("x", system.n), ca.SX.sym("c", system.m)
    inverse = ca.solve(ca.densify(actuation.T @ actuation), ca.densify(actuation.T)).T
    others = ca.SX.eye(system.n) - inverse @ actuation.T
    inputs = [system.q, system.parameters, x, c]
    return ca.Function("replaced", inputs, [others @ x + inverse @ c])


def _holding(compliance: ca.SX, rests: ca.SX, acceleration: ca.SX) -> ca.SX:
    """λ of the module's docstring, (m, 1)."""
    chosen = ca.diag(rests)
    matrix = chosen @ compliance @ chosen + ca.diag(1 - rests)
    return -solved(matrix, rests * acceleration)


def _sign(x: ca.SX) -> ca.SX:
    return (x > 0) - (x < 0)
