"""Forces unknown to the control laws: a hand, a brake, a wall, and dry friction."""

from __future__ import annotations

from dataclasses import dataclass

import casadi as ca

TINY = 1e-12  # [N²], keeps the square root differentiable at 0
MOST_DAMPING = 500.0  # [1/s], of the least effective mass: forces are held over a tick of 1 ms
DRY_VELOCITY = 0.05  # [rad/s], width of the smooth sign in Coulomb friction


@dataclass(frozen=True, slots=True)
class SpringLimits:
    """A spring with a damper and a limited force.

    Attributes:
        stiffness: [N/m].
        damping: [N s/m].
        largest: largest force, [N].
    """

    stiffness: float
    damping: float
    largest: float

    def stronger(self, factor: float, least: float) -> SpringLimits:
        """The spring times a factor, with no more damping than a light direction can bear.

        Args:
            factor: at least 1.
            least: the least effective mass of the end-point, over all directions, [kg].
        """
        damping = min(factor * self.damping, max(self.damping, MOST_DAMPING * least))
        return SpringLimits(factor * self.stiffness, damping, factor * self.largest)


@dataclass(frozen=True, slots=True)
class Grip:
    """The springs by which a hand, a brake and a wall act on a robot's end-point."""

    hand: SpringLimits = SpringLimits(stiffness=300.0, damping=10.0, largest=15.0)
    hold: SpringLimits = SpringLimits(stiffness=2000.0, damping=40.0, largest=30.0)
    wall: SpringLimits = SpringLimits(stiffness=2000.0, damping=40.0, largest=30.0)

    def stronger(self, factor: float, least: float) -> Grip:
        """All springs times a factor; see `SpringLimits.stronger`."""
        hand, hold, wall = (
            spring.stronger(factor, least) for spring in (self.hand, self.hold, self.wall)
        )
        return Grip(hand=hand, hold=hold, wall=wall)


def hand(y: ca.SX, y_rate: ca.SX, target: ca.SX, active: ca.SX, limits: SpringLimits) -> ca.SX:
    """F = k (target - y) - d y', scaled down to at most `limits.largest`, (p, 1), [N].

    Args:
        y, y_rate: end-point and its rate, (p, 1), [m], [m/s].
        target: position of the hand, (p, 1), [m].
        active: 1, or 0 for no force.
        limits: k, d and the largest force.
    """
    force = limits.stiffness * (target - y) - limits.damping * y_rate
    size = ca.sqrt(ca.dot(force, force) + TINY)
    return (active * ca.fmin(1, limits.largest / size)) * force


def hold(
    y: ca.SX,
    y_rate: ca.SX,
    anchor: ca.SX,
    tangent: ca.SX,
    active: ca.SX,
    limits: SpringLimits,
) -> ca.SX:
    """A brake along the tangent, F = -clip(k t · (y - anchor) + d t · y', ±largest) t, (p, 1), [N].

    Across the tangent the end-point is free.

    Args:
        y, y_rate: end-point and its rate, (p, 1), [m], [m/s].
        anchor: the point at which it is held, (p, 1), [m].
        tangent: t, of unit length, (p, 1).
        active: 1, or 0 for no force.
        limits: k, d and the largest force.

    Source: the obstruction of experiment 2.
    """
    ahead, rate = ca.dot(tangent, y - anchor), ca.dot(tangent, y_rate)
    along = limits.stiffness * ahead + limits.damping * rate
    return (active * ca.fmin(ca.fmax(-along, -limits.largest), limits.largest)) * tangent


def wall(
    y: ca.SX,
    y_rate: ca.SX,
    place: ca.SX,
    normal: ca.SX,
    active: ca.SX,
    limits: SpringLimits,
) -> ca.SX:
    """A half-space that pushes and never pulls, (p, 1), [N].

        F = clip(k δ + d δ', 0, largest) n  while δ > 0, else 0;   δ = n · (place - y)

    Along the wall the end-point is free.

    Args:
        y, y_rate: end-point and its rate, (p, 1), [m], [m/s].
        place: a point of the wall's surface, (p, 1), [m].
        normal: n, of unit length, from the wall to the free side, (p, 1).
        active: 1, or 0 for no wall.
        limits: k, d and the largest force.
    """
    depth, rate = ca.dot(normal, place - y), -ca.dot(normal, y_rate)
    pressed = limits.stiffness * depth + limits.damping * rate
    inside = active * (depth > 0) * (pressed > 0)  # fmax(pressed, 0) leaves the sign of 0 open
    return (inside * ca.fmin(pressed, limits.largest)) * normal


def dry_friction(v: ca.SX, coulomb: ca.SX, compliance: ca.SX, dt: ca.SX) -> ca.SX:
    """τ_i = -c v_i / max(sqrt(v_i² + ε²), c a_i): Coulomb friction, smooth at 0, (m, 1), [N m].

    It is held over a tick, during which it must not reverse a joint. With A the accelerations by
    unit torques, a_i = dt Σ_j |A_ij|: no eigenvalue of dt A diag(τ_i / v_i) exceeds 1 in absolute
    value.

    Args:
        v: joint velocities, (m, 1), [rad/s].
        coulomb: friction torque c, [N m].
        compliance: A, (m, m), [1/(kg m²)].
        dt: length of a tick, [s].
    """
    least = coulomb * dt * (ca.fabs(compliance) @ ca.SX.ones(v.numel()))
    return -coulomb * v / ca.fmax(ca.sqrt(v**2 + DRY_VELOCITY**2), least)
