"""The checks of a path, each as one CasADi expression.

A path must lie in the workspace, stay away from singular configurations (14), and have at every
point a unique closest point (7) among those nearby, in the tube of radius TUBE around it:

    |κ| <= 1 / TUBE.

The closest point is unique on the whole path (section II.D of the paper) if also

    |σ(a) - σ(b)| >= 2 TUBE  where the arc length between a and b is at least π TUBE.

Points so far apart along the path are in different strands. By Schur's theorem, the first condition
implies that points with less arc length between them do not meet. Where the second one does not
hold, strands run close to each other or cross. In the plan view, strands of a space curve may cross
if they are 2 TUBE above each other.

A path that fails the first condition is refused. One that fails the second is followed, with a
warning: no law searches the whole path. A law has a clock, or it starts each search for the closest
point at the last one and so stays on its strand; what it stabilises is then not a set of states x,
but one of (x, θ). Only `models/studies/crossing.py` searches the whole path, and shows how that
fails. A level set has no gradient at a crossing, so `check_level_set` refuses such a path.

`curve_faults.py` evaluates the expressions for the lab, and `models/standalone/edit.py` translates
them for pages without a server: same path, same verdict.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType

import casadi as ca
import numpy as np

TUBE = 0.008  # [m], radius of the tube in which the closest point must be unique
LEAST_RADIUS = 5e-4  # [m], of the bends of a drawing
ROUNDING = 1.02  # of bends as sharp as they may be
STRANDS_APART = np.pi * TUBE  # [m], arc length from which two points are in different strands
LEAST_MARGIN = 0.2  # smallest admissible value of Robot.margin, which is 1 at home
LEAST_SPEED = 1e-4  # [m/rad]; slower, a curve has a cusp
PARALLEL = 1e-18  # [m²]
SAMPLES = 240  # points of a series that are checked
FINER = 2  # times `Curve.grid`: points of a drawing that are checked


@dataclass(frozen=True, slots=True)
class PathPoint:
    """A point of a path.

    Attributes:
        first, second: σ' and σ'', (d, 1), [m/rad], [m/rad²].
        margin: `Robot.margin` there.
    """

    first: ca.SX
    second: ca.SX
    margin: ca.SX


def outside(at: PathPoint) -> ca.SX:
    """Not inside the workspace."""
    return ca.logic_not(at.margin > 0)


def singular(at: PathPoint) -> ca.SX:
    """Inside the workspace, but near a singular configuration."""
    return ca.logic_and(at.margin > 0, at.margin < LEAST_MARGIN)


def bends(at: PathPoint) -> ca.SX:
    """|κ| = |σ' × σ''| / |σ'|³ > 1 / TUBE."""
    return _turn(at) > _length(at.first) ** 3 / TUBE


def bends_sharply(at: PathPoint) -> ca.SX:
    """|κ| = |σ' × σ''| / |σ'|³ > 1 / LEAST_RADIUS, but for a rounding."""
    return _turn(at) * LEAST_RADIUS > ROUNDING * _length(at.first) ** 3


def cusp(at: PathPoint) -> ca.SX:
    """|z'| is nearly 0; for a space curve, z is its plan view, so that no tangent is vertical."""
    return _length(at.first[:2]) < LEAST_SPEED


@dataclass(frozen=True, slots=True)
class StrandPair:
    """Two segments of a path's polyline, from a to a + d and from b to b + e, (d, 1), [m].

    Attributes:
        arc: arc length from a to b, the shorter way round, [m].
    """

    a: ca.SX
    d: ca.SX
    b: ca.SX
    e: ca.SX
    arc: ca.SX

    @property
    def strands(self) -> ca.SX:
        """Whether a and b are in different strands."""
        return self.arc >= STRANDS_APART

    def shares(self) -> tuple[ca.SX, ca.SX]:
        """s and t of a + s d = b + t e in the plan view:

        s = (b - a) × e / (d × e),    t = (b - a) × d / (d × e).
        """
        across = _cross(self.d, self.e)
        between = self.b - self.a
        return _cross(between, self.e) / across, _cross(between, self.d) / across

    @property
    def place(self) -> ca.SX:
        """Where they cross, (d, 1), [m]."""
        return self.a + self.shares()[0] * self.d


def meets(pair: StrandPair) -> ca.SX:
    """Two segments that cross in the plan view."""
    hit = ca.fabs(_cross(pair.d, pair.e)) >= PARALLEL
    for share in pair.shares():
        hit = ca.logic_and(hit, ca.logic_and(share >= 0, share < 1))
    return hit


def narrow(pair: StrandPair) -> ca.SX:
    """Two strands closer to each other than 2 TUBE."""
    between = pair.b - pair.a
    return ca.logic_and(ca.dot(between, between) < (2 * TUBE) ** 2, pair.strands)


def crosses(pair: StrandPair) -> ca.SX:
    """Two strands that cross; in space, that cross in the plan view and are near each other."""
    hit = ca.logic_and(meets(pair), pair.strands)
    if pair.a.numel() == 3:
        hit = ca.logic_and(hit, _length(pair.b - pair.a) <= _length(pair.d) + _length(pair.e))
    return hit


POINT_CHECKS: Mapping[str, Callable[[PathPoint], ca.SX]] = MappingProxyType(
    {"outside": outside, "singular": singular, "bends": bends, "cusp": cusp}
)
DRAWING_CHECKS: Mapping[str, Callable[[PathPoint], ca.SX]] = MappingProxyType(
    {"outside": outside, "singular": singular, "bends_sharply": bends_sharply, "cusp": cusp}
)
"""Those of a drawing, whose bends count only where the pen is down."""
STRAND_CHECKS: Mapping[str, Callable[[StrandPair], ca.SX]] = MappingProxyType(
    {"narrow": narrow, "crosses": crosses}
)
"""1 where a check fails, else 0: the others find faults, these ambiguities. Strands that cross
need not be reported as narrow as well."""


def sampled_theta(number: ca.SX, closed: bool, count: ca.SX | int = SAMPLES) -> ca.SX:
    """θ of one of some evenly spaced points, [rad]; on a closed curve the last is the first."""
    if closed:
        return ca.if_else(number < count, number, 0) * (2 * np.pi / count) - np.pi
    return ca.fmin(number * (2 * np.pi / (count - 1)) - np.pi, np.pi)


def _turn(at: PathPoint) -> ca.SX:
    """|σ' × σ''|."""
    if at.first.numel() == 2:
        return ca.fabs(_cross(at.first, at.second))
    return _length(ca.cross(at.first, at.second))


def _length(vector: ca.SX) -> ca.SX:
    return ca.sqrt(ca.dot(vector, vector))


def _cross(a: ca.SX, b: ca.SX) -> ca.SX:
    """The cross product a1 b2 - a2 b1 of the plan views."""
    return a[0] * b[1] - a[1] * b[0]
