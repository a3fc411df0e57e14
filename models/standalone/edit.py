"""Computations of a page without a server while a control point of a path is dragged.

The checks are those of models/paths/path_checks.py; `wasm_loop.py` translates the functions and
scans.
"""

from __future__ import annotations

import casadi as ca
import numpy as np

from onpath.models.arrays import Array
from onpath.models.closed_loop.loop_kind import Kind
from onpath.models.closed_loop.page_functions import lift_of, placed, view_of
from onpath.models.closed_loop.wasm_loop import Scan
from onpath.models.control.bend_limit import PER_PIECE as TURNS
from onpath.models.paths.curve_fit import SAMPLES as FITTED
from onpath.models.paths.curves import GRID, ORDERS, TERMS, from_terms, terms_of
from onpath.models.paths.path_checks import (
    DRAWING_CHECKS,
    FINER,
    POINT_CHECKS,
    SAMPLES,
    PathPoint,
    StrandPair,
    crosses,
    meets,
    narrow,
    sampled_theta,
)
from onpath.models.paths.path_design import REACH
from onpath.models.paths.projection import LocalCurve, basis
from onpath.models.paths.spline_curves import PER_PIECE
from onpath.models.standalone.curve_scans import scan_of, scan_on
from onpath.models.systems.robots import Robot, margin_of

CHECKS = (*POINT_CHECKS, "narrow")
"""The last numbers of a row of `check` on a series; `strands` finds "crosses"."""
ROW = 3 + len(CHECKS)


def edit_functions(robot: Robot, kind: Kind) -> dict[str, ca.Function]:
    """The functions for planar paths of a kind.

    spot: a point z of the path's plane -> its position in the picture, (2, 1)
    planar: (z, from, to) -> z moved as the picture's point moves
    toward: (z, target, share) -> that share of the way, within ±REACH
    table: of series: see `_table`
    """
    z, target, share = ca.SX.sym("z", 2), ca.SX.sym("target", 2), ca.SX.sym("share")
    begin, end = ca.SX.sym("begin", 2), ca.SX.sym("end", 2)
    lift, (seen, offset) = lift_of(robot, kind), view_of(robot)
    axes = ca.horzcat(*(lift(ca.SX(ca.DM(each)), True) for each in ([1, 0], [0, 1])))
    moved = z + ca.inv(placed(robot, axes, seen)) @ (end - begin)
    limited = ca.fmax(ca.fmin(z + share * (target - z), REACH), -REACH)
    functions = {
        "spot": ca.Function("spot", [z], [placed(robot, lift(z, False), seen) + offset]),
        "planar": ca.Function("planar", [z, begin, end], [moved]),
        "toward": ca.Function("toward", [z, target, share], [limited]),
    }
    return functions if kind.spline else functions | {"table": _table(kind.closed)}


def _table(closed: bool) -> ca.Function:
    """Sums over samples z at evenly spaced θ of z times the basis at θ, (2, TERMS) -> `Curve.table`
    of the series that fits them best; see assets/web/simulation/fit.ts."""
    sums, count = ca.SX.sym("sums", 2, TERMS), terms_of(closed)
    theta = np.linspace(-np.pi, np.pi, FITTED, endpoint=not closed)
    x = ca.SX.sym("x")
    values = ca.Function("basis", [x], [basis(x, closed)])(theta[None]).full()[:count]
    gram: Array = np.asarray(np.linalg.inv(values @ values.T), dtype=float)
    gram[np.abs(gram) < 1e-15] = 0.0
    terms = sums[:, :count] @ ca.sparsify(ca.DM(gram))
    series = from_terms(closed, np.eye(count)).series  # (ORDERS, TERMS, count)
    orders = [terms @ ca.sparsify(ca.DM(series[order].T)) for order in range(ORDERS)]
    return ca.Function("table", [sums], [ca.densify(ca.vertcat(*orders))])


def edit_scans(robot: Robot, kind: Kind) -> dict[str, Scan]:
    """The scans for planar paths of a kind; the first and the last are those of `scan_on`.

    check: one step more than there are samples from (0, 0, 0, 0) -> rows (z, arc length, 1 or 0
        for each of the checks, and a number that `strands` uses)
    strands: compares a point with later ones, see `_strands`; constants are its row and the
        next, rows those of the later points
    turning: of a drawing: from (number, turning) -> the largest κ |σ'|, by which the tangent
        turns per radian of θ
    """
    scans = {"check": _check(robot, kind)}
    if kind.spline:
        return scans | {"strands": _meetings(), "turning": _turning(kind)}
    return scans | {"strands": _strands(kind)}


def _check(robot: Robot, kind: Kind) -> Scan:
    """The scan "check"; the last row of a closed curve is its first point."""
    state, pieces = ca.SX.sym("state", 4), ca.SX.sym("pieces")
    number, length, before = state[0], state[1], state[2:]
    finer = FINER * ca.fmax(GRID, PER_PIECE * pieces)  # as `SplineCurve.grid`
    theta = sampled_theta(number, kind.closed, finer if kind.spline else SAMPLES)
    checks = DRAWING_CHECKS if kind.spline else POINT_CHECKS

    def row(at: LocalCurve) -> tuple[ca.SX, ca.SX]:
        z, step = at.sigma, at.sigma - before
        arc = ca.if_else(number == 0, 0, length + ca.sqrt(ca.dot(step, step)))
        point = PathPoint(at.first, at.second, margin_of(robot, lift_of(robot, kind)(z, False)))
        found = ca.vertcat(*(check(point) for check in checks.values()))
        return ca.vertcat(number + 1, arc, z), ca.vertcat(z, arc, found, 0)

    return scan_on(kind, state, pieces, theta, row)


def _strands(kind: Kind) -> Scan:
    """Whether the strand at a point comes near another one, or crosses it.

    State: 1 if it is near one, 1 if it crosses one, the place (2), and the length of the path. The
    last number of a row is 1 where the strand is near another one.
    """
    state = ca.SX.sym("state", 5)
    here, rows = ca.SX.sym("own", 2 * ROW), ca.SX.sym("rows", 2 * ROW)
    arc = ca.fabs(rows[2] - here[2])
    if kind.closed:
        arc = ca.fmin(arc, state[4] - arc)
    pair = _pair(here, rows, arc)
    near, hit = narrow(pair), crosses(pair)
    place = ca.if_else(hit, pair.place, state[2:4])
    after = ca.vertcat(ca.fmax(state[0], near), ca.fmax(state[1], hit), place, state[4])
    row = ca.vertcat(rows[: ROW - 1], ca.fmax(rows[ROW - 1], near))
    return scan_of(ROW, [state, here, rows], [after, row])


def _meetings() -> Scan:
    """Whether a drawing crosses itself where the pen is down.

    State: 0, and 1 if it does. The last number of a row is 1 where the pen is down.
    """
    state = ca.SX.sym("state", 2)
    here, rows = ca.SX.sym("own", 2 * ROW), ca.SX.sym("rows", 2 * ROW)
    drawn = ca.logic_and(here[ROW - 1], rows[ROW - 1])
    hit = ca.logic_and(drawn, meets(_pair(here, rows, ca.SX(0))))
    return scan_of(ROW, [state, here, rows], [ca.vertcat(0, ca.fmax(state[1], hit)), ca.SX(0, 1)])


def _pair(here: ca.SX, rows: ca.SX, arc: ca.SX) -> StrandPair:
    """Two segments, each from the point of a row to that of the next one."""
    (a, d), (b, e) = ((each[:2], each[ROW : ROW + 2] - each[:2]) for each in (here, rows))
    return StrandPair(a=a, d=d, b=b, e=e, arc=arc)


def _turning(kind: Kind) -> Scan:
    """The scan "turning": the samples are those of `most_turning`."""
    state, pieces = ca.SX.sym("state", 2), ca.SX.sym("pieces")
    theta = sampled_theta(state[0], kind.closed, TURNS * pieces)

    def largest(at: LocalCurve) -> tuple[ca.SX, ca.SX]:
        return ca.vertcat(state[0] + 1, ca.fmax(state[1], at.turning)), ca.SX(0, 1)

    return scan_on(kind, state, pieces, theta, largest)
