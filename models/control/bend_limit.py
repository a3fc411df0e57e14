"""The speed along a drawing that its bends allow, whatever speed, gains and rate the user sets."""

from __future__ import annotations

from functools import lru_cache
from math import sqrt

import numpy as np

from onpath.models.paths.spline_curves import SplineCurve
from onpath.models.systems.parameters import Parameters

TURN = 0.15  # [rad], largest turn of the tangent in a control interval
PER_PIECE = 8  # places at which the turning is taken


def bend_limit(parameters: Parameters, curve: SplineCurve) -> float:
    """The largest speed of θ at which a robot keeps to the bends of a drawing, [rad/s].

    In its tightest bend, with the turning κ |σ'| of the tangent per radian of θ,

        κ |σ'| ω <= min(0.15 / T, 2 sqrt(K1)):

    beyond the first bound the tangent turns too far in a control interval T, beyond the second one
    an arm that is held back slides round the bend. Both were found by runs on random paths. θ is
    the time of a profile that slows for bends, so one limit serves for all of a drawing.
    """
    allowed = TURN * parameters.control_rate
    if parameters.K1 > 0:
        allowed = min(allowed, 2 * sqrt(parameters.K1))
    return allowed / most_turning(curve)


@lru_cache(maxsize=64)
def most_turning(curve: SplineCurve) -> float:
    """The largest κ |σ'| of a curve, by which its tangent turns per radian of θ."""
    theta = curve.sample(PER_PIECE * curve.pieces)
    speed = np.linalg.norm(curve.at(theta, 1), axis=-1)
    return max(float((np.abs(curve.curvature(theta)) * speed).max()), 1e-9)
