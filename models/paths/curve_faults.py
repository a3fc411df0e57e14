"""Which checks of `path_checks.py` a curve fails as a path, and where: faults and ambiguities."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import lru_cache
from types import MappingProxyType

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from onpath.models.arrays import Array
from onpath.models.errors import Message
from onpath.models.evaluated import evaluated
from onpath.models.paths.curves import ORDERS, TERMS, Curve
from onpath.models.paths.path_checks import (
    DRAWING_CHECKS,
    FINER,
    LEAST_RADIUS,
    POINT_CHECKS,
    SAMPLES,
    STRAND_CHECKS,
    STRANDS_APART,
    TUBE,
    PathPoint,
    StrandPair,
    sampled_theta,
)
from onpath.models.paths.projection import basis
from onpath.models.paths.spline_curves import SplineCurve

Indices = NDArray[np.intp]
BATCH = 256  # points of a drawing, or pairs of segments, that are checked in one call
REASONS: Mapping[str, Message] = MappingProxyType(
    {
        "not_numbers": Message("fault.not_numbers"),
        "outside": Message("fault.outside"),
        "singular": Message("fault.singular"),
        "bends": Message("fault.bends", {"radius": f"{TUBE * 1e3:.0f}"}),
        "bends_sharply": Message("fault.bends", {"radius": f"{LEAST_RADIUS * 1e3:g}"}),
        "cusp": Message("fault.cusp"),
        "crosses": Message("fault.crosses"),
        "narrow": Message("fault.narrow", {"least": f"{2 * TUBE * 1e3:.0f}"}),
    }
)
"""Check -> what a user is told if it fails."""


@dataclass(frozen=True, slots=True, eq=False)
class Fault:
    """One reason why a curve cannot be followed, or why it is ambiguous.

    Attributes:
        check: the check that fails, a key of `REASONS`.
        points: location of the fault, shape (n, 2), or (n, 3) on a space curve, [m]; empty if it
            has none.
    """

    check: str
    points: Array

    @property
    def reason(self) -> Message:
        """One sentence for the user."""
        return REASONS[self.check]


def curve_faults(reach: Callable[[Array], Array], curve: Curve) -> list[Fault]:
    """All faults of a curve as a path for a robot; an empty list if it can be followed.

    A series is checked at `SAMPLES` values of θ, a drawing at some on each of its pieces. The bends
    of a drawing need a radius of `LEAST_RADIUS` only, and none where the pen is up.

    Args:
        reach: the robot's `Robot.margin`, shape (n, d) -> (n,).
        curve: the candidate, in coordinates of the path's plane.
    """
    if isinstance(curve, SplineCurve):
        return _spline_faults(reach, curve)
    return list(_curve_faults(reach, curve.closed, curve.dimension, curve.table().tobytes()))


def _spline_faults(reach: Callable[[Array], Array], curve: SplineCurve) -> list[Fault]:
    theta = curve.sample(FINER * curve.grid)
    z, first, second, _ = curve.all_orders(theta)
    given = np.hstack([first, second, reach(z)[:, None]])
    found = _in_batches(_drawing_checks(curve.dimension), given)
    bad = dict(zip(DRAWING_CHECKS, found.T > 0, strict=True))
    bad["bends_sharply"] &= curve.draws(theta)
    return [Fault(check, z[at]) for check, at in bad.items() if at.any()]


@lru_cache(maxsize=64)
def _curve_faults(
    reach: Callable[[Array], Array], closed: bool, d: int, table: bytes
) -> tuple[Fault, ...]:
    """`curve_faults` by content: all labs of a class get the same paths."""
    (samples,) = evaluated(_samples(closed, d), np.frombuffer(table))
    z = samples[:, :d]
    if not np.all(np.isfinite(z)):
        return (Fault("not_numbers", np.zeros((0, 2))),)
    (found,) = evaluated(_point_checks(d), samples[:, d:], reach(z))
    bad = zip(POINT_CHECKS, found.T > 0, strict=True)
    return tuple(Fault(check, z[at]) for check, at in bad if at.any())


def ambiguities(curve: Curve) -> list[Fault]:
    """Where the closest point is not unique because strands cross or are too close to each other.

    They do not keep a robot from following the curve, and its user is warned of them. On a path of
    1 m, the distance between samples of two strands exceeds that between the strands by 1 % at
    most. Strands of a drawing are close to each other nearly everywhere; its user is told where
    they cross.
    """
    if isinstance(curve, SplineCurve):
        return _spline_crossings(curve)
    (samples,) = evaluated(_samples(curve.closed, curve.dimension), curve.table())
    z = samples[:, : curve.dimension]
    return strand_faults(z, curve.closed) if np.all(np.isfinite(z)) else []


def _spline_crossings(curve: SplineCurve) -> list[Fault]:
    """Where strands cross while the pen is down; those of a space curve in its plan view."""
    from scipy.spatial import KDTree  # slow to import; see app/server/warm_up.py

    theta = curve.sample(FINER * curve.grid)
    z, down = curve.at(theta), curve.draws(theta)
    ends, last = (np.roll(z, -1, axis=0), None) if curve.closed else (z[1:], -1)
    begins, down = z[:last], down[:last]
    along = ends - begins
    reach = float(np.linalg.norm(along, axis=1).max())
    i, j = KDTree((begins + ends) / 2).query_pairs(reach, output_type="ndarray").T
    apart = np.minimum(j - i, len(z) - (j - i)) if curve.closed else j - i
    kept = (apart > 1) & down[i] & down[j]
    i, j = i[kept], j[kept]
    between, a, b = begins[j] - begins[i], along[i], along[j]
    across = _cross(a, b)
    with np.errstate(divide="ignore", invalid="ignore"):
        s, t = _cross(between, b) / across, _cross(between, a) / across
    hit = (s >= 0) & (s < 1) & (t >= 0) & (t < 1)
    return [Fault("crosses", begins[i[hit]] + s[hit, None] * a[hit])] if hit.any() else []


def _cross(a: Array, b: Array) -> Array:
    """The cross products of the plan views, two of shape (n, d) -> (n,)."""
    return np.asarray(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0], dtype=float)


def strand_faults(z: Array, closed: bool) -> list[Fault]:
    """The places where strands cross or, if none do, where they are too close to each other.

    Args:
        z: corners of a polyline, shape (n, d), [m].
        closed: whether the last corner is joined to the first.
    """
    line = np.vstack([z, z[:1]]) if closed else z
    along = np.diff(line, axis=0)
    steps = np.sqrt((along**2).sum(axis=1))
    s, longest = np.concatenate([[0.0], np.cumsum(steps)]), float(steps.max(initial=0.0))
    gap = int(min(STRANDS_APART / longest, len(z))) if longest else len(z)
    i, j = _pairs_within(z, max(2 * TUBE, 2.01 * longest), max(1, gap))
    arc = np.abs(s[j] - s[i])
    if closed:
        arc = np.minimum(arc, s[-1] - arc)
    else:
        along = np.vstack([along, np.zeros_like(z[:1])])  # nothing begins at the last corner
    near, hit, place = _checked(np.hstack([z[i], along[i], z[j], along[j], arc[:, None]]))
    if hit.any():
        return [Fault("crosses", place[hit])]
    return [Fault("narrow", z[np.unique([i[near], j[near]])])] if near.any() else []


def _checked(pairs: Array) -> tuple[NDArray[np.bool_], NDArray[np.bool_], Array]:
    """Which pairs of segments, (k, 4 d + 1), are too close, and which cross, and where."""
    found = _in_batches(_strand_checks(pairs.shape[1] // 4), pairs)
    return found[:, 0] > 0, found[:, 1] > 0, found[:, 2:]


def _in_batches(function: ca.Function, rows: Array) -> Array:
    """The results of a function of `BATCH` columns for any number of them, as rows."""
    found = np.zeros((len(rows), function.size_out(0)[0]))
    for begin in range(0, len(rows), BATCH):
        part = rows[begin : begin + BATCH]
        padded = np.vstack([part, np.zeros((BATCH - len(part), part.shape[1]))])
        found[begin : begin + BATCH] = evaluated(function, padded)[0][: len(part)]
    return found


@lru_cache(maxsize=4)
def _samples(closed: bool, d: int) -> ca.Function:
    """`Curve.table` as a matrix -> z, σ' and σ'' at the `SAMPLES`, (3 d, SAMPLES)."""
    number, table = ca.SX.sym("number"), ca.MX.sym("table", ORDERS * d, TERMS)
    values = ca.Function("basis", [number], [basis(sampled_theta(number, closed), closed)])
    return ca.Function("samples", [table], [table[: 3 * d, :] @ values(np.arange(SAMPLES)[None])])


@lru_cache(maxsize=2)
def _point_checks(d: int) -> ca.Function:
    """(σ' and σ'', margin) of the `SAMPLES`, as columns -> 1 or 0 for the `POINT_CHECKS`."""
    derivatives, margin = ca.SX.sym("derivatives", 2 * d), ca.SX.sym("margin")
    at = PathPoint(derivatives[:d], derivatives[d:], margin)
    bad = ca.vertcat(*(check(at) for check in POINT_CHECKS.values()))
    return ca.Function("points", [derivatives, margin], [ca.densify(bad)]).map(SAMPLES)


@lru_cache(maxsize=2)
def _drawing_checks(d: int) -> ca.Function:
    """σ', σ'' and margin of `BATCH` points, as columns -> 1 or 0 for the `DRAWING_CHECKS`."""
    given = ca.SX.sym("given", 2 * d + 1)
    at = PathPoint(given[:d], given[d : 2 * d], given[2 * d])
    bad = ca.vertcat(*(check(at) for check in DRAWING_CHECKS.values()))
    return ca.Function("points", [given], [ca.densify(bad)]).map(BATCH)


@lru_cache(maxsize=2)
def _strand_checks(d: int) -> ca.Function:
    """a, d, b, e and arc of `BATCH` pairs, as columns -> 1 or 0 for `STRAND_CHECKS`, and place."""
    numbers = ca.SX.sym("pair", 4 * d + 1)
    a, along, b, other, arc = ca.vertsplit(numbers, d)
    pair = StrandPair(a=a, d=along, b=b, e=other, arc=arc)
    found = [check(pair) for check in STRAND_CHECKS.values()]
    result = ca.densify(ca.vertcat(*found, pair.place))
    return ca.Function("strands", [numbers], [result]).map(BATCH)


def _pairs_within(z: Array, distance: float, gap: int) -> tuple[Indices, Indices]:
    """i and j >= i + gap with |z_i - z_j| < distance, and perhaps some more: two of shape (k,)."""
    squared, one = (z**2).sum(axis=1)[:, None], np.ones((len(z), 1))
    between = np.hstack([-2 * z, squared, one]) @ np.hstack([z, one, squared]).T
    near = (between < distance**2 + 1e-9 * (1 + squared.max())) & _later(len(z), gap)
    i, j = np.divmod(np.flatnonzero(near), len(z))
    return i, j


@lru_cache(maxsize=8)
def _later(count: int, gap: int) -> NDArray[np.bool_]:
    """Where j >= i + gap, shape (count, count)."""
    return np.triu(np.ones((count, count), dtype=bool), gap)
