"""Checks whether a robot can follow a curve, with the reason and the place of every fault.

A path must lie in the workspace, stay away from singular configurations (14), and have a unique
closest point (7) at every point of the tube of radius TUBE around it (section II.D of the paper);
the control laws need that uniqueness. A closed curve has such a tube if and only if

    |κ| <= 1 / TUBE,  and
    |σ(a) - σ(b)| >= 2 TUBE  where the arc length between a and b is at least π TUBE.

The first condition forbids sharp bends; by Schur's theorem it implies that points with less arc
length between them are in no other strand. The second one forbids two strands side by side, and
self-intersections. Strands of a space curve may cross in the plan view, 2 TUBE above each other.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from onpath.models.arrays import Array
from onpath.models.errors import Message
from onpath.models.paths.curves import Curve

Indices = NDArray[np.intp]
TUBE = 0.008  # [m], radius of the tube in which the closest point must be unique
STRANDS_APART = np.pi * TUBE  # [m], arc length from which two points are in different strands
LEAST_MARGIN = 0.2  # smallest admissible value of Robot.margin, which is 1 at home
SAMPLES = 240  # points of the curve that are checked


@dataclass(frozen=True, slots=True, eq=False)
class Fault:
    """One reason why a curve cannot be followed.

    Attributes:
        reason: one sentence for the user.
        points: where the fault is, shape (n, 2), or (n, 3) on a space curve, [m]; empty if it has
            no place.
    """

    reason: Message
    points: Array


def curve_faults(reach: Callable[[Array], Array], curve: Curve) -> list[Fault]:
    """All faults of a curve as a path for a robot; an empty list if it can be followed.

    The curve is checked at `SAMPLES` values of θ for: finite coordinates, margin > 0 (inside the
    workspace), margin >= LEAST_MARGIN (away from singular configurations), |κ| <= 1 / TUBE, |σ'|
    not nearly 0 (no cusp; on a space curve |z'| of the plan view, so that no tangent is vertical),
    no self-intersections, and strands 2 TUBE apart. On a path of 1 m, the distance between samples
    of two strands exceeds that between the strands by 1 % at most.

    Args:
        reach: the robot's `Robot.margin`, shape (n, d) -> (n,).
        curve: the candidate, in coordinates of the path's plane.
    """
    z, first, second, _ = curve.all_orders(curve.sample(SAMPLES))
    if not np.all(np.isfinite(z)):
        return [Fault(Message("fault.not_numbers"), np.zeros((0, 2)))]
    margin = reach(z)
    speed = np.linalg.norm(first, axis=-1)
    turn = _cross(first, second) if curve.dimension == 2 else np.cross(first, second)
    bends = np.linalg.norm(turn.reshape(SAMPLES, -1), axis=1) > speed**3 / TUBE
    checks = [
        (margin <= 0, Message("fault.outside")),
        ((margin > 0) & (margin < LEAST_MARGIN), Message("fault.singular")),
        (bends, Message("fault.bends", {"radius": f"{TUBE * 1e3:.0f}"})),
        (np.linalg.norm(first[:, :2], axis=-1) < 1e-4, Message("fault.cusp")),
    ]
    faults = [Fault(reason, z[bad]) for bad, reason in checks if bad.any()]
    return faults + _strand_faults(z, curve.closed, bool(bends.any()))


def own_faults(curve: Curve) -> list[Fault]:
    """The faults that a curve has as a path for any robot, wherever it can reach."""
    return curve_faults(lambda z: np.ones(len(z)), curve)


def _strand_faults(z: Array, closed: bool, bends: bool) -> list[Fault]:
    """Self-intersections or, if there are none, strands that are too close to each other.

    Args:
        z: samples of the curve, shape (n, d), [m].
        bends: whether the curve bends too sharply: only then does a strand intersect itself.
    """
    close, steps = close_strands(z, closed)
    if not (len(close) or bends or steps.max() > TUBE):
        return []
    crossings = self_crossings(z, closed)
    if len(crossings):
        return [Fault(Message("fault.crosses"), crossings)]
    least = Message("fault.narrow", {"least": f"{2 * TUBE * 1e3:.0f}"})
    return [Fault(least, close)] if len(close) else []


def close_strands(z: Array, closed: bool) -> tuple[Array, Array]:
    """Points with a point of another strand nearer than 2 TUBE, and the lengths of the segments.

    Two points are in different strands if the arc length between them is at least π TUBE.

    Args:
        z: corners of the polyline, shape (n, d), [m].
        closed: whether the last corner is joined to the first.

    Returns:
        Shapes (k, d) and (n - 1 or n,), [m].
    """
    line = np.vstack([z, z[:1]]) if closed else z
    steps = np.linalg.norm(np.diff(line, axis=0), axis=1)
    s = np.concatenate([[0.0], np.cumsum(steps)])
    i, j = _pairs_within(z, 2 * TUBE)
    arc = np.abs(s[i] - s[j])
    if closed:
        arc = np.minimum(arc, s[-1] - arc)
    return z[np.unique(i[arc >= STRANDS_APART])], steps


def self_crossings(z: Array, closed: bool) -> Array:
    """Points where a polyline intersects itself, shape (n, d) -> (k, d), [m].

    Segments i and j intersect where a_i + s d_i = a_j + t d_j with s and t in [0, 1):

        s = (a_j - a_i) × d_j / (d_i × d_j),    t = (a_j - a_i) × d_i / (d_i × d_j).

    In space: where the plan views of two segments do that are near each other.

    Args:
        z: corners of the polyline, shape (n, d), [m].
        closed: whether the last corner is joined to the first.
    """
    line = np.vstack([z, z[:1]]) if closed else z
    a, d = line[:-1], np.diff(line, axis=0)
    longest = np.linalg.norm(d, axis=1).max(initial=0.0)
    i, j = _pairs_within(a, 2.01 * longest)  # the others are too far from each other
    apart = (j >= i + 2) & ~((i == 0) & (j == len(a) - 1) & closed)
    i, j = i[apart], j[apart]
    between, cross = a[j] - a[i], _cross(d[i], d[j])
    parallel = np.abs(cross) < 1e-18
    safe = np.where(parallel, 1.0, cross)
    s, t = _cross(between, d[j]) / safe, _cross(between, d[i]) / safe
    hit = ~parallel & (s >= 0) & (s < 1) & (t >= 0) & (t < 1)
    return a[i[hit]] + s[hit, None] * d[i[hit]]


def _pairs_within(z: Array, distance: float) -> tuple[Indices, Indices]:
    """All i and j with |z_i - z_j| < distance, shape (n, d) -> two of shape (k,)."""
    first, *others = z.T
    squared = (first[:, None] - first) ** 2
    for x in others:
        squared += (x[:, None] - x) ** 2
    i, j = np.nonzero(squared < distance**2)
    return i, j


def _cross(a: Array, b: Array) -> Array:
    """The planar cross product a1 b2 - a2 b1, shape (..., 2) -> (...)."""
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
