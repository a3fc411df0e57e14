"""Orientations of a linkage's bars and bearings, as CasADi expressions."""

from __future__ import annotations

import math

import casadi as ca

MARKER_DEPTHS = (-0.008, -0.0095)
"""y of a marker's two discs [m]: in front of the path and its control points."""


def waist_angle(bars: ca.SX, away: tuple[float, float] = (0.0, 1.0)) -> ca.SX:
    """Angle of the linkage's vertical plane about the vertical axis, [rad].

    Args:
        bars: beginnings and ends of link 1, link 2 and others as columns, shape (3, 2 n), [m].
        away: horizontal direction towards which the plane's normal (-sin, cos) must point.
    """
    single, is_upright = bars.shape[1] < 4, bars[1, :].is_zero() and away[0] == 0
    if single or is_upright:  # the normal is known
        return ca.SX(math.atan2(-away[0], away[1]))
    a, b = bars[:, 1] - bars[:, 0], bars[:, 3] - bars[:, 2]
    x, y = b[1] * a[2] - b[2] * a[1], b[2] * a[0] - b[0] * a[2]  # normal of the plane
    stretched = ca.hypot(x, y) < 1e-9
    x, y = ca.if_else(stretched, away[0], x), ca.if_else(stretched, away[1], y)
    return ca.if_else(x * away[0] + y * away[1] >= 0, ca.atan2(-x, y), ca.atan2(x, -y))


def bar_quaternions(along: ca.SX, waist: ca.SX) -> ca.SX:
    """Turn the x axis along each bar, with the y axis as close as possible to the plane's normal.

    Args:
        along: vectors, shape (3, n).
        waist: angle of the linkage's plane, [rad].

    Returns:
        Unit quaternions, scalar first, shape (4, n).
    """
    c, s = ca.cos(waist), ca.sin(waist)
    outward = along[0, :] * c + along[1, :] * s
    across = along[1, :] * c - along[0, :] * s
    pitch = ca.atan2(along[2, :], outward) / 2
    bend = 0 * across
    if not across.is_zero():
        bend = ca.atan2(across, ca.hypot(outward, along[2, :])) / 2
    cw, sw, cp, sp = ca.cos(waist / 2), ca.sin(waist / 2), ca.cos(pitch), ca.sin(pitch)
    cb, sb = ca.cos(bend), ca.sin(bend)
    w, x, y, z = cw * cp, sw * sp, -cw * sp, sw * cp  # about z by the waist, about -y by the pitch
    return ca.vertcat(w * cb - z * sb, x * cb + y * sb, y * cb - x * sb, z * cb + w * sb)
