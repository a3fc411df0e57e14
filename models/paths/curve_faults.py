"""Why a curve cannot be a path for a robot, in words, and where.

A path must lie in the workspace, away from singular configurations (14), must not cross itself,
and must not bend more sharply than the tube around it allows: inside that tube the closest point
is unique (section II.D), and nothing here works without it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from onpath.models.arrays import Array
from onpath.models.errors import Message
from onpath.models.paths.curves import Curve

TUBE = 0.008  # [m], radius within which the closest point must be unique
LEAST_MARGIN = 0.2  # of Robot.margin
SAMPLES = 240


@dataclass(frozen=True, slots=True, eq=False)
class Fault:
    """One thing wrong.

    Attributes:
        reason: what, for a user.
        points: where, shape (n, 2), [m].
    """

    reason: Message
    points: Array


def curve_faults(reach: Callable[[Array], Array], curve: Curve) -> list[Fault]:
    """All that is wrong with a curve as a path for a robot; empty if it will do.

    Args:
        reach: the robot's `Robot.margin`.
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
    """Where a polyline crosses itself, shape (n, 2) -> (k, 2)."""
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
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
