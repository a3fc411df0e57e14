"""Forces that no controller knows of: a hand that pulls, a brake that holds back, dry friction."""

from __future__ import annotations

from dataclasses import dataclass

import casadi as ca

TINY = 1e-12
DRY_VELOCITY = 0.05  # [rad/s], width of the smooth sign in Coulomb friction


@dataclass(frozen=True, slots=True)
class SpringLimits:
    """Stiffness [N/m], damping [N s/m], largest force [N]."""

    stiffness: float
    damping: float
    largest: float


HAND = SpringLimits(stiffness=300.0, damping=10.0, largest=15.0)
HOLD = SpringLimits(stiffness=2000.0, damping=40.0, largest=30.0)


def hand(y: ca.SX, y_rate: ca.SX, target: ca.SX, active: ca.SX) -> ca.SX:
    """Spring-damper from the end-point to where the hand is, saturated, (p, 1), [N]."""
    force = HAND.stiffness * (target - y) - HAND.damping * y_rate
    size = ca.sqrt(ca.dot(force, force) + TINY)
    return (active * ca.fmin(1, HAND.largest / size)) * force


def hold(y: ca.SX, y_rate: ca.SX, anchor: ca.SX, tangent: ca.SX, active: ca.SX) -> ca.SX:
    """Stiff brake along the tangent at the anchor, nothing across it, (p, 1), [N].

    Source: the obstruction of experiment 2.
    """
    along = HOLD.stiffness * ca.dot(tangent, y - anchor) + HOLD.damping * ca.dot(tangent, y_rate)
    return (active * ca.fmin(ca.fmax(-along, -HOLD.largest), HOLD.largest)) * tangent


def dry_friction(v: ca.SX, coulomb: ca.SX) -> ca.SX:
    """Coulomb friction of the joints with a smooth sign, (m, 1), [N m].

    Args:
        v: joint velocities, (m, 1), [rad/s].
        coulomb: friction torque, [N m].
    """
    return -coulomb * v / ca.sqrt(v**2 + DRY_VELOCITY**2)
