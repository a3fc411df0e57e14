"""A mass at the tip of a robot on a waist, as a change of its equations of motion."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import casadi as ca

from onpath.models.systems.system import GRAVITY


@dataclass(frozen=True, slots=True)
class TipLoad:
    """A mass at the tip, which acts on the robot like the force -m (y'' + g e_3) there.

    Attributes:
        mass: m, [kg].
        jacobian: J = dy/dq of the tip, in coordinates that the waist has turned, (3, n).
        bias: contribution of m to c, m Jᵀ (J' v + g e_3), (n, 1).
        energy: contribution of m to V, m g y3, [J].
        active: whether there is a load.
    """

    mass: ca.SX
    jacobian: ca.SX
    bias: ca.SX
    energy: ca.SX
    active: bool = True

    @property
    def inertia(self) -> ca.SX:
        """Contribution of m to M, m Jᵀ J, (n, n)."""
        return self.mass * self.jacobian.T @ self.jacobian

    def solve(self, unloaded: Callable[[ca.SX], ca.SX], rhs: ca.SX) -> ca.SX:
        """(M + m Jᵀ J)⁻¹ R = X - Z (I + m J Z)⁻¹ m J X,  X = M⁻¹ R,  Z = M⁻¹ Jᵀ; X for m = 0.

        Args:
            unloaded: R -> M⁻¹ R.

        Source: the identity of Sherman, Morrison and Woodbury.
        """
        if not self.active:
            return unloaded(rhs)
        free, moved = unloaded(rhs), unloaded(self.jacobian.T)
        shares = ca.SX.eye(3) + self.mass * self.jacobian @ moved
        inverse = ca.adj(shares) / ca.det(shares)
        return free - moved @ (inverse @ (self.mass * (self.jacobian @ free)))


def tip_load(mass: ca.SX, q: ca.SX, v: ca.SX, tip: ca.SX, waist: int) -> TipLoad:
    """The load of a mass at the tip, from two derivatives of the tip.

    The waist turns y about a fixed axis. Setting its angle to 0 after differentiation therefore
    gives J and J' v in coordinates that turn with it, with many zeros; J^T J and J^T J' v stay the
    same.

    Args:
        mass: m, [kg].
        q, v: coordinates and velocities, (n, 1).
        tip: y(q), (3, 1), [m].
        waist: index of the waist's angle in q.
    """
    rate = ca.jtimes(tip, q, v)
    jacobian, turning = (
        ca.substitute(each, q[waist], 0) for each in (ca.jacobian(tip, q), ca.jtimes(rate, q, v))
    )
    weight = ca.DM([0, 0, GRAVITY])
    bias = mass * jacobian.T @ (turning + weight)
    return TipLoad(mass, jacobian, bias, mass * GRAVITY * tip[2])


def no_load(n: int) -> TipLoad:
    """No load on a robot with n coordinates; its equations stay the same to the last bit."""
    return TipLoad(ca.SX(0), ca.SX(3, n), ca.SX(n, 1), ca.SX(0), active=False)
