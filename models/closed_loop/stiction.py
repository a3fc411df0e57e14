"""Joints that stick: dry friction with a static level, by Karnopp's model.

A joint at rest stays exactly at rest as long as the friction torque that holds it does not exceed
the static level. Beyond that it slides against the Coulomb level. It comes to rest where it slows
down to less than `BAND`, or its velocity changes its sign during a tick, and the static level
suffices to hold it there.

The joints are the first m coordinates. Their friction is held constant over a tick, like all
forces.

Source: Karnopp, Computer simulation of stick-slip friction in mechanical dynamic systems, ASME
Journal of Dynamic Systems, Measurement, and Control 107, 1985, for one body. For several joints,
the torques λ that keep those in a set S at rest solve

    (a + M⁻¹ λ)_i = 0 for i in S,   λ_i = 0 otherwise.
"""

from __future__ import annotations

from dataclasses import dataclass

import casadi as ca

from onpath.models.layout import Fields
from onpath.models.systems.system import MechanicalSystem

BAND = 1e-4  # [rad/s]


@dataclass(frozen=True, slots=True)
class Friction:
    """Friction in the joints during a tick, each (m, 1).

    Attributes:
        torque: [N m].
        rests: 1 for joints that stay at rest.
        stops: 1 for joints that would stay at rest if they came to rest.
    """

    torque: ca.SX
    rests: ca.SX
    stops: ca.SX

    def applied(self, before: Fields, after: Fields) -> Fields:
        """(q, v) after the tick, with the joints at rest that stayed there or came to rest."""
        m = self.rests.numel()
        old, new = before["v"][:m], after["v"][:m]
        slow = (ca.fabs(new) < BAND) * (ca.fabs(new) < ca.fabs(old))
        ends = self.stops * ca.fmax(slow, old * new < 0)
        q = ca.if_else(self.rests, before["q"][:m], after["q"][:m])
        v = ca.if_else(ca.fmax(self.rests, ends), 0, new)
        return {"q": ca.vertcat(q, after["q"][m:]), "v": ca.vertcat(v, after["v"][m:])}


def friction(
    system: MechanicalSystem,
    moving: Fields,
    tau: ca.SX,
    parameters: ca.SX,
    levels: tuple[ca.SX, ca.SX],
) -> Friction:
    """The friction in the joints, from the forces that act besides it.

    All joints at rest are first assumed to stay there. Those that would need more than the static
    level begin to slide, which changes what the others need; with m joints this is settled after m
    rounds.

    Args:
        moving: q and v, (n, 1).
        tau: all other generalized forces, (n, 1).
        parameters: of the plant, (k, 1).
        levels: static and Coulomb level, [N m]; the larger of the two is the static one.
    """
    m, (high, coulomb) = system.m, levels
    static, v = ca.fmax(high, coulomb), moving["v"][:m]
    acceleration, compliance = _response(system)(moving["q"], moving["v"], tau, parameters)
    rests, direction = v == 0, _sign(v)
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
    """(q, v, τ, parameters) -> accelerations of the joints (m, 1), and ∂/∂τ of them (m, m)."""
    m = system.m
    joints = system.acceleration[:m]
    inputs = [system.q, system.v, system.tau, system.parameters]
    return ca.Function("response", inputs, [joints, ca.jacobian(joints, system.tau)[:, :m]])


def _holding(compliance: ca.SX, rests: ca.SX, acceleration: ca.SX) -> ca.SX:
    """λ of the module's docstring, (m, 1)."""
    chosen = ca.diag(rests)
    matrix = chosen @ compliance @ chosen + ca.diag(1 - rests)
    return -(1 / ca.det(matrix)) * (ca.adj(matrix) @ (rests * acceleration))


def _sign(x: ca.SX) -> ca.SX:
    return (x > 0) - (x < 0)
