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


@dataclass(frozen=True, slots=True)
class Grip:
    """How a hand and a brake take hold of a robot's end-point."""

    hand: SpringLimits = SpringLimits(stiffness=300.0, damping=10.0, largest=15.0)
    hold: SpringLimits = SpringLimits(stiffness=2000.0, damping=40.0, largest=30.0)


def hand(y: ca.SX, y_rate: ca.SX, target: ca.SX, active: ca.SX, limits: SpringLimits) -> ca.SX:
    """Spring-damper from the end-point to where the hand is, saturated, (p, 1), [N]."""
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
    """Stiff brake along the tangent at the anchor, nothing across it, (p, 1), [N].

    Source: the obstruction of experiment 2.
    """
    ahead, rate = ca.dot(tangent, y - anchor), ca.dot(tangent, y_rate)
    along = limits.stiffness * ahead + limits.damping * rate
    return (active * ca.fmin(ca.fmax(-along, -limits.largest), limits.largest)) * tangent


def dry_friction(v: ca.SX, coulomb: ca.SX) -> ca.SX:
    """Coulomb friction of the joints with a smooth sign, (m, 1), [N m].

    Args:
        v: joint velocities, (m, 1), [rad/s].
        coulomb: friction torque, [N m].
    """
    return -coulomb * v / ca.sqrt(v**2 + DRY_VELOCITY**2)
