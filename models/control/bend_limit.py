"""The speed along a drawing that its bends allow, whatever speed, gains and rate the user sets."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import casadi as ca

from onpath.models.paths.curves import Curve
from onpath.models.paths.spline_curves import SplineCurve
from onpath.models.systems.parameters import Parameters

TURN = 0.15  # [rad], largest turn of the tangent in a control interval
PER_PIECE = 8  # places at which the turning is taken


def speed_on(parameters: Parameters, curve: Curve) -> float:
    """The wanted speed of θ, [rad/s].

    That of a drawing is for its usual duration, and at most what its bends allow.
    """
    if not isinstance(curve, SplineCurve):
        return parameters.speed
    wanted, limit = parameters.speed / curve.duration, bend_limit(parameters, curve)
    return min(max(wanted, -limit), limit)


def bend_limit(parameters: Parameters, curve: SplineCurve) -> float:
    """The largest speed of θ at which a robot keeps to the bends of a drawing, [rad/s].

    In its tightest bend, with the turning κ |σ'| of the tangent per radian of θ,

        κ |σ'| ω <= min(0.15 / T, 2 sqrt(K1)):

    beyond the first bound the tangent turns too far in a control interval T, beyond the second one
    an arm that is held back slides round the bend. Both were found by runs on random paths. θ is
    the time of a profile that slows for bends, so one limit serves for all of a drawing.
    """
    allowed = allowed_turning(parameters.K1, 1 / parameters.control_rate)
    return float(allowed) / most_turning(curve)


def allowed_turning(k1: Any, interval: Any) -> Any:
    """The largest rate at which the tangent may turn, see `bend_limit`, [rad/s].

    Args:
        k1: K1, a number or a symbol.
        interval: T, [s].
    """
    return ca.if_else(k1 > 0, ca.fmin(TURN / interval, 2 * ca.sqrt(k1)), TURN / interval)


@lru_cache(maxsize=64)
def most_turning(curve: SplineCurve) -> float:
    """The largest κ |σ'| of a curve, by which its tangent turns per radian of θ."""
    theta = curve.sample(PER_PIECE * curve.pieces)
    return max(float(curve.turning(theta).max()), 1e-9)
