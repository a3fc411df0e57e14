"""Checks whether a robot can follow a curve, with the reason and the place of every fault.

A path must lie in the workspace, stay away from singular configurations (14), not intersect itself,
and have a curvature |κ| <= 1 / TUBE. The last condition makes the closest point (7) locally unique
within the tube of radius TUBE around the path (section II.D of the paper); the control laws need
that uniqueness.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from onpath.models.arrays import Array
from onpath.models.errors import Message
from onpath.models.paths.curves import Curve

TUBE = 0.008  # [m], radius of the tube in which the closest point must be unique
LEAST_MARGIN = 0.2  # smallest admissible value of Robot.margin, which is 1 at home
SAMPLES = 240  # points of the curve that are checked


@dataclass(frozen=True, slots=True, eq=False)
class Fault:
    """One reason why a curve cannot be followed.

    Attributes:
        reason: one sentence for the user.
        points: where the fault is, shape (n, 2), [m]; empty if it has no place.
    """

    reason: Message
    points: Array


def curve_faults(reach: Callable[[Array], Array], curve: Curve) -> list[Fault]:
    """All faults of a curve as a path for a robot; an empty list if it can be followed.

    The curve is checked at `SAMPLES` values of θ for: finite coordinates, margin > 0 (inside the
    workspace), margin >= LEAST_MARGIN (away from singular configurations), |κ| <= 1 / TUBE, |σ'|
    not nearly 0 (no cusp), and no self-intersections.

    Args:
        reach: the robot's `Robot.margin`, shape (n, 2) -> (n,).
        curve: the candidate, in coordinates of the path's plane.
    """
    theta = curve.sample(SAMPLES)
    z, first = curve.at(theta), curve.at(theta, 1)
    if not np.all(np.isfinite(z)):
        return [Fault(Message("fault.not_numbers"), np.zeros((0, 2)))]
    margin = reach(z)
    checks = [
        (margin <= 0, Message("fault.outside")),
        ((margin > 0) & (margin < LEAST_MARGIN), Message("fault.singular")),
        (
            np.abs(curve.curvature(theta)) > 1 / TUBE,
            Message("fault.bends", {"radius": f"{TUBE * 1e3:.0f}"}),
        ),
        (np.linalg.norm(first, axis=-1) < 1e-4, Message("fault.cusp")),
    ]
    faults = [Fault(reason, z[bad]) for bad, reason in checks if bad.any()]
    crossings = self_crossings(z, curve.closed)
    if len(crossings):
        faults.append(Fault(Message("fault.crosses"), crossings))
    return faults


def self_crossings(z: Array, closed: bool) -> Array:
    """Points where a polyline intersects itself, shape (n, 2) -> (k, 2), [m].

    Segments i and j intersect where a_i + s d_i = a_j + t d_j with s and t in [0, 1):

        s = (a_j - a_i) × d_j / (d_i × d_j),    t = (a_j - a_i) × d_i / (d_i × d_j).

    Args:
        z: corners of the polyline, shape (n, 2), [m].
        closed: whether the last corner is joined to the first.
    """
    line = np.vstack([z, z[:1]]) if closed else z
    a, d = line[:-1], np.diff(line, axis=0)
    i, j = np.triu_indices(len(a), k=2)
    if closed:
        apart = ~((i == 0) & (j == len(a) - 1))
        i, j = i[apart], j[apart]
    between, cross = a[j] - a[i], _cross(d[i], d[j])
    parallel = np.abs(cross) < 1e-18
    safe = np.where(parallel, 1.0, cross)
    s, t = _cross(between, d[j]) / safe, _cross(between, d[i]) / safe
    hit = ~parallel & (s >= 0) & (s < 1) & (t >= 0) & (t < 1)
    return a[i[hit]] + s[hit, None] * d[i[hit]]


def _cross(a: Array, b: Array) -> Array:
    """The planar cross product a1 b2 - a2 b1, shape (..., 2) -> (...)."""
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
